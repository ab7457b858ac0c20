// Contact laws of a scene.
#include <cmath>
#include <numbers>

#include "dovetail/dem/laws/materials.hpp"
#include "dovetail/dem/laws/rolling.hpp"
#include "parts.hpp"

namespace dovetail::scene {

namespace {

template <class Part>
Part resistance(const Rolling& rolling) {
  return {.friction = rolling.friction, .stiffnessRatio = rolling.stiffnessRatio, .dampingRatio = rolling.dampingRatio};
}

template <class Normal, class Tangential>
std::shared_ptr<const dem::ContactLaws> withParts(const Normal& normal, const Tangential& tangential,
                                                  const ContactLaw& law) {
  using dem::RollingResistance, dem::TwistingResistance, dem::RollingAndTwisting, dem::makeContactLaws;
  if (law.rolling && law.twisting)
    return makeContactLaws(dem::ContactLaw<Normal, Tangential, RollingAndTwisting>{
        normal,
        tangential,
        {resistance<RollingResistance>(*law.rolling), resistance<TwistingResistance>(*law.twisting)}});
  if (law.rolling)
    return makeContactLaws(dem::ContactLaw<Normal, Tangential, RollingResistance>{
        normal, tangential, resistance<RollingResistance>(*law.rolling)});
  if (law.twisting)
    return makeContactLaws(dem::ContactLaw<Normal, Tangential, TwistingResistance>{
        normal, tangential, resistance<TwistingResistance>(*law.twisting)});
  if (law.friction > 0.0) return makeContactLaws(dem::ContactLaw<Normal, Tangential>{normal, tangential});
  return makeContactLaws(dem::ContactLaw<Normal>{normal});
}

std::shared_ptr<const dem::ContactLaws> lawsOf(const LinearContact& linear, const ContactLaw& law) {
  const dem::LinearSpringDashpot normal{.stiffness = linear.stiffness, .restitution = law.restitution};
  const dem::TangentialSpring tangential{.stiffness = linear.tangentialStiffness.value_or(2.0 / 7.0 * linear.stiffness),
                                         .friction = law.friction,
                                         .dampingRatio = law.tangentialDampingRatio};
  return withParts(normal, tangential, law);
}

std::shared_ptr<const dem::ContactLaws> lawsOf(const HertzContact& hertz, const ContactLaw& law) {
  const dem::Material material{hertz.youngsModulus, hertz.poissonRatio, 0.0};
  const dem::HertzMindlinLaw both =
      dem::hertzMindlin(material, material, {law.restitution, law.friction, law.tangentialDampingRatio});
  return withParts(both.normal, both.tangential, law);
}

double stiffnessOf(const LinearContact& linear, double) { return linear.stiffness; }
double stiffnessOf(const HertzContact& hertz, double radius) {
  const dem::Material material{hertz.youngsModulus, hertz.poissonRatio, 0.0};
  return 2.0 * dem::effectiveModulus(material, material) * std::sqrt(0.5 * radius * 0.05 * radius);
}

}  // namespace

std::shared_ptr<const dem::ContactLaws> makeLaws(const ContactLaw& law) {
  return atPlace(law.where,
                 [&] { return std::visit([&](const auto& kind) { return lawsOf(kind, law); }, law.normal); });
}

double impactLimit(const ContactLaw& law, double radius, double density) {
  const double stiffness = std::visit([&](const auto& kind) { return stiffnessOf(kind, radius); }, law.normal);
  const double mass = density * 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
  return 2.0 * std::sqrt(0.5 * mass / stiffness);
}

}  // namespace dovetail::scene
