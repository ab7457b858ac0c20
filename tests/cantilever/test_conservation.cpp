#include <gtest/gtest.h>

#include <cmath>

#include "short_run.hpp"

namespace dovetail::cantilever {
namespace {

using test::joulesOf;
using test::runUntil;
using test::Words;

constexpr double roundOff = 1e-12;  // relative; sums of some thousand terms

/// Finished, with forces and moments that balance. @param drift  of the energy, at most
void expectBalanced(const RunFigures& f, double drift) {
  EXPECT_TRUE(f.finished && f.stable) << f.failure;
  EXPECT_LE(f.energyDrift, drift);
  EXPECT_LE(f.forceResidual, roundOff);
  EXPECT_LE(f.momentResidual, roundOff);
}

TEST(Conservation, TheOneToOneCouplingOfBothElementsKeepsEnergyAndBalance) {
  for (const char* element : {"hex8", "hybrid8"}) {
    SCOPED_TRACE(element);
    const RunFigures f = runUntil(1.0, {"--element", element}).figures;
    expectBalanced(f, 1e-4);
    EXPECT_FALSE(f.left);
    EXPECT_LE(f.lateralDrift, 1e-9);
    EXPECT_EQ(f.noContactFraction, 0.0);
    EXPECT_NEAR(f.energyInitial, 0.8716, 1e-4);  // 2 m (v²/2 + g overlap/2)
    EXPECT_NEAR(f.endTime, 1.0, f.dt);
    EXPECT_EQ(f.steps, std::llround(f.endTime / f.dt));
  }
}

TEST(Conservation, EveryWidthAndKernelKeepsEnergyAndForce) {
  for (const char* kernel : {"lucy", "gauss"})
    for (const char* width : {"2", "10", "20"}) {
      SCOPED_TRACE(testing::Message() << kernel << ", c = " << width << " d");
      const RunResult result = runUntil(
          0.3, {"--kernel", kernel, "--cg-width", width, "--kernel-correction", "linear", "--surface", "flat"});
      expectBalanced(result.figures, 1e-3);
      // The dents of the two loads turn the surface a little below each, in mirrored ways.
      EXPECT_LE(result.figures.lateralDrift, 1e-5);
      for (const PairSample& sample : result.samples) ASSERT_NEAR(sample.x[0].x, -sample.x[1].x, 1e-13) << sample.time;
      EXPECT_EQ(result.figures.noContactFraction, 0.0);
    }
}

/// The symmetric kernel is the default; without correction the particles drift off sideways.
TEST(Conservation, TheSymmetricKernelKeepsTheParticlesInLine) {
  for (const char* width : {"2", "4", "10", "20"}) {
    SCOPED_TRACE(width);
    EXPECT_EQ(test::settingsOf({"--cg-width", width}).correction, "symmetric");
    const RunFigures f = runUntil(1.0, {"--cg-width", width}).figures;
    expectBalanced(f, 1e-3);
    EXPECT_LE(f.lateralDrift, 1e-8);
  }
  const RunFigures without = runUntil(1.0, {"--cg-width", "10", "--kernel-correction", "none"}).figures;
  expectBalanced(without, 1e-3);
  EXPECT_GE(without.lateralDrift, 2e-7);
}

TEST(Conservation, TheSmoothSurfaceKeepsEnergyAndForce) {
  for (const char* width : {"0", "4"}) {
    SCOPED_TRACE(width);
    const RunFigures f = runUntil(1.0, {"--surface", "smooth", "--cg-width", width}).figures;
    expectBalanced(f, 1e-3);
    EXPECT_EQ(f.noContactFraction, 0.0);
  }
}

TEST(Conservation, DriftIsOfSecondOrderInTheStep) {
  double drift[3];
  for (int i = 0; i < 3; ++i)
    drift[i] = runUntil(0.5, {"--dt-factor", std::to_string(0.1 / std::pow(2.0, i))}).figures.energyDrift;
  EXPECT_NEAR(std::log2(drift[0] / drift[1]), 2.0, 0.3) << drift[0] << ' ' << drift[1];
  EXPECT_NEAR(std::log2(drift[1] / drift[2]), 2.0, 0.3) << drift[1] << ' ' << drift[2];
}

TEST(Conservation, SeveralParticleStepsPerBeamStepStayBounded) {
  for (int every : {4, 8}) {
    SCOPED_TRACE(every);
    const RunFigures f = runUntil(1.0, {"--dt-factor", "0.02", "--fem-every", std::to_string(every)}).figures;
    expectBalanced(f, 1e-3);
    EXPECT_LE(f.ledgerResidual, 0.75 * f.energyDrift);  // the greater part is known and booked
    EXPECT_EQ(f.steps % every, 0);
  }
}

TEST(Conservation, ImplicitBeamAtTheSameInstantKeepsEnergy) {
  const RunFigures f = runUntil(0.5, {"--fem", "newmark"}).figures;
  expectBalanced(f, 1e-4);
  EXPECT_LE(f.lateralDrift, 1e-9);
}

/// The law without a potential keeps the work done against it.
TEST(Conservation, TheDeformedMetricIsBookedAsTheReferenceIs) {
  for (const char* fem : {"explicit", "newmark"}) {
    const RunResult result = runUntil(0.5, {"--metric", "deformed", "--fem", fem});
    EXPECT_TRUE(result.figures.finished) << result.figures.failure;
    EXPECT_GT(joulesOf(result, "elastic, beam"), 1e-3 * result.figures.energyInitial);
    EXPECT_LE(result.figures.energyDrift, 1e-4);
  }
}

TEST(Conservation, WhatALagCreatesIsBooked) {
  for (const char* fem : {"explicit", "newmark"})
    for (const char* lag : {"load", "load-and-skin"}) {
      SCOPED_TRACE(testing::Message() << lag << ", " << fem);
      const RunResult result = runUntil(fem[0] == 'e' ? 1.0 : 0.6, {"--lag", lag, "--fem", fem});
      const double made = -joulesOf(result, "coupling");
      EXPECT_TRUE(result.figures.finished) << result.figures.failure;
      EXPECT_GT(made, 5e-4 * result.figures.energyInitial);
      EXPECT_LT(result.figures.ledgerResidual * result.figures.energyInitial, 0.05 * made);
    }
}

TEST(Conservation, WhatDashpotsLoseIsBooked) {
  const RunResult result = runUntil(1.0, {"--restitution", "0.9"});
  const double lost = joulesOf(result, "dashpots");
  EXPECT_GT(lost, 1e-4 * result.figures.energyInitial);
  EXPECT_LT(result.figures.energyMin, result.figures.energyInitial);
  EXPECT_LT(result.figures.ledgerResidual * result.figures.energyInitial, 0.05 * lost);
}

TEST(Conservation, TheLastStepOfAnyDurationIsBookedAsAWhole) {
  for (double until : {0.3001, 0.3003, 0.3005, 0.3007, 0.3009}) {
    const RunFigures f = runUntil(until).figures;
    EXPECT_LE(f.energyDrift, 1e-4) << until;
    EXPECT_GE(f.endTime, until * (1.0 - 1e-12));
    EXPECT_LE(f.endTime, until + f.dt);
  }
}

}  // namespace
}  // namespace dovetail::cantilever
