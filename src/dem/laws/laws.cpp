#include "dovetail/dem/laws/laws.hpp"

#include <limits>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::dem {

namespace {
constexpr double pi = std::numbers::pi;
}

LinearSpringDashpot::Prepared LinearSpringDashpot::prepare() const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  return {stiffness, restitution == 1.0 ? 0.0 : damping(1.0), tension || bonded ? -infinity : 0.0,
          bonded ? infinity : 0.0};
}

double LinearSpringDashpot::contactTime(double effectiveMass) const {
  const double lnE = std::log(restitution);
  return std::sqrt(effectiveMass * (pi * pi + lnE * lnE) / stiffness);
}

double LinearSpringDashpot::damping(double effectiveMass) const {
  return -2.0 * effectiveMass * std::log(restitution) / contactTime(effectiveMass);
}

double restitutionWithoutTension(double restitution) {
  const double slope = -std::log(restitution) / pi;  // damping rate over damped frequency
  return std::pow(restitution, 1.0 - 2.0 / pi * std::atan(slope));
}

void validate(const LinearSpringDashpot& part) {
  requirePositive(part.stiffness, "contact stiffness");
  if (!(part.restitution > 0.0 && part.restitution <= 1.0))
    throw InputError("the restitution is " + formatNumber(part.restitution), "restitution",
                     "give 0 < e ≤ 1; e = 0 would take infinite damping, so take a small e such as 0.01 instead");
}

void validate(const TangentialSpring& part) {
  requirePositive(part.stiffness, "tangential stiffness");
  requireNonNegative(part.friction, "friction coefficient");
  requireNonNegative(part.dampingRatio, "damping ratio of the tangential spring");
}

}  // namespace dovetail::dem
