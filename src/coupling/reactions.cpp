// What supports and ties do to the nodes of a solid.
#include <algorithm>

#include "run_impl.hpp"

namespace dovetail::coupling {

Reactions CoupledRun::reactions(std::size_t k) const {
  impl_->requireStarted("reactions");
  const SolidStepper& solid = *impl_->solids.at(k);
  const fem::ModelMass& mass = *solid.side.mass;
  const std::vector<Vec3> force = solid.forces();
  std::vector<Vec3> acceleration(force.size()), reaction(force.size());
  mass.dofs().applyAcceleration(solid.side.model->t, macroStep(), acceleration);
  if (solid.stands)
    std::ranges::fill(acceleration, Vec3{});
  else
    mass.accelerate(force, acceleration);
  mass.multiply(acceleration, reaction);
  for (std::size_t n = 0; n < force.size(); ++n) reaction[n] -= force[n];
  std::vector<Vec3> ties = mass.dofs().splitReactions(reaction);
  return {std::move(reaction), std::move(ties)};
}

}  // namespace dovetail::coupling
