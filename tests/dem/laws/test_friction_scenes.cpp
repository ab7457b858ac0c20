// Friction in scenes with known answers, and memories that follow their particles.
#include <gtest/gtest.h>

#include <numbers>

#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/laws/adhesion.hpp"
#include "dovetail/dem/laws/elastic_plastic.hpp"
#include "dovetail/dem/laws/rolling.hpp"
#include "model/impact_scenes.hpp"

namespace dovetail::dem {
namespace {

struct Descent {
  double acceleration, slip;  // along the incline, m/s²; of the contact point at the end, m/s
};

/// A sphere released on a plane that is inclined by tan θ. Gravity is turned on slowly, so that it does not bounce.
template <class Law>
Descent descend(const Law& law, double tangent) {
  const double radius = 0.1, g = 10.0, angle = std::atan(tangent), sine = std::sin(angle), cosine = std::cos(angle);
  Impact scene(aboveWall(radius, 1000.0, {}), law, true);
  const double dt = 2e-5, ramp = 0.1;
  double start = 0.0;
  const int steps = 20000;
  for (int s = 0; s < steps; ++s) {
    const double fraction = std::min(1.0, s * dt / ramp);
    scene.step(dt, (g * fraction) * Vec3{sine, 0, -cosine});
    if (s == steps / 2) start = scene.particles.v[0].x;
  }
  const Particles& p = scene.particles;
  return {(p.v[0].x - start) / (dt * (steps / 2 - 1)), p.v[0].x - p.omega[0].y * radius};
}

TEST(Incline, ASphereRollsUpToSevenHalvesOfTheFrictionAndSlidesBeyond) {
  const double mu = 0.2, g = 10.0;
  const Material stiff{1e9, 0.3, 1000.0};  // the arm is R − δ
  const auto hertz = hertzMindlin(stiff, stiff, {0.5, mu, 1.0});
  const FrictionalLaw linear{{1e6, 0.5}, {8e5, mu, 1.0}};
  for (const double fraction : {0.3, 0.97, 1.03, 2.0}) {
    const double tangent = 3.5 * mu * fraction, angle = std::atan(tangent);
    const double expected =
        fraction < 1.0 ? 5.0 / 7.0 * g * std::sin(angle) : g * (std::sin(angle) - mu * std::cos(angle));
    for (const Descent& d : {descend(hertz, tangent), descend(linear, tangent)}) {
      EXPECT_NEAR(d.acceleration, expected, 2e-3 * expected) << fraction;
      if (fraction < 1.0) {
        EXPECT_LE(std::abs(d.slip), 3e-3);
      } else {
        EXPECT_GE(d.slip, 0.02);
      }
    }
  }
}

TEST(Incline, RollingResistanceHoldsASphereUpToItsFriction) {
  // It rolls if the moment of gravity about the contact, m g R sin θ, exceeds μ_r R m g cos θ.
  const Material soft{1e7, 0.3, 1000.0};
  const auto base = hertzMindlin(soft, soft, {0.5, 0.9, 1.0});
  const ContactLaw<HertzDashpot, MindlinSpring, RollingResistance> law{
      base.normal, base.tangential, {0.1, 0.2, 1.0}, {}};
  EXPECT_NEAR(descend(law, 0.09).acceleration, 0.0, 1e-3);
  const double beyond = std::atan(0.2);
  EXPECT_NEAR(descend(law, 0.2).acceleration, 5.0 / 7.0 * 10.0 * (std::sin(beyond) - 0.1 * std::cos(beyond)), 1e-2);
}

/// A cloud of spheres that falls together; positions and spins by id at the end.
template <class Law>
std::vector<std::array<Vec3, 2>> fall(const Law& law, bool sorts) {
  Random random(12);
  Particles particles;
  for (int i = 0; i < 300; ++i) {
    const Vec3 x = random.vector(0.22);
    addParticle(particles, x, -4.0 * x + random.vector(1.0), random(0.02, 0.04), Density{1000.0});
  }
  switchOnRotation(particles);
  PairList list;
  list.setSkin(0.01);
  findPairs(particles, list);
  const auto laws = makeContactLaws(law);
  const double dt = 2e-5;
  for (int s = 0; s < 301; ++s) {
    kick(particles, 0.5 * dt);
    drift(particles, dt);
    if (sorts && s % 7 == 3) sortParticles(particles, list);
    updatePairs(particles, list);
    clearForces(particles);
    laws->pairs(particles, list, dt, Booking::on);
    kick(particles, 0.5 * dt);
  }
  std::vector<std::array<Vec3, 2>> state(particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i)
    state[static_cast<std::size_t>(particles.id[i])] = {particles.x[i], particles.omega[i]};
  return state;
}

TEST(Memory, SurvivesSortingWhateverTheLaw) {
  const auto compare = [](const auto& law) {
    const auto plain = fall(law, false), sorted = fall(law, true);
    double spins = 0.0;
    for (std::size_t i = 0; i < plain.size(); ++i) {
      // Only the order of sums differs; the scene amplifies round-off a little.
      EXPECT_LE(norm(plain[i][0] - sorted[i][0]), 1e-12);
      EXPECT_LE(norm(plain[i][1] - sorted[i][1]), 1e-8 * (1.0 + norm(plain[i][1])));
      spins = std::max(spins, norm(plain[i][1]));
    }
    EXPECT_GT(spins, 1.0);
  };
  const Material soft{1e7, 0.3, 1000.0};
  const auto base = hertzMindlin(soft, soft, {0.7, 0.5, 0.5});
  const RollingAndTwisting rolling{{0.2, 0.5, 0.1}, {0.1, 0.3, 0.2}};
  compare(ContactLaw<HertzDashpot, MindlinSpring, RollingAndTwisting, DmtAdhesion>{
      base.normal, base.tangential, rolling, {0.1}});
  compare(ContactLaw<ElasticPlastic, TangentialSpring, RollingAndTwisting>{
      {2e4, 6e4, 1e4, 0.05}, {4e4, 0.4, 0.5}, rolling, {}});
}

TEST(Memory, FullLawsAreBitwiseTheSameForAnyNumberOfThreads) {
  const ContactLaw<ElasticPlastic, TangentialSpring, RollingAndTwisting> law{
      {2e4, 6e4, 1e4, 0.05}, {4e4, 0.4, 0.5}, {{0.2, 0.5, 0.1}, {0.1, 0.3, 0.2}}, {}};
  const auto one = fall(law, true);
  setThreads(3);
  const auto three = fall(law, true);
  setThreads(1);
  EXPECT_TRUE(one == three);
}

}  // namespace
}  // namespace dovetail::dem
