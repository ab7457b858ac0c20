#include "dovetail/dem/laws/laws.hpp"

#include <limits>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/laws/restitution.hpp"

namespace dovetail::dem {

namespace {
constexpr double pi = std::numbers::pi;
}

LinearSpringDashpot::Prepared LinearSpringDashpot::prepare() const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  return {stiffness, restitution == 1.0 ? 0.0 : damping(1.0), tension || bonded ? -infinity : 0.0,
          bonded ? infinity : 0.0};
}

double LinearSpringDashpot::dampingRatio() const {
  return tension || bonded || nominal ? dampingRatioOf(restitution) : dampingRatioWithoutTension(restitution);
}

namespace {
/// Half a period of the damped oscillator.
double halfPeriod(const LinearSpringDashpot& part, double effectiveMass) {
  const double lnE = std::log(part.restitution);
  return std::sqrt(effectiveMass * (pi * pi + lnE * lnE) / part.stiffness);
}
}  // namespace

double LinearSpringDashpot::contactTime(double effectiveMass) const {
  if (tension || bonded || nominal || restitution == 1.0) return halfPeriod(*this, effectiveMass);
  const double z = dampingRatio(), root = std::sqrt(std::abs(1.0 - z * z)), unit = std::sqrt(effectiveMass / stiffness);
  if (root < 1e-6) return 2.0 * unit;
  return 2.0 * unit / root * (z < 1.0 ? std::atan2(root, z) : std::log(z + root));
}

double LinearSpringDashpot::damping(double effectiveMass) const {
  if (tension || bonded || nominal)
    return -2.0 * effectiveMass * std::log(restitution) / halfPeriod(*this, effectiveMass);
  return 2.0 * dampingRatio() * std::sqrt(stiffness * effectiveMass);
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
  if (part.nominal && (part.tension || part.bonded))
    throw InputError("a contact with tension has its nominal restitution anyway", "nominal", "leave nominal off");
}

void validate(const TangentialSpring& part) {
  requirePositive(part.stiffness, "tangential stiffness");
  requireNonNegative(part.friction, "friction coefficient");
  requireNonNegative(part.dampingRatio, "damping ratio of the tangential spring");
}

}  // namespace dovetail::dem
