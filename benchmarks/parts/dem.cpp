// Particles alone: dem.json as a program.
#include "grains.hpp"

using namespace dovetail;

int main(int argc, char** argv) {
  const parts::Size size = parts::sizeFrom(argc, argv);
  dem::Model grains;
  parts::addGrains(grains, size, true);
  dem::run(grains, parts::dt, size.steps);
  parts::printEnergy(dem::energies(grains).kinetic);
}
