// A solid alone: fem.json as a program.
#include "dovetail/fem/motion/dynamics.hpp"
#include "solids.hpp"

using namespace dovetail;

int main(int argc, char** argv) {
  const parts::Size size = parts::sizeFrom(argc, argv);
  const fem::SolidMesh mesh = parts::blockMesh(size, 0);
  const auto block = parts::makeBlock(mesh);
  fem::addMass(*block);
  fem::ExplicitIntegrator motion(*block, parts::dt);
  motion.run(size.steps);
  parts::printEnergy(motion.kineticEnergy());
}
