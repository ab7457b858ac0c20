// Grains on the surface of a solid: surface.json as a program.
#include "surface.hpp"

using namespace dovetail;

int main(int argc, char** argv) {
  const overhead::Size size = overhead::sizeFrom(argc, argv);
  coupling::CoupledRun run;
  overhead::addGrains(run.grains, size, false);
  const fem::SolidMesh mesh = overhead::blockMesh(size, 0);
  overhead::touch(run, run.addSolid(overhead::makeBlock(mesh), {.name = "block"}), mesh, "z+");
  overhead::finish(run, size);
}
