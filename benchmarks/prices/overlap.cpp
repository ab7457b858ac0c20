// Grains that hand over to a solid: overlap.json as a program.
#include "overlap.hpp"

using namespace dovetail;

int main(int argc, char** argv) {
  const prices::Size size = prices::sizeFrom(argc, argv);
  coupling::CoupledRun run;
  prices::addGrains(run.grains, size, false);
  prices::shareLayers(run, size);
  prices::finish(run, size);
}
