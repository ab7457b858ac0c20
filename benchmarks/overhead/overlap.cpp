// Grains that hand over to a solid: overlap.json as a program.
#include "overlap.hpp"

using namespace dovetail;

int main(int argc, char** argv) {
  const overhead::Size size = overhead::sizeFrom(argc, argv);
  coupling::CoupledRun run;
  overhead::addGrains(run.grains, size, false);
  overhead::shareLayers(run, size);
  overhead::finish(run, size);
}
