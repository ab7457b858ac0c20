#include "dovetail/dem/laws.hpp"

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::dem {

namespace {
constexpr double pi = std::numbers::pi;
}

LinearSpringDashpot::Prepared LinearSpringDashpot::prepare() const {
  if (restitution == 1.0) return {stiffness, 0.0, tension || bonded, bonded};
  return {stiffness, damping(1.0), tension || bonded, bonded};
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

TangentialSpring::Result TangentialSpring::respond(Vec3& stretch, const Vec3& normal, const Vec3& velocity,
                                                   double normalForce, double dt) const {
  // The contact plane has turned since the last step: lay the stretch into it without changing its length.
  const double before = squaredNorm(stretch);
  stretch -= dot(stretch, normal) * normal;
  const double after = squaredNorm(stretch);
  if (after > 0.0) stretch *= std::sqrt(before / after);

  stretch += dt * (velocity - dot(velocity, normal) * normal);
  const double trial = norm(stretch);
  const double limit = normalForce > 0.0 ? friction * normalForce / stiffness : 0.0;
  double slipWork = 0.0;
  if (trial > limit) {
    stretch *= limit / trial;
    slipWork = stiffness * limit * (trial - limit);
  }
  return {-stiffness * stretch, 0.5 * stiffness * squaredNorm(stretch), slipWork};
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
}

}  // namespace dovetail::dem
