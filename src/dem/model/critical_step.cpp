#include "dovetail/dem/model/critical_step.hpp"

#include <algorithm>
#include <limits>

#include "dovetail/core/error.hpp"

namespace dovetail::dem {

CriticalStep criticalStep(const Particles& particles, const LinearSpringDashpot& normal, Partners partners,
                          int contacts) {
  validate(normal);
  if (contacts < 1)
    throw InputError("the number of contacts is " + std::to_string(contacts), "critical step", "give 1 or more");
  if (particles.size() == 0) return {std::numeric_limits<double>::infinity(), -1};
  const auto lightest = std::min_element(particles.mass.begin(), particles.mass.end());
  const double effectiveMass = partners == Partners::walls ? *lightest : 0.5 * *lightest;
  const double stiffness = contacts * normal.stiffness, damping = contacts * normal.damping(effectiveMass);
  const double omega = std::sqrt(stiffness / effectiveMass);
  const double ratio = damping / (2.0 * effectiveMass * omega);
  return {2.0 / omega * (std::sqrt(1.0 + ratio * ratio) - ratio), static_cast<int>(lightest - particles.mass.begin())};
}

}  // namespace dovetail::dem
