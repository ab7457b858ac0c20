// A solid alone: fem.json as a program.
#include "dovetail/fem/motion/dynamics.hpp"
#include "solids.hpp"

using namespace dovetail;

int main(int argc, char** argv) {
  const prices::Size size = prices::sizeFrom(argc, argv);
  const fem::SolidMesh mesh = prices::blockMesh(size, 0);
  const auto block = prices::makeBlock(mesh);
  fem::addMass(*block);
  fem::ExplicitIntegrator motion(*block, prices::dt);
  motion.run(size.steps);
  prices::printEnergy(motion.kineticEnergy());
}
