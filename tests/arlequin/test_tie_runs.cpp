// Overlap ties in macro steps of every kind.
#include <gtest/gtest.h>

#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "tie_scenes.hpp"

namespace dovetail::arlequin {
namespace {

using namespace test;
using coupling::Stepping;

struct Case {
  const char* name;
  ConstraintKind kind;
  Stepping stepping;
  int K;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

/// A pulse that runs from the particles into the solid, oblique to the bar.
TieRun started(const Case& c, double dt, bool hold = true, double width = 0.0) {
  SceneOptions o;
  o.across = 1;
  o.holdEnd = hold;
  o.massFraction = 0.375;
  o.coupling.constraint = c.kind;
  o.coupling.projection.width = width;
  if (c.kind == ConstraintKind::penalty) o.coupling.penalty = 2.0 * modulus / (edge * edge);
  if (c.kind == ConstraintKind::dashpot) o.coupling.penalty = 1e7;
  TieRun run = tieBar(o, fem::ElementShape::hex8, c.stepping);
  excite(run.grains.particles);
  run.K = c.K;
  run.start(dt);
  return run;
}

class TieRuns : public testing::TestWithParam<Case> {};

/// Largest residual while the pulse goes through the overlap, over the energy at the start.
double residualOf(TieRun run) {
  const double first = run.run->ledger().storedAtOpening();
  const auto macroSteps = static_cast<std::int64_t>(std::llround(0.06 / run.run->macroStep()));
  double largest = 0.0;
  for (std::int64_t w = 0; w < macroSteps; ++w) {
    run.run->advance();
    largest = std::max(largest, std::abs(run.run->ledger().residual()));
  }
  return largest / first;
}

TEST_P(TieRuns, EnergyErrorIsOfSecondOrder) {
  const double dt = 2e-4 / GetParam().K;
  const double coarse = residualOf(started(GetParam(), dt)), fine = residualOf(started(GetParam(), 0.5 * dt));
  EXPECT_LT(coarse, 2e-2);
  if (GetParam().kind == ConstraintKind::dashpot) {  // it acts as ε dt: half a step is another case
    EXPECT_LT(fine, 0.5 * coarse);
    return;
  }
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.4) << coarse << " " << fine;
}

TEST_P(TieRuns, MomentumAndMassStay) {
  TieRun run = started(GetParam(), 1e-4 / GetParam().K, false);
  const coupling::Totals before = run.run->totals();
  run.run->advance(300);
  const coupling::Totals after = run.run->totals();
  const double tolerance = GetParam().stepping == Stepping::implicitSteps ? 1e-9 : 1e-12;  // of Newton's iteration
  EXPECT_LT(norm(after.momentum - before.momentum), tolerance * norm(before.momentum));
  EXPECT_DOUBLE_EQ(after.mass, before.mass);
  const Vec3 ofParticles = dem::momentum(run.grains.particles);
  EXPECT_LT(norm(ofParticles + after.ontoSolids - before.momentum), 1e-12 * norm(before.momentum));
}

TEST_P(TieRuns, ClosesTheGapOrStoresWhatItTakes) {
  TieRun run = started(GetParam(), 1e-4 / GetParam().K);
  double gap = 0.0;
  for (int w = 0; w < 300; ++w) {
    run.run->advance();
    for (const Vec3& g : run.tie->gap()) gap = std::max(gap, norm(g));
  }
  const double first = run.run->ledger().storedAtOpening();
  switch (GetParam().kind) {
    case ConstraintKind::penalty:
      EXPECT_GT(gap, 1e-7);
      EXPECT_LT(std::abs(run.tie->lost()), 1e-9 * first);
      break;
    case ConstraintKind::multiplier:
      EXPECT_LT(gap, GetParam().stepping == Stepping::implicitSteps ? 1e-6 : 1e-13);
      EXPECT_LT(std::abs(run.tie->lost()),
                GetParam().stepping == Stepping::implicitSteps ? 1e-2 * first : 1e-9 * first);
      break;
    case ConstraintKind::dashpot:
      EXPECT_GT(run.tie->lost(), 1e-3 * first);
      break;
  }
}

TEST_P(TieRuns, StateGoesOnWithTheSameDigits) {
  TieRun whole = started(GetParam(), 1e-4), parted = started(GetParam(), 1e-4);
  whole.run->advance(30);
  const std::vector<char> state = whole.run->save();
  whole.run->advance(20);
  parted.run->advance(3);
  parted.run->load(state);
  EXPECT_EQ(parted.run->save(), state);
  parted.run->advance(20);
  EXPECT_EQ(parted.run->save(), whole.run->save());
}

TEST_P(TieRuns, ThreadsChangeNoDigit) {
  std::vector<std::vector<char>> states;
  for (const int threads : {1, 2, 3}) {
    setThreads(threads);
    TieRun run = started(GetParam(), 1e-4, true, 0.9);
    run.run->advance(20);
    states.push_back(run.run->save());
  }
  setThreads(1);
  EXPECT_EQ(states[0], states[1]);
  EXPECT_EQ(states[0], states[2]);
}

INSTANTIATE_TEST_SUITE_P(
    MacroSteps, TieRuns,
    testing::Values(Case{"penaltyExplicit1", ConstraintKind::penalty, Stepping::explicitSteps, 1},
                    Case{"penaltyExplicit4", ConstraintKind::penalty, Stepping::explicitSteps, 4},
                    Case{"penaltyImplicit1", ConstraintKind::penalty, Stepping::implicitSteps, 1},
                    Case{"penaltyImplicit3", ConstraintKind::penalty, Stepping::implicitSteps, 3},
                    Case{"penaltyImplicit4", ConstraintKind::penalty, Stepping::implicitSteps, 4},
                    Case{"multiplierExplicit1", ConstraintKind::multiplier, Stepping::explicitSteps, 1},
                    Case{"multiplierExplicit4", ConstraintKind::multiplier, Stepping::explicitSteps, 4},
                    Case{"multiplierImplicit1", ConstraintKind::multiplier, Stepping::implicitSteps, 1},
                    Case{"multiplierImplicit3", ConstraintKind::multiplier, Stepping::implicitSteps, 3},
                    Case{"multiplierImplicit4", ConstraintKind::multiplier, Stepping::implicitSteps, 4},
                    Case{"dashpotExplicit1", ConstraintKind::dashpot, Stepping::explicitSteps, 1},
                    Case{"dashpotExplicit4", ConstraintKind::dashpot, Stepping::explicitSteps, 4},
                    Case{"dashpotImplicit1", ConstraintKind::dashpot, Stepping::implicitSteps, 1},
                    Case{"dashpotImplicit3", ConstraintKind::dashpot, Stepping::implicitSteps, 3},
                    Case{"dashpotImplicit4", ConstraintKind::dashpot, Stepping::implicitSteps, 4}),
    [](const auto& c) { return c.param.name; });

TEST(TieRunsMore, AUniformVelocityGoesOnForEver) {
  for (const ConstraintKind kind : {ConstraintKind::penalty, ConstraintKind::multiplier, ConstraintKind::dashpot}) {
    SceneOptions o;
    o.across = 1;
    o.holdEnd = false;
    o.coupling.constraint = kind;
    if (kind == ConstraintKind::dashpot) o.coupling.penalty = 1e7;
    TieRun run = tieBar(o);
    const Vec3 v{0.3, -0.2, 0.1};
    for (Vec3& each : run.grains.particles.v) each = v;
    for (Vec3& each : run.solid->nodes.v) each = v;
    run.start(2e-4);
    run.run->advance(200);
    for (const Vec3& each : run.grains.particles.v) EXPECT_LT(norm(each - v), 1e-9);
    for (const Vec3& each : run.solid->nodes.v) EXPECT_LT(norm(each - v), 1e-9);
  }
}

/// A copy of the particles' model has a tie of its own, which meets the solid and gives it nothing.
TEST(TieRunsMore, ACopyOfTheParticlesLoadsNobody) {
  for (const ConstraintKind kind : {ConstraintKind::penalty, ConstraintKind::multiplier}) {
    TieRun run = started({"", kind, Stepping::explicitSteps, 1}, 1e-4),
           same = started({"", kind, Stepping::explicitSteps, 1}, 1e-4);
    run.run->advance(50);
    same.run->advance(50);
    dem::Model copy = run.grains;
    dem::run(copy, 1e-4, 20);
    EXPECT_NE(copy.particles.v, run.grains.particles.v);
    EXPECT_EQ(run.run->save(), same.run->save());
    run.run->advance(10);
    same.run->advance(10);
    EXPECT_EQ(run.run->save(), same.run->save());
  }
}

TEST(TieRunsMore, TheAbsorberTakesFluctuationsAndKeepsMomentum) {
  const auto tied = [](double rate) {
    SceneOptions o;
    o.across = 1;
    o.coupling.absorberRate = rate;
    TieRun run = tieBar(o);
    excite(run.grains.particles);
    run.start(1e-4);
    return run;
  };
  TieRun with = tied(100.0);
  const Vec3 momentum = with.momentum();
  const double first = with.energy();
  for (int s = 0; s < 600; ++s) with.step(1e-4);
  EXPECT_GT(with.tie->absorbed(), 1e-4 * first);
  EXPECT_NEAR(with.tie->absorbed(), with.tie->lost(), 1e-9 * first);
  EXPECT_LT(norm(with.momentum() - momentum), 1e-12 * norm(momentum));
  EXPECT_NEAR(with.energy(), first, 2.0 * residualOf(tied(0.0)) * first + 1e-4 * first);
}

/// What lags acts over the macro step after the one in which it grew; nothing else may lag.
TEST(TieRunsMore, OnlyDashpotsOnImplicitSolidsLag) {
  const auto tied = [](ConstraintKind kind, Stepping stepping, bool lags) {
    SceneOptions o;
    o.across = 1;
    o.coupling.constraint = kind;
    o.coupling.penalty = 1e7;
    o.coupling.dashpotLags = lags;
    return tieBar(o, fem::ElementShape::hex8, stepping);
  };
  EXPECT_THROW(tied(ConstraintKind::dashpot, Stepping::explicitSteps, true), InputError);
  EXPECT_THROW(tied(ConstraintKind::penalty, Stepping::implicitSteps, true), InputError);
  for (const bool lags : {false, true}) {
    TieRun run = tied(ConstraintKind::dashpot, Stepping::implicitSteps, lags);
    excite(run.grains.particles);
    run.start(1e-4);
    std::vector<Vec3> before;
    Vec3 increment, last;
    for (int s = 0; s < 100; ++s) {
      before.assign(run.tie->gap().begin(), run.tie->gap().end());
      run.run->advance();
      last = std::exchange(increment, run.tie->gap()[1] - before[1]);
    }
    const Vec3 expected = 1e7 * run.tie->operators().volume[1] * (lags ? 0.5 * (increment + last) : increment);
    EXPECT_LT(norm(run.tie->lambda()[1] - expected), 1e-6 * norm(expected));
  }
}

TEST(TieRunsMore, ATieThatIsTakenOutLeavesNothingBehind) {
  for (const Stepping stepping : {Stepping::explicitSteps, Stepping::implicitSteps})
    for (const int K : {1, 4})
      for (const bool startsAnew : {true, false}) {
        SceneOptions o;
        o.across = 1;
        o.holdEnd = false;
        o.coupling.constraint = ConstraintKind::multiplier;
        TieRun run = tieBar(o, fem::ElementShape::hex8, stepping);
        run.grains.gravity = {0.0, -9.81, 0.0};
        run.K = K;
        run.start(2e-4);
        run.run->advance(100 / K);
        run.grains.terms.remove(*run.tie);
        if (startsAnew) run.start(2e-4);
        run.run->advance();  // kicked once more by what acted at the end of the macro step before
        const auto momentum = [&] {
          Vec3 sum;
          for (std::size_t n = 0; n < run.solid->nodes.v.size(); ++n)
            sum += run.solid->nodes.mass[n] * run.solid->nodes.v[n];
          return sum;
        };
        const Vec3 before = momentum();
        run.run->advance(100 / K);
        EXPECT_LT(norm(momentum() - before), 1e-8 * norm(before)) << K << startsAnew;
      }
}

/// A speck alone in its elements: without a row it has no mean of its own to fluctuate about.
TEST(TieRunsMore, TheAbsorberIsBlindToAVelocityOfAll) {
  for (const double radius : {0.02, 0.06, 0.125}) {
    TieRun run;
    const double half = 0.25;
    run.grains.particles = lattice({-half, 0.0, -half}, {half, 1.0, half}, 2);
    dem::addParticle(run.grains.particles, {0.05, 2.25, 0.05}, {}, radius, dem::Density{1000});
    dem::ElasticLaw law;
    law.normal.stiffness = 1e5;
    run.grains.laws = dem::makeContactLaws(law);
    const fem::SolidMesh mesh = fem::boxOf(fem::ElementShape::hex8, {1, 6, 1}, {-half, 0.0, -half}, {half, 3.0, half});
    std::vector<double> place;
    for (const Vec3& X : mesh.X) place.push_back(X.y > 2.5 + 1e-9 ? beyondOverlap : X.y / 2.5);
    const std::vector<double> weight = nodalWeights(place, {});
    run.take(fem::makeModel(mesh));
    const fem::StVenantKirchhoff law3{modulus, 0.0, bulk};
    run.solid->add(fem::makeSolid(mesh, fem::pointMaterial(fem::Material(law3)), {.fraction = solidWeights(weight)}));
    const Vec3 velocity{1.0, 2.0, 3.0};
    run.solid->nodes.v.assign(mesh.X.size(), velocity);
    run.grains.particles.v.assign(run.grains.particles.size(), velocity);
    run.couple(mesh, weight, {.absorberRate = 50.0});
    run.start(1e-4);
    run.run->advance(1000);
    EXPECT_LT(norm(run.grains.particles.v.back() - velocity), 1e-9) << radius;
    EXPECT_LT(std::abs(run.tie->absorbed()), 1e-9) << radius;
  }
}

/// How far λ changes from one macro step to the next, over its size: the largest of 20.
double changeOfLambda(TieRun& run) {
  double largest = 0.0, size = 0.0;
  for (int w = 0; w < 20; ++w) {
    const std::vector<Vec3> before(run.tie->lambda().begin(), run.tie->lambda().end());
    run.run->advance();
    for (std::size_t r = 0; r < before.size(); ++r) {
      size = std::max(size, norm(before[r]));
      largest = std::max(largest, norm(run.tie->lambda()[r] - before[r]));
    }
  }
  return largest / size;
}

/// A bar that hangs from its held end: from the first macro step on, at rest, and when started with another step.
/// Between the ends of macro steps of several steps its particles fall and are kicked back, which dashpots see.
TEST(TieRunsMore, MultipliersOnImplicitSolidsStandStillAtRestAndNothingIsLost) {
  for (const int K : {1, 4}) {
    SceneOptions o;
    o.across = 1;
    o.coupling.constraint = ConstraintKind::multiplier;
    TieRun run = tieBar(o, fem::ElementShape::hex8, Stepping::implicitSteps);
    dem::ElasticLaw law;
    law.normal = {.stiffness = modulus * edge / o.particlesPerEdge, .restitution = 0.5, .bonded = true};
    run.grains.laws = dem::makeContactLaws(law);
    run.grains.gravity = {0.0, -1.0, 0.0};
    run.K = K;
    run.start(4e-4 / K);
    EXPECT_LT(changeOfLambda(run), 0.05);  // it begins to oscillation
    EXPECT_TRUE(relax(*run.run, {.tolerance = K == 1 ? 1e-16 : 1e-9, .steps = 2000}).atRest);
    EXPECT_LT(std::abs(run.run->ledger().residual()), 1e-5 * run.energy());
    double booked = run.run->ledger().booked();
    EXPECT_LT(changeOfLambda(run), K == 1 ? 1e-7 : 1e-3);
    EXPECT_LT(std::abs(run.run->ledger().booked() - booked), (K == 1 ? 1e-12 : 1e-7) * run.energy());
    booked = run.run->ledger().booked();
    run.start(2e-4 / K);
    EXPECT_LT(changeOfLambda(run), K == 1 ? 1e-7 : 1e-3);
    EXPECT_LT(std::abs(run.run->ledger().booked() - booked), (K == 1 ? 1e-12 : 1e-7) * run.energy());
  }
}

}  // namespace
}  // namespace dovetail::arlequin
