// An overlap below the grains and a plate on them: both.json as a program.
#include "overlap.hpp"
#include "surface.hpp"

using namespace dovetail;

int main(int argc, char** argv) {
  const prices::Size size = prices::sizeFrom(argc, argv);
  coupling::CoupledRun run;
  prices::addGrains(run.grains, size, false);
  prices::shareLayers(run, size);
  const fem::SolidMesh mesh = prices::plateMesh(size);
  prices::touch(run, run.addSolid(prices::makePlate(mesh), {.name = "plate"}), mesh, "skin");
  prices::finish(run, size);
}
