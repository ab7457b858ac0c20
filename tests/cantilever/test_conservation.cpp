#include <gtest/gtest.h>

#include <cmath>

#include "short_run.hpp"

namespace dovetail::cantilever {
namespace {

using test::joulesOf;
using test::shortSettings;

constexpr double roundOff = 1e-12;  // relative; sums of some thousand terms

TEST(Conservation, TheOneToOneCouplingOfBothElementsKeepsEnergyAndBalance) {
  for (const char* element : {"hex8", "hybrid8"}) {
    SCOPED_TRACE(element);
    Settings settings = shortSettings(1.0);
    settings.element = element;
    const RunFigures f = run(settings).figures;
    EXPECT_TRUE(f.finished && f.stable) << f.failure;
    EXPECT_FALSE(f.left);
    EXPECT_LE(f.energyDrift, 1e-4);
    EXPECT_LE(f.lateralDrift, 1e-9);
    EXPECT_EQ(f.noContactShare, 0.0);
    EXPECT_LE(f.forceResidual, roundOff);
    EXPECT_LE(f.momentResidual, roundOff);
    EXPECT_NEAR(f.energyInitial, 0.8716, 1e-4);  // 2 m (v²/2 + g overlap/2)
    EXPECT_NEAR(f.endTime, 1.0, f.dt);
    EXPECT_EQ(f.steps, std::llround(f.endTime / f.dt));
  }
}

TEST(Conservation, EveryWidthAndKernelKeepsEnergyAndForce) {
  for (KernelName kernel : {KernelName::lucy, KernelName::gauss})
    for (double width : {2.0, 10.0, 20.0}) {
      SCOPED_TRACE(testing::Message() << (kernel == KernelName::lucy ? "Lucy" : "Gauss") << ", c = " << width << " d");
      Settings settings = shortSettings(0.3);
      settings.kernel = kernel;
      settings.cgWidth = width;
      settings.correction = Correction::linear;
      const RunResult result = run(settings);
      const RunFigures& f = result.figures;
      EXPECT_TRUE(f.finished && f.stable) << f.failure;
      EXPECT_LE(f.energyDrift, 1e-3);
      EXPECT_LE(f.forceResidual, roundOff);
      EXPECT_LE(f.momentResidual, roundOff);
      // The dents of the two loads turn the surface a little below each, in mirrored ways.
      EXPECT_LE(f.lateralDrift, 1e-5);
      for (const PairSample& sample : result.samples) ASSERT_NEAR(sample.x[0].x, -sample.x[1].x, 1e-13) << sample.time;
      EXPECT_EQ(f.noContactShare, 0.0);
    }
}

TEST(Conservation, MomentsBalanceForEveryKernel) {
  for (const Correction correction : {Correction::none, Correction::linear, Correction::symmetric}) {
    Settings settings = shortSettings(0.3);
    settings.cgWidth = 10.0;
    settings.correction = correction;
    const RunFigures f = run(settings).figures;
    EXPECT_LE(f.momentResidual, roundOff) << nameOf(correction);
    EXPECT_LE(f.forceResidual, roundOff) << nameOf(correction);
    EXPECT_LE(f.energyDrift, 1e-3) << nameOf(correction);
  }
}

/// The symmetric kernel is the default; without correction the particles drift off sideways.
TEST(Conservation, TheSymmetricKernelKeepsTheParticlesInLine) {
  const auto figuresWith = [](double width, Correction correction) {
    Settings settings = shortSettings(1.0);
    settings.cgWidth = width;
    applyScheme(settings, Scheme::conservative);
    EXPECT_EQ(settings.correction, Correction::symmetric);
    settings.correction = correction;
    return run(settings).figures;
  };
  for (double width : {2.0, 4.0, 10.0, 20.0}) {
    SCOPED_TRACE(width);
    const RunFigures f = figuresWith(width, Correction::symmetric);
    EXPECT_TRUE(f.finished && f.stable) << f.failure;
    EXPECT_LE(f.energyDrift, 1e-3);
    EXPECT_LE(f.forceResidual, roundOff);
    EXPECT_LE(f.lateralDrift, 1e-8);
    EXPECT_LE(f.momentResidual, roundOff);
  }
  EXPECT_GE(figuresWith(10.0, Correction::none).lateralDrift, 2e-7);
}

TEST(Conservation, TheSmoothSurfaceKeepsEnergyAndForce) {
  for (double width : {0.0, 4.0}) {
    SCOPED_TRACE(width);
    Settings settings = shortSettings(1.0);
    settings.surface = Surface::smooth;
    settings.cgWidth = width;
    const RunFigures f = run(settings).figures;
    EXPECT_TRUE(f.finished && f.stable) << f.failure;
    EXPECT_LE(f.energyDrift, 1e-3);
    EXPECT_LE(f.forceResidual, roundOff);
    EXPECT_EQ(f.noContactShare, 0.0);
  }
}

TEST(Conservation, DriftIsOfSecondOrderInTheStep) {
  double drift[3];
  for (int i = 0; i < 3; ++i) {
    Settings settings = shortSettings(0.5);
    settings.dtFactor = 0.1 / std::pow(2.0, i);
    drift[i] = run(settings).figures.energyDrift;
  }
  EXPECT_NEAR(std::log2(drift[0] / drift[1]), 2.0, 0.3) << drift[0] << ' ' << drift[1];
  EXPECT_NEAR(std::log2(drift[1] / drift[2]), 2.0, 0.3) << drift[1] << ' ' << drift[2];
}

TEST(Conservation, SeveralParticleStepsPerBeamStepStayBounded) {
  for (int every : {4, 8}) {
    SCOPED_TRACE(every);
    Settings settings = shortSettings(1.0);
    settings.dtFactor = 0.02;
    settings.femEvery = every;
    const RunFigures f = run(settings).figures;
    EXPECT_TRUE(f.finished && f.stable) << f.failure;
    EXPECT_LE(f.energyDrift, 1e-3);
    EXPECT_LE(f.ledgerResidual, 0.75 * f.energyDrift);  // the greater part is known and booked
    EXPECT_LE(f.forceResidual, roundOff);
    EXPECT_EQ(f.steps % every, 0);
  }
}

TEST(Conservation, ImplicitBeamAtTheSameInstantKeepsEnergy) {
  Settings settings = shortSettings(0.5);
  settings.fem = FemStepper::newmark;
  const RunFigures f = run(settings).figures;
  EXPECT_TRUE(f.finished && f.stable) << f.failure;
  EXPECT_LE(f.energyDrift, 1e-4);
  EXPECT_LE(f.lateralDrift, 1e-9);
  EXPECT_LE(f.momentResidual, roundOff);
}

/// The law without a potential keeps the work done against it.
TEST(Conservation, TheDeformedMetricIsBookedAsTheReferenceIs) {
  for (const FemStepper fem : {FemStepper::explicitDifferences, FemStepper::newmark}) {
    Settings settings = shortSettings(0.5);
    settings.metric = Metric::deformed;
    settings.fem = fem;
    const RunResult result = run(settings);
    EXPECT_TRUE(result.figures.finished) << result.figures.failure;
    EXPECT_GT(joulesOf(result, "elastic, beam"), 1e-3 * result.figures.energyInitial);
    EXPECT_LE(result.figures.energyDrift, 1e-4);
  }
}

TEST(Conservation, WhatALagCreatesIsBooked) {
  const auto check = [](double until, Lag lag, FemStepper fem) {
    SCOPED_TRACE(testing::Message() << "lag " << static_cast<int>(lag) << ", fem " << static_cast<int>(fem));
    Settings settings = shortSettings(until);
    settings.lag = lag;
    settings.fem = fem;
    const RunResult result = run(settings);
    const double made = -joulesOf(result, "coupling");
    EXPECT_TRUE(result.figures.finished) << result.figures.failure;
    EXPECT_GT(made, 5e-4 * result.figures.energyInitial);
    EXPECT_LT(result.figures.ledgerResidual * result.figures.energyInitial, 0.05 * made);
  };
  check(1.0, Lag::load, FemStepper::explicitDifferences);
  check(1.0, Lag::loadAndSkin, FemStepper::explicitDifferences);
  check(0.6, Lag::load, FemStepper::newmark);
  check(0.6, Lag::loadAndSkin, FemStepper::newmark);
}

TEST(Conservation, WhatDashpotsLoseIsBooked) {
  Settings settings = shortSettings(1.0);
  settings.restitution = 0.9;
  const RunResult result = run(settings);
  const double lost = joulesOf(result, "dashpots");
  EXPECT_GT(lost, 1e-4 * result.figures.energyInitial);
  EXPECT_LT(result.figures.energyMin, result.figures.energyInitial);
  EXPECT_LT(result.figures.ledgerResidual * result.figures.energyInitial, 0.05 * lost);
}

TEST(Conservation, TheLastStepOfAnyDurationIsBookedAsAWhole) {
  for (double until : {0.3001, 0.3003, 0.3005, 0.3007, 0.3009}) {
    const RunFigures f = run(shortSettings(until)).figures;
    EXPECT_LE(f.energyDrift, 1e-4) << until;
    EXPECT_GE(f.endTime, until * (1.0 - 1e-12));
    EXPECT_LE(f.endTime, until + f.dt);
  }
}

}  // namespace
}  // namespace dovetail::cantilever
