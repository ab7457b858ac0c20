// An overlap below the grains and a plate on them: both.json as a program.
#include "overlap.hpp"
#include "surface.hpp"

using namespace dovetail;

int main(int argc, char** argv) {
  const overhead::Size size = overhead::sizeFrom(argc, argv);
  coupling::CoupledRun run;
  overhead::addGrains(run.grains, size, false);
  overhead::shareLayers(run, size);
  const fem::SolidMesh mesh = overhead::plateMesh(size);
  overhead::touch(run, run.addSolid(overhead::makePlate(mesh), {.name = "plate"}), mesh, "skin");
  overhead::finish(run, size);
}
