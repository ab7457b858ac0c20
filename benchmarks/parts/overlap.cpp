// Grains that hand over to a solid: overlap.json as a program.
#include "overlap.hpp"

using namespace dovetail;

int main(int argc, char** argv) {
  const parts::Size size = parts::sizeFrom(argc, argv);
  coupling::CoupledRun run;
  parts::addGrains(run.grains, size, false);
  parts::shareLayers(run, size);
  parts::finish(run, size);
}
