#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "tie_scenes.hpp"

namespace dovetail::arlequin {
namespace {

using namespace test;

SceneOptions sceneOf(ConstraintKind kind, double width = 0.0) {
  SceneOptions o;
  o.coupling.constraint = kind;
  o.coupling.projection.width = width;
  if (kind == ConstraintKind::dashpot) o.coupling.penalty = 2e8;
  o.massFraction = 0.375;
  return o;
}

constexpr std::array kinds = {ConstraintKind::penalty, ConstraintKind::multiplier, ConstraintKind::dashpot};

struct Residuals {
  double energy, momentum, mass, first;
};

Residuals residuals(TieRun run, double dt, double time) {
  excite(run.grains.particles);
  run.start(dt);
  const double first = run.energy(), mass = run.mass();
  const Vec3 momentum = run.momentum();
  Residuals worst{0.0, 0.0, 0.0, first};
  for (int s = 0; s < static_cast<int>(std::lround(time / dt)); ++s) {
    run.step(dt);
    worst.energy = std::max(worst.energy, std::abs(run.energy() - first));
    worst.momentum = std::max(worst.momentum, norm(run.momentum() - momentum) / norm(momentum));
    worst.mass = std::max(worst.mass, std::abs(run.mass() / mass - 1.0));
  }
  return worst;
}

TEST(ArlequinCoupling, KeepsMomentumAndItsBooksInCellsOfAnyShape) {
  for (const fem::ElementShape shape : {fem::ElementShape::hex8, fem::ElementShape::hex20, fem::ElementShape::hex27,
                                        fem::ElementShape::tet4, fem::ElementShape::tet10})
    for (const ConstraintKind kind : kinds) {
      SceneOptions o = sceneOf(kind);
      o.massFraction = 0.0;
      o.weights.floor = 0.02;
      o.coupling.leastWeight = 0.02;
      if (kind == ConstraintKind::dashpot) o.coupling.penalty = 5e6;
      o.across = 1;
      const double dt = 1e-4;
      const Residuals coarse = residuals(tieBar(o, shape), dt, 0.03),
                      fine = residuals(tieBar(o, shape), 0.5 * dt, 0.03);
      EXPECT_LT(coarse.momentum, 1e-12) << fem::name(shape) << static_cast<int>(kind);
      EXPECT_LT(coarse.mass, 1e-13);
      EXPECT_LT(fine.energy, 1e-2 * fine.first) << fem::name(shape) << static_cast<int>(kind);
      EXPECT_NEAR(std::log2(coarse.energy / fine.energy), 2.0, 0.5) << fem::name(shape) << static_cast<int>(kind);
    }
}

/// Random motion of both sides: forces against the gradient of the stored energy.
TEST(ArlequinCoupling, ForcesAreMinusTheGradientOfTheStoredEnergy) {
  for (const double width : {0.0, 0.9}) {
    TieRun run = tieBar(sceneOf(ConstraintKind::penalty, width), fem::ElementShape::hex8);
    run.start();
    std::mt19937 random(3);
    for (Vec3& x : run.grains.particles.x) x += randomVector(random, 1e-3);
    for (Vec3& u : run.solid->nodes.u) u = randomVector(random, 1e-3);
    const auto evaluate = [&] {
      run.side->load.clear();
      dem::clearForces(run.grains.particles);
      dem::Step step;
      step.dt = 1e-100;
      step.timeless = true;
      run.tie->addForces(run.grains, step);
      return run.tie->stored();
    };
    evaluate();
    const std::vector<Vec3> onParticles = run.grains.particles.f, onNodes = run.side->load.force;
    const auto check = [&](double& place, double force, double size) {
      const double before = place, step = 1e-5;
      place = before + step;
      const double above = evaluate();
      place = before - step;
      const double below = evaluate();
      place = before;
      EXPECT_NEAR(force, -(above - below) / (2.0 * step), 1e-6 * size);
    };
    double size = 0.0;
    for (const Vec3& f : onNodes) size = std::max(size, norm(f));
    for (int k = 0; k < 3; ++k) {
      for (const std::size_t n : {std::size_t{4}, std::size_t{13}, std::size_t{22}})
        check(run.solid->nodes.u[n][k], onNodes[n][k], size);
      for (const int i : {run.tie->overlap().particle.front(), run.tie->overlap().particle[37]})
        check(run.grains.particles.x[static_cast<std::size_t>(i)][k], onParticles[static_cast<std::size_t>(i)][k],
              size);
    }
  }
}

TEST(ArlequinCoupling, GivesTheSameBitsForAnyNumberOfThreads) {
  for (const ConstraintKind kind : kinds) {
    SceneOptions o = sceneOf(kind);
    o.coupling.absorberRate = 50.0;
    const auto finish = [&](int threads) {
      setThreads(threads);
      TieRun run = tieBar(o);
      excite(run.grains.particles);
      run.start();
      for (int s = 0; s < 100; ++s) run.step(1e-4);
      setThreads(1);
      return run.grains.particles.v;
    };
    EXPECT_TRUE(finish(1) == finish(2)) << static_cast<int>(kind);
  }
}

}  // namespace
}  // namespace dovetail::arlequin
