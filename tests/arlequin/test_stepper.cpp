#include <gtest/gtest.h>

#include "dovetail/arlequin/stepper.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/pairs/pair_collide.hpp"
#include "scenes.hpp"

namespace dovetail::arlequin {
namespace {

using namespace test;

SceneOptions sceneOf(ConstraintKind kind, GapForm form = GapForm::atParticles, double width = 0.0) {
  SceneOptions o;
  o.coupling.constraint = kind;
  o.coupling.form = form;
  o.coupling.projection.width = width;
  if (kind == ConstraintKind::dashpot) o.coupling.penalty = 2e8;
  o.massShare = 0.375;
  return o;
}

/// A pulse that runs from the particles into the solid, oblique to the bar.
void excite(Model& model) {
  for (std::size_t i = 0; i < model.discrete.particles.size(); ++i) {
    const double y = model.discrete.particles.x[i].y;
    if (y < 0.5) model.discrete.particles.v[i] = {0.002 * y, 0.1 * std::sin(2.0 * 3.14159265 * y), 0.001};
  }
}

struct Outcome {
  Model model;
  StepSums sums;
  double before, worstResidual = 0.0, worstMomentum = 0.0;
};

Outcome runScene(const SceneOptions& o, double dt, double time, int K = 1) {
  Outcome out{makeBar(o), {}, 0.0};
  Model& model = out.model;
  excite(model);
  Profile profile;
  start(model, dt, profile);
  out.before = energies(model).total();
  const Vec3 p0 = momentum(model);
  const int windows = static_cast<int>(std::lround(time / (K * dt)));
  for (int w = 0; w < windows; ++w) {
    stepExplicit(model, dt, K, out.sums, true, profile);
    const Energies e = energies(model);
    const double booked = -out.sums.couplingWork - e.coupling + out.sums.absorbed + out.sums.dissipated;
    out.worstResidual = std::max(out.worstResidual, std::abs(e.total() + booked - out.before));
    out.worstMomentum = std::max(out.worstMomentum, norm(momentum(model) - p0 - out.sums.supportImpulse) / norm(p0));
  }
  return out;
}

class EveryConstraint : public ::testing::TestWithParam<ConstraintKind> {};

TEST_P(EveryConstraint, MomentumIsKeptAndTheLedgerClosesAtSecondOrder) {
  const SceneOptions o = sceneOf(GetParam());
  const Outcome coarse = runScene(o, 2e-4, 0.06), fine = runScene(o, 1e-4, 0.06);
  EXPECT_LT(coarse.worstMomentum, 1e-12);
  EXPECT_LT(fine.worstResidual, 2e-2 * fine.before);
  EXPECT_NEAR(std::log2(coarse.worstResidual / fine.worstResidual), 2.0, 0.5);
}

TEST_P(EveryConstraint, AUniformVelocityGoesOnForEver) {
  SceneOptions o = sceneOf(GetParam());
  o.holdEnd = false;
  Model model = makeBar(o);
  const Vec3 v{0.3, -0.2, 0.1};
  for (Vec3& each : model.discrete.particles.v) each = v;
  for (Vec3& each : model.solid->nodes().v) each = v;
  Profile profile;
  StepSums sums;
  start(model, 2e-4, profile);
  for (int s = 0; s < 200; ++s) stepExplicit(model, 2e-4, 1, sums, false, profile);
  for (const Vec3& each : model.discrete.particles.v) EXPECT_LT(norm(each - v), 1e-9);
  for (const Vec3& each : model.solid->nodes().v) EXPECT_LT(norm(each - v), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Kinds, EveryConstraint,
                         ::testing::Values(ConstraintKind::penalty, ConstraintKind::multiplier,
                                           ConstraintKind::dashpot));

TEST(Stepper, PenaltyAndMultipliersDoNoNetWork) {
  for (const ConstraintKind kind : {ConstraintKind::penalty, ConstraintKind::multiplier})
    for (const GapForm form : {GapForm::atParticles, GapForm::nodal})
      for (const double width : {0.0, 0.9})
        for (const int K : {1, 4}) {
          const Outcome out = runScene(sceneOf(kind, form, width), 1e-4 / K, 0.04, K);
          EXPECT_LT(std::abs(out.sums.couplingWork + out.model.coupling->storedEnergy()), 1e-9 * out.before)
              << static_cast<int>(kind) << static_cast<int>(form) << ' ' << width << ' ' << K;
        }
}

TEST(Stepper, DashpotsLoseAndBookIt) {
  const Outcome out = runScene(sceneOf(ConstraintKind::dashpot), 1e-4, 0.06);
  EXPECT_LT(out.sums.couplingWork, -0.01 * out.before);
}

TEST(Stepper, MultipliersKeepTheGapClosed) {
  const Outcome out = runScene(sceneOf(ConstraintKind::multiplier), 2e-4, 0.06);
  for (const Vec3& g : out.model.coupling->gapNow) EXPECT_LT(norm(g), 1e-13);
}

TEST(Stepper, TheAbsorberTakesFluctuationsAndKeepsMomentum) {
  SceneOptions o = sceneOf(ConstraintKind::penalty);
  o.coupling.absorberRate = 100.0;
  const Outcome out = runScene(o, 1e-4, 0.06), without = runScene(sceneOf(ConstraintKind::penalty), 1e-4, 0.06);
  EXPECT_GT(out.sums.absorbed, 1e-4 * out.before);
  EXPECT_LT(out.worstMomentum, 1e-12);
  EXPECT_LT(out.worstResidual, 2.0 * without.worstResidual + 1e-4 * out.before);
}

TEST(Stepper, SubStepsConserveWithTheirSplittingEnergy) {
  for (const ConstraintKind kind : {ConstraintKind::penalty, ConstraintKind::multiplier}) {
    SceneOptions o = sceneOf(kind);
    o.coupling.penalty = kind == ConstraintKind::penalty ? 2.0 * modulus / (edge * edge) : 0.0;
    const Outcome out = runScene(o, 1e-4, 0.06, 4);
    EXPECT_LT(out.worstResidual, 2e-2 * out.before);
    EXPECT_LT(out.worstMomentum, 1e-12);
  }
}

TEST(Stepper, ImplicitSolidsKeepEnergyWithAPenaltyAndMomentumAlways) {
  for (const ConstraintKind kind : {ConstraintKind::penalty, ConstraintKind::multiplier}) {
    SceneOptions o = sceneOf(kind);
    Model model = makeBar(o);
    excite(model);
    const double dt = 1e-4;
    fem::ImplicitMotion solid(model.solid->model(), {.scheme = fem::newmark(), .massShare = o.massShare});
    Profile profile;
    StepSums sums;
    start(model, dt, profile);
    const double before = energies(model, &solid).total();
    const Vec3 p0 = momentum(model);
    for (int s = 0; s < 300; ++s) stepImplicit(model, solid, dt, 1, sums, true, profile);
    const Energies e = energies(model, &solid);
    EXPECT_NEAR(e.total() - sums.couplingWork - e.coupling, before, 1e-2 * before);
    EXPECT_NEAR(e.total(), before, 1e-2 * before);
    if (kind == ConstraintKind::penalty) {
      EXPECT_LT(std::abs(sums.couplingWork + e.coupling), 1e-9 * before);
    }
    EXPECT_LT(norm(momentum(model) - p0 - sums.supportImpulse), 1e-10 * norm(p0));
  }
}

TEST(Stepper, ResultsAreTheSameForAnyNumberOfThreads) {
  const SceneOptions o = sceneOf(ConstraintKind::penalty, GapForm::atParticles, 0.9);
  const Outcome one = runScene(o, 2e-4, 0.02);
  setThreads(2);
  const Outcome two = runScene(o, 2e-4, 0.02);
  setThreads(1);
  const Outcome again = runScene(o, 2e-4, 0.02);
  EXPECT_TRUE(one.model.discrete.particles.v == two.model.discrete.particles.v);
  EXPECT_TRUE(one.model.solid->nodes().v == two.model.solid->nodes().v);
  EXPECT_TRUE(one.model.discrete.particles.v == again.model.discrete.particles.v);
}

TEST(Stepper, ACouplingThatDoesNotFitIsRefused) {
  Profile profile;
  Model model = makeBar({});
  dem::addParticle(model.discrete.particles, {0, 0, 0}, {}, 0.1, dem::Mass{1.0});
  EXPECT_THROW(start(model, 1e-4, profile), InputError);
  Model alone = makeBar({});
  alone.solid.reset();
  EXPECT_THROW(start(alone, 1e-4, profile), InputError);
}

TEST(Stepper, ParticlesAloneNeedNoOtherPart) {
  Model model;
  model.discrete.particles = lattice({0, 0, 0}, {0.5, 2, 0.5}, 2);
  model.discrete.pairs.setSkin(0.01);
  dem::findPairs(model.discrete.particles, model.discrete.pairs);
  dem::ElasticLaw law;
  law.normal.stiffness = 1e5;
  law.normal.bonded = true;
  model.discrete.laws = dem::makeContactLaws(law);
  model.discrete.sortEvery = 0;
  model.discrete.particles.v[0].y = 0.1;
  Profile profile;
  StepSums sums;
  start(model, 1e-4, profile);
  const double before = energies(model).total();
  for (int s = 0; s < 1000; ++s) stepExplicit(model, 1e-4, 1, sums, false, profile);
  EXPECT_NEAR(energies(model).total(), before, 1e-3 * before);
}

}  // namespace
}  // namespace dovetail::arlequin
