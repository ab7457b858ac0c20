// Particles alone: dem.json as a program.
#include "grains.hpp"

using namespace dovetail;

int main(int argc, char** argv) {
  const overhead::Size size = overhead::sizeFrom(argc, argv);
  dem::Model grains;
  overhead::addGrains(grains, size, true);
  dem::run(grains, overhead::dt, size.steps);
  overhead::printEnergy(dem::energies(grains).kinetic);
}
