// Grains on the surface of a solid: surface.json as a program.
#include "surface.hpp"

using namespace dovetail;

int main(int argc, char** argv) {
  const parts::Size size = parts::sizeFrom(argc, argv);
  coupling::CoupledRun run;
  parts::addGrains(run.grains, size, false);
  const fem::SolidMesh mesh = parts::blockMesh(size, 0);
  parts::touch(run, run.addSolid(parts::makeBlock(mesh), {.name = "block"}), mesh, "z+");
  parts::finish(run, size);
}
