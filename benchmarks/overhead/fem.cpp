// A solid alone: fem.json as a program.
#include "dovetail/fem/motion/dynamics.hpp"
#include "solids.hpp"

using namespace dovetail;

int main(int argc, char** argv) {
  const overhead::Size size = overhead::sizeFrom(argc, argv);
  const fem::SolidMesh mesh = overhead::blockMesh(size, 0);
  const auto block = overhead::makeBlock(mesh);
  fem::addMass(*block);
  fem::ExplicitIntegrator motion(*block, overhead::dt);
  motion.run(size.steps);
  overhead::printEnergy(motion.kineticEnergy());
}
