// Linear and angular momentum of particles and solid together.
#include <gtest/gtest.h>

#include "coupled_block.hpp"

namespace dovetail::surface {
namespace {

constexpr double dt = 4e-4;
constexpr int macroSteps = 250;

double particleMass(const dem::Particles& particles) {
  double sum = 0.0;
  for (double m : particles.mass) sum += m;
  return sum;
}

/// Largest departure from P₀ + m g t, and from L₀, relative to the largest momentum of the particles.
struct Departure {
  double momentum = 0.0, angular = 0.0;
};

Departure departure(const BlockSetup& setup, int K) {
  const auto run = makeRun(setup);
  run->start(dt, {.stepsPerMacroStep = K});
  const coupling::Totals before = run->totals();
  const double mass = particleMass(run->grains.particles), size = 0.3 * mass;
  Departure worst;
  for (int w = 1; w <= macroSteps; ++w) {
    run->advance();
    const coupling::Totals now = run->totals();
    const Vec3 gained = mass * run->time() * run->grains.gravity;
    worst.momentum = std::max(worst.momentum, norm(now.momentum - before.momentum - gained) / size);
    worst.angular = std::max(worst.angular, norm(now.angularMomentum - before.angularMomentum) / (size * 0.3));
  }
  return worst;
}

TEST(Momentum, OfAFreeBlockGrowsByTheWeightOnly) {
  for (const int K : {1, 3})
    for (const bool smooth : {false, true})
      EXPECT_LT(departure({.held = false, .restitution = 0.8, .width = 0.15, .smooth = smooth}, K).momentum, 1e-13);
  for (const int K : {1, 3})
    EXPECT_LT(departure({.held = false, .restitution = 0.8, .width = 0.15, .spread = true}, K).momentum, 1e-13);
}

TEST(Momentum, AngularMomentumIsKeptByEveryKernel) {
  for (const double width : {0.0, 0.3, 0.15})
    for (const bool smooth : {false, true})
      EXPECT_LT(departure({.held = false, .width = width, .smooth = smooth, .gravity = {}}, 1).angular, 1e-12) << width;
}

TEST(Momentum, OfAnImplicitSolidIsKeptToTheSolversTolerance) {
  for (const int K : {1, 2, 3})
    EXPECT_LT(departure({.stepping = Stepping::implicitSteps, .held = false}, K).momentum, 1e-9) << "K = " << K;
}

Vec3 onHeldNodes(const fem::Nodes& nodes) {
  Vec3 sum;
  for (std::size_t i = 0; i < nodes.f.size(); ++i)
    if (nodes.fixed[i] == fem::allComponents) sum += nodes.f[i];
  return sum;
}

/// Without sub-steps nodes.f holds elements and contacts together.
TEST(Momentum, OfAHeldBlockGrowsByWeightAndSupports) {
  const auto run = makeRun({});
  run->start(dt);
  const double mass = particleMass(run->grains.particles);
  const Vec3 before = run->totals().momentum, weight = mass * run->grains.gravity;
  Vec3 impulse;
  double supports = 0.0, worst = 0.0;
  for (int w = 0; w < macroSteps; ++w) {
    for (int end = 0; end < 2; ++end) {
      const Vec3 kept = onHeldNodes(run->solid(0).nodes());
      impulse += 0.5 * dt * (weight - kept);
      supports = std::max(supports, dt * norm(kept));
      if (end == 0) run->advance();
    }
    worst = std::max(worst, norm(run->totals().momentum - before - impulse));
  }
  EXPECT_GT(supports, dt * norm(weight));
  EXPECT_LT(worst, 1e-13 * mass);
}

}  // namespace
}  // namespace dovetail::surface
