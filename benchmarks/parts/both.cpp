// An overlap below the grains and a plate on them: both.json as a program.
#include "overlap.hpp"
#include "surface.hpp"

using namespace dovetail;

int main(int argc, char** argv) {
  const parts::Size size = parts::sizeFrom(argc, argv);
  coupling::CoupledRun run;
  parts::addGrains(run.grains, size, false);
  parts::shareLayers(run, size);
  const fem::SolidMesh mesh = parts::plateMesh(size);
  parts::touch(run, run.addSolid(parts::makePlate(mesh), {.name = "plate"}), mesh, "skin");
  parts::finish(run, size);
}
