// Coupled runs keep energy at the order of their scheme, and momenta; and go on from a state as if they had not
// stopped.
#include <gtest/gtest.h>

#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "spring_scene.hpp"

namespace dovetail::coupling {
namespace {

struct Case {
  const char* name;
  Stepping stepping;
  double massFraction;
  int K;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class Runs : public testing::TestWithParam<Case> {
protected:
  static std::unique_ptr<CoupledRun> started(const Case& c, double dt, bool held = false) {
    auto run = springRun({c.stepping, c.massFraction, held});
    run->start(dt, {.stepsPerMacroStep = c.K});
    return run;
  }
};

/// Largest residual over 0.06 s of motion, over the energy at the start.
double residualOf(CoupledRun& run) {
  const double start = run.ledger().stored();
  const auto macroSteps = static_cast<std::int64_t>(std::llround(0.06 / run.macroStep()));
  double largest = 0.0;
  for (std::int64_t w = 0; w < macroSteps; ++w) {
    run.advance();
    largest = std::max(largest, std::abs(run.ledger().residual()));
  }
  return largest / start;
}

TEST_P(Runs, EnergyErrorIsOfSecondOrder) {
  const double dt = 0.06 / 480 / GetParam().K;
  const double coarse = residualOf(*started(GetParam(), dt)), fine = residualOf(*started(GetParam(), 0.5 * dt));
  EXPECT_LT(coarse, 2e-2);
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.3) << coarse << " " << fine;
}

TEST_P(Runs, MomentaAndMassStay) {
  const auto run = started(GetParam(), 1e-4 / GetParam().K);
  const Totals before = run->totals();
  run->advance(200);
  const Totals after = run->totals();
  const double size = norm(before.momentum);
  EXPECT_LT(norm(after.momentum - before.momentum), 1e-12 * size);
  const double turning = GetParam().stepping == Stepping::implicitSteps ? 1e-3 : 1e-12;  // Newmark keeps no moments
  EXPECT_LT(norm(after.angularMomentum - before.angularMomentum), turning * size);
  EXPECT_DOUBLE_EQ(after.mass, before.mass);
}

TEST_P(Runs, StateGoesOnWithTheSameDigits) {
  const auto whole = started(GetParam(), 1e-4, true), parted = started(GetParam(), 1e-4, true);
  whole->advance(30);
  const std::vector<char> state = whole->save();
  whole->advance(20);
  parted->advance(3);
  parted->load(state);
  EXPECT_EQ(parted->save(), state);
  parted->advance(20);
  EXPECT_EQ(parted->save(), whole->save());
  for (const auto& [a, b] : {std::pair{&whole->ledger(), &parted->ledger()}})
    for (std::size_t k = 0; k < a->channels().size(); ++k)
      EXPECT_EQ(a->channels()[k].joules, b->channels()[k].joules) << a->channels()[k].name;
}

TEST_P(Runs, ThreadsChangeNoDigit) {
  std::vector<std::vector<char>> states;
  for (const int threads : {1, 2, 3}) {
    setThreads(threads);
    const auto run = started(GetParam(), 1e-4, true);
    run->advance(20);
    states.push_back(run->save());
  }
  setThreads(1);
  EXPECT_EQ(states[0], states[1]);
  EXPECT_EQ(states[0], states[2]);
}

INSTANTIATE_TEST_SUITE_P(MacroSteps, Runs,
                         testing::Values(Case{"explicit1", Stepping::explicitSteps, 0.0, 1},
                                         Case{"explicit1consistent", Stepping::explicitSteps, 1.0, 1},
                                         Case{"explicit4", Stepping::explicitSteps, 0.0, 4},
                                         Case{"explicit4blended", Stepping::explicitSteps, 0.5, 4},
                                         Case{"implicit1", Stepping::implicitSteps, 0.0, 1},
                                         Case{"implicit3consistent", Stepping::implicitSteps, 1.0, 3},
                                         Case{"implicit4", Stepping::implicitSteps, 0.0, 4}),
                         [](const auto& c) { return c.param.name; });

TEST(CoupledRuns, RefusesAStepThatSolidAndSpringsTogetherCannotBear) {
  const auto run = springRun({});
  run->start(1e-4);
  const StepLimit limit = run->criticalStep();
  EXPECT_GT(limit.dt, 1e-4);
  const auto other = springRun({});
  EXPECT_THROW(other->start(1.01 * limit.dt), InputError);
  const auto bearable = springRun({});
  bearable->start(0.9 * limit.dt);
  bearable->advance(2000);
  EXPECT_LT(std::abs(bearable->ledger().residual()), 0.5 * bearable->ledger().storedAtOpening());
}

TEST(CoupledRuns, WhatALagMakesIsBooked) {
  for (const Stepping stepping : {Stepping::implicitSteps, Stepping::explicitSteps})
    for (const Lag lag : {Lag::load, Lag::loadAndSkin}) {
      const auto run = springRun({.stepping = stepping});
      run->start(stepping == Stepping::implicitSteps ? 2e-4 : 1e-4, {.lag = lag});
      run->advance(500);
      const double made = -run->ledger().joules("staggering error (minus what it made)");
      EXPECT_GT(std::abs(made), 1e-2 * run->ledger().storedAtOpening());
      EXPECT_LT(std::abs(run->ledger().residual()), 1e-3 * std::abs(made)) << made;
    }
}

TEST(CoupledRuns, SaysWhatIsMissing) {
  CoupledRun run;
  EXPECT_THROW(run.advance(), InputError);
  EXPECT_THROW(run.save(), InputError);
  EXPECT_THROW(run.ledger(), InputError);
  EXPECT_THROW(run.totals(), InputError);
  EXPECT_THROW(run.criticalStep(), InputError);
  EXPECT_THROW(run.start(0.0), InputError);
  EXPECT_THROW(run.start(1e-3, {.stepsPerMacroStep = 0}), InputError);
  EXPECT_THROW(run.addSolid(nullptr), InputError);
  EXPECT_THROW(run.addSolid(std::make_unique<fem::Model>(), {.name = ""}), InputError);
  run.start(1e-3);
  EXPECT_THROW(run.advance(-1), InputError);
}

}  // namespace
}  // namespace dovetail::coupling
