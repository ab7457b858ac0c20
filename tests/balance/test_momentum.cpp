// Linear and angular momentum of particles and solid together.
#include <gtest/gtest.h>

#include "coupled_block.hpp"

namespace dovetail::surface {
namespace {

constexpr double dt = 4e-4;
constexpr int windows = 250;

template <class Model>
Vec3 momentumOf(const Model& model) {
  return dem::momentum(model.discrete.particles) + fem::momentum(model.solid->nodes);
}
template <class Model>
Vec3 angularMomentumOf(const Model& model) {
  return dem::angularMomentum(model.discrete.particles) + fem::angularMomentum(model.solid->nodes);
}
double particleMass(const dem::Particles& particles) {
  double sum = 0.0;
  for (double m : particles.mass) sum += m;
  return sum;
}

/// Largest departure from P₀ + m g t, and from L₀, relative to the largest momentum of the particles.
struct Departure {
  double momentum = 0.0, angular = 0.0;
};

template <class Model, class Window>
Departure departure(Model model, int K, Window&& window) {
  Profile profile;
  start(model, dt, profile);
  const Vec3 momentum0 = momentumOf(model), angular0 = angularMomentumOf(model);
  const Vec3 weight = particleMass(model.discrete.particles) * model.discrete.gravity;
  const double size = particleMass(model.discrete.particles) * 0.3;
  Departure worst;
  for (int w = 1; w <= windows; ++w) {
    window(model, profile);
    worst.momentum = std::max(worst.momentum, norm(momentumOf(model) - momentum0 - (w * K * dt) * weight) / size);
    worst.angular = std::max(worst.angular, norm(angularMomentumOf(model) - angular0) / (size * 0.3));
  }
  return worst;
}

TEST(Momentum, OfAFreeBlockGrowsByTheWeightOnly) {
  const BlockSetup damped{.held = false, .restitution = 0.8, .width = 0.15};
  for (int K : {1, 3}) {
    const auto window = [&](auto& model, Profile& profile) { stepExplicit(model, dt, K, {}, false, profile); };
    EXPECT_LT(departure(flatModel(damped), K, window).momentum, 1e-13);
    EXPECT_LT(departure(smoothModel(damped), K, window).momentum, 1e-13);
    BlockSetup spread = damped;
    spread.spread = true;
    EXPECT_LT(departure(flatModel(spread), K, window).momentum, 1e-13);
  }
}

TEST(Momentum, AngularMomentumIsKeptWhereMomentsBalance) {
  BlockSetup setup{.held = false, .gravity = {}};
  const auto window = [](auto& model, Profile& profile) { stepExplicit(model, dt, 1, {}, false, profile); };
  EXPECT_LT(departure(flatModel(setup), 1, window).angular, 1e-12);
  EXPECT_LT(departure(smoothModel(setup), 1, window).angular, 1e-12);
  for (setup.width = 0.3; setup.width > 0.1; setup.width *= 0.5) {
    EXPECT_LT(departure(flatModel(setup), 1, window).angular, 1e-12) << setup.width;
    EXPECT_LT(departure(smoothModel(setup), 1, window).angular, 1e-12) << setup.width;
  }
}

TEST(Momentum, OfAnImplicitSolidIsKeptToTheSolversTolerance) {
  for (int K : {1, 2, 3}) {
    CoupledModel model = flatModel({.held = false});
    fem::ImplicitMotion solid(*model.solid, newmarkLumped());
    const auto window = [&](auto& m, Profile& profile) { stepImplicit(m, solid, dt, K, {}, false, profile); };
    EXPECT_LT(departure(std::move(model), K, window).momentum, 1e-9) << "K = " << K;
  }
}

Vec3 onHeldNodes(const fem::Nodes& nodes, std::span<const Vec3> force) {
  Vec3 sum;
  for (std::size_t i = 0; i < force.size(); ++i)
    if (nodes.fixed[i] == fem::allComponents) sum += force[i];
  return sum;
}

TEST(Momentum, OfAHeldBlockGrowsByWeightAndSupports) {
  CoupledModel model = flatModel({});
  Profile profile;
  start(model, dt, profile);
  const Vec3 momentum0 = momentumOf(model), weight = particleMass(model.discrete.particles) * model.discrete.gravity;
  Vec3 impulse;
  double supports = 0.0, worst = 0.0;
  for (int w = 0; w < windows; ++w) {
    for (int end = 0; end < 2; ++end) {
      const Vec3 kept = onHeldNodes(model.solid->nodes, model.solid->nodes.f) +
                        onHeldNodes(model.solid->nodes, model.seam.load().force);
      impulse += 0.5 * dt * (weight - kept);
      supports = std::max(supports, dt * norm(kept));
      if (end == 0) stepExplicit(model, dt, 1, {}, false, profile);
    }
    worst = std::max(worst, norm(momentumOf(model) - momentum0 - impulse));
  }
  EXPECT_GT(supports, dt * norm(weight));
  EXPECT_LT(worst, 1e-13 * particleMass(model.discrete.particles));
}

}  // namespace
}  // namespace dovetail::surface
