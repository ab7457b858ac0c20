// Parameters of the laws' parts, checked and prepared.
#include <limits>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/laws/adhesion.hpp"
#include "dovetail/dem/laws/elastic_plastic.hpp"
#include "dovetail/dem/laws/hertz_mindlin.hpp"
#include "dovetail/dem/laws/liquid_bridge.hpp"
#include "dovetail/dem/laws/restitution.hpp"
#include "dovetail/dem/laws/rolling.hpp"

namespace dovetail::dem {

namespace {
constexpr double infinity = std::numeric_limits<double>::infinity();
}

double HertzDashpot::dampingRatio() const {
  return tension || nominal ? dampingRatioOf(restitution) : dampingRatioWithoutTension(restitution);
}

HertzDashpot::Prepared HertzDashpot::prepare() const {
  return {2.0 * effectiveModulus, std::sqrt(10.0 / 3.0) * dampingRatio(), tension ? -infinity : 0.0};
}

double HertzDashpot::largestOverlap(double effectiveMass, double effectiveRadius, double speed) const {
  return std::pow(15.0 * effectiveMass * speed * speed / (16.0 * effectiveModulus * std::sqrt(effectiveRadius)), 0.4);
}

double HertzDashpot::contactTime(double effectiveMass, double effectiveRadius, double speed) const {
  // 2 ∫₀¹ dx/√(1 − x^(5/2)) = (4/5) √π Γ(2/5)/Γ(9/10)
  const double duration = 0.8 * std::sqrt(std::numbers::pi) * std::tgamma(0.4) / std::tgamma(0.9);
  return duration * largestOverlap(effectiveMass, effectiveRadius, speed) / speed;
}

ElasticPlastic::Prepared ElasticPlastic::prepare() const {
  const double k1 = loadingStiffness, k2 = unloadingStiffness, kc = cohesionStiffness;
  // Work per ½ δ₀²: force on the bound, k₁ δ or k_c δ, over δ₀/δ.
  const double lower = 1.0 - k1 / k2;
  Prepared prepared{.stiffness = k2,
                    .lower = lower,
                    .upper = kc > 0.0 ? 1.0 + kc / k2 : std::numeric_limits<double>::max(),
                    .yield = lower > 0.0 ? k1 / lower : 0.0,
                    .yieldCohesion = kc / (1.0 + kc / k2),
                    .leastElastic = kc > 0.0 ? -infinity : 0.0,
                    .dampingPerRootMass = 2.0 * dampingRatio * std::sqrt(k2)};
  return prepared;
}

void validate(const HertzDashpot& part) {
  requirePositive(part.effectiveModulus, "effective modulus");
  if (!(part.restitution > 0.0 && part.restitution <= 1.0))
    throw InputError("the restitution is " + formatNumber(part.restitution), "restitution",
                     "give 0 < e ≤ 1; e = 0 would take infinite damping, so take a small e such as 0.01 instead");
  if (part.tension && part.nominal)
    throw InputError("a contact with tension has its nominal restitution anyway", "nominal", "leave nominal off");
}

void validate(const MindlinSpring& part) {
  requirePositive(part.stiffnessRatio, "ratio of tangential to normal stiffness");
  requireNonNegative(part.friction, "friction coefficient");
  requireNonNegative(part.dampingRatio, "damping ratio of the tangential spring");
}

void validate(const ElasticPlastic& part) {
  requirePositive(part.loadingStiffness, "loading stiffness");
  requirePositive(part.unloadingStiffness, "unloading stiffness");
  if (part.unloadingStiffness < part.loadingStiffness)
    throw InputError("the unloading stiffness " + formatNumber(part.unloadingStiffness) +
                         " N/m is below the loading one, " + formatNumber(part.loadingStiffness) +
                         " N/m: a cycle would create energy",
                     "unloading stiffness", "give k₂ ≥ k₁; e = √(k₁/k₂)");
  requireNonNegative(part.cohesionStiffness, "cohesion stiffness");
  requireNonNegative(part.dampingRatio, "damping ratio");
}

namespace {
template <class Part>
void validateResistance(const Part& part, const std::string& which) {
  requireNonNegative(part.friction, which + " friction");
  requirePositive(part.stiffnessRatio, which + " stiffness ratio");
  requireNonNegative(part.dampingRatio, which + " damping ratio");
}
}  // namespace

void validate(const RollingResistance& part) { validateResistance(part, "rolling"); }
void validate(const TwistingResistance& part) { validateResistance(part, "twisting"); }
void validate(const ConstantCohesion& part) { requireNonNegative(part.force, "cohesion force"); }
void validate(const LinearCohesion& part) {
  requireNonNegative(part.stiffness, "cohesion stiffness");
  requireNonNegative(part.pressure, "cohesion pressure");
}
void validate(const DmtAdhesion& part) { requireNonNegative(part.work, "work of adhesion"); }
void validate(const LiquidBridge& part) {
  requireNonNegative(part.surfaceTension, "surface tension");
  requirePositive(part.volume, "volume of a liquid bridge");
  if (!(part.contactAngle >= 0.0 && part.contactAngle < 0.5 * std::numbers::pi))
    throw InputError("the contact angle is " + formatNumber(part.contactAngle) + " rad", "liquid bridge",
                     "give 0 ≤ θ < π/2; others do not wet");
}
void validate(const Cohesion& part) {
  validate(ConstantCohesion{part.force});
  validate(LinearCohesion{part.stiffness, part.pressure});
  validate(DmtAdhesion{part.work});
}

}  // namespace dovetail::dem
