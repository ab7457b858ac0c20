// Grains on the surface of a solid: surface.json as a program.
#include "surface.hpp"

using namespace dovetail;

int main(int argc, char** argv) {
  const prices::Size size = prices::sizeFrom(argc, argv);
  coupling::CoupledRun run;
  prices::addGrains(run.grains, size, false);
  const fem::SolidMesh mesh = prices::blockMesh(size, 0);
  prices::touch(run, run.addSolid(prices::makeBlock(mesh), {.name = "block"}), mesh, "z+");
  prices::finish(run, size);
}
