// Particles alone: dem.json as a program.
#include "grains.hpp"

using namespace dovetail;

int main(int argc, char** argv) {
  const prices::Size size = prices::sizeFrom(argc, argv);
  dem::Model grains;
  prices::addGrains(grains, size, true);
  dem::run(grains, prices::dt, size.steps);
  prices::printEnergy(dem::energies(grains).kinetic);
}
