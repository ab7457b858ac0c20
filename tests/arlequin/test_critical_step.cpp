#include <gtest/gtest.h>

#include "dovetail/arlequin/critical_step.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/dem/model/contact_step.hpp"
#include "dovetail/fem/motion/stable_step.hpp"
#include "tie_scenes.hpp"

namespace dovetail::arlequin {
namespace {

using namespace test;

/// Energy after many steps at a weight of the critical step, over that at the start.
double growth(double weight) {
  SceneOptions o;
  o.massFraction = 0.375;
  TieRun run = tieBar(o);
  std::mt19937 random(1);
  for (Vec3& v : run.grains.particles.v) v = randomVector(random, 1e-4);
  run.start(weight * criticalStep(run.grains, run.side, o.massFraction, run.tie).together);
  const double before = run.run->ledger().stored();
  try {
    for (int s = 0; s < 30; ++s) {
      run.run->advance(100);
      if (!std::isfinite(run.grains.particles.v[0].y) || norm(run.grains.particles.v[0]) > 1e3) return 1e30;
    }
  } catch (const NumericalError&) {  // farther than its radius in one step
    return 1e30;
  }
  return run.run->ledger().stored() / before;
}

TEST(CriticalStep, VerletIsBoundedBelowAndGrowsAboveIt) {
  EXPECT_LT(growth(0.98), 50.0);
  EXPECT_GT(growth(1.02), 1e6);
}

TEST(CriticalStep, TheDashpotsLimitWithUniformSharesIsTwo) {
  // No stiffness, w = ½ everywhere: stable for ε dt²/(ρ w (1 − w)) < 2.
  const auto endSpeed = [](double number) {
    SceneOptions o;
    o.across = 1;
    o.particlesPerEdge = 1;
    TieRun run;
    run.grains.particles = lattice({0, 0, 0}, {edge, 4 * edge, edge}, 1);
    for (Vec3& v : run.grains.particles.v) v.y = 1.0;
    dem::ElasticLaw law;
    law.normal.stiffness = 1e-9;
    run.grains.laws = dem::makeContactLaws(law);
    run.grains.sortEvery = 0;
    run.grains.pairs.setSkin(0.0);
    const fem::SolidMesh mesh = fem::boxOf(fem::ElementShape::hex8, {1, 4, 1}, {0, 0, 0}, {edge, 4 * edge, edge});
    const std::vector<double> weight(mesh.X.size(), 0.5);
    run.take(fem::makeModel(mesh));
    const fem::StVenantKirchhoff soft{1e-9, 0.0, bulk};
    run.solid->add(fem::makeSolid(mesh, fem::pointMaterial(fem::Material(soft)), {.fraction = solidWeights(weight)}));
    const double dt = 1e-3;
    CouplingOptions coupling;
    coupling.constraint = ConstraintKind::dashpot;
    coupling.penalty = number * bulk * 0.25 / (dt * dt);
    run.couple(mesh, weight, coupling);
    run.start(dt);
    try {
      run.run->advance(2000);
    } catch (const NumericalError&) {  // farther than its radius in one step
      return edge / dt;
    }
    return norm(run.grains.particles.v[1]);
  };
  EXPECT_LT(endSpeed(1.99), 2.0);
  EXPECT_GT(endSpeed(2.01), 1e2);
}

/// With elements, contacts and a penalty that all act on the same nodes.
TEST(CriticalStep, TheBoundOfARunHoldsAndCountsNothingTwice) {
  SceneOptions o;
  o.across = 1;
  for (const ConstraintKind kind : {ConstraintKind::penalty, ConstraintKind::multiplier}) {
    o.coupling.constraint = kind;
    TieRun run = tieBar(o);
    std::mt19937 random(2);
    for (Vec3& v : run.grains.particles.v) v = randomVector(random, 1e-4);
    run.start(1e-5);
    const double limit = run.run->criticalStep().dt;
    const double apart = fem::stableStep(*run.solid).dt, grains = dem::criticalStep(run.grains).dt;
    EXPECT_GE(limit, (1.0 - 1e-12) / std::sqrt(1.0 / (apart * apart) + 1.0 / (grains * grains)));
    const double exact = criticalStep(run.grains, run.side, 0.0, run.tie).together;
    EXPECT_LT(limit, exact);
    EXPECT_GT(limit, 0.9 * exact);
    run.start(0.9 * limit);
    const double first = run.energy();
    run.run->advance(3000);
    EXPECT_NEAR(run.energy(), first, 0.5 * first) << static_cast<int>(kind);
  }
}

}  // namespace
}  // namespace dovetail::arlequin
