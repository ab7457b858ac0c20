#include <gtest/gtest.h>

#include <cmath>

#include "short_bar.hpp"

namespace dovetail::wave {
namespace {

using test::refusal;
using test::runAndCompare;
using test::shortBar;

TEST(Conservation, PenaltyAndMultipliersLoseNothingForAnyWidth) {
  for (const Constraint constraint : {Constraint::penalty, Constraint::multiplier})
    for (const double width : {0.0, 1.5}) {
      SCOPED_TRACE("constraint " + std::to_string(static_cast<int>(constraint)) + ", width " + std::to_string(width));
      Settings settings = shortBar();
      settings.constraint = constraint;
      settings.cgWidth = width;
      const RunFigures f = runAndCompare(settings).figures;
      EXPECT_TRUE(f.stable);
      EXPECT_LT(std::abs(f.lostShare), 5e-5);
      EXPECT_LT(f.ledgerResidual, 5e-5);
      EXPECT_LT(std::abs(f.couplingWorkShare), 1e-12);
      EXPECT_LT(f.momentumResidual, 1e-12);
      EXPECT_LT(f.massResidual, 1e-4);
      EXPECT_TRUE(f.compared);
      EXPECT_LT(f.waveformErrorFem, 0.03);
      EXPECT_LT(f.reflectedShare, 1e-4);
    }
}

TEST(Conservation, TheResidualFallsWithTheSquareOfTheStep) {
  Settings settings = shortBar();
  settings.constraint = Constraint::multiplier;
  const double coarse = run(settings).figures.ledgerResidual;
  settings.dtFactor *= 0.5;
  EXPECT_NEAR(coarse / run(settings).figures.ledgerResidual, 4.0, 0.4);
}

TEST(Conservation, WhatADashpotLosesIsBooked) {
  Settings settings = shortBar();
  settings.constraint = Constraint::dashpot;
  settings.weightFloor = 0.1;
  const RunFigures f = run(settings).figures;
  EXPECT_LT(f.couplingWorkShare, -0.01);
  EXPECT_NEAR(f.lostShare, -f.couplingWorkShare, 1e-4);
  EXPECT_LT(f.ledgerResidual, 1e-4);
  EXPECT_LT(f.momentumResidual, 1e-12);
}

TEST(Conservation, WhatTheAbsorberTakesIsBookedApart) {
  Settings settings = shortBar();
  settings.particlesPerEdge = 2;
  settings.signal = Signal::impulse;  // with waves that the mesh cannot carry
  const RunFigures without = run(settings).figures;
  settings.absorber = 1.0;
  const RunFigures with = run(settings).figures;
  EXPECT_EQ(without.absorbedShare, 0.0);
  EXPECT_GT(with.absorbedShare, 0.01);
  EXPECT_LT(with.absorbedShare, 1.0);
  EXPECT_LT(std::abs(with.lostShare), 2e-3);
  EXPECT_LT(with.momentumResidual, 1e-12);
}

TEST(Conservation, TheEnergyOfAWeakPulseGrowsWithTheSquareOfItsAmplitude) {
  Settings settings = shortBar();
  settings.amplitude = 0.01;
  const double one = run(settings).figures.energyInput;
  settings.amplitude = 0.02;
  EXPECT_NEAR(run(settings).figures.energyInput / one, 4.0, 1e-3);
}

TEST(Conservation, ParticlesAloneHaveNoSolidAndKeepTheirEnergy) {
  Settings settings = shortBar();
  settings.fullDem = true;
  const RunResult result = run(settings);
  EXPECT_EQ(result.figures.elements, 0u);
  EXPECT_TRUE(result.nodePosition.empty());
  EXPECT_TRUE(std::isinf(result.figures.critical.solid));
  EXPECT_LT(std::abs(result.figures.lostShare), 5e-5);
}

TEST(Conservation, ThreadsDoNotChangeTheLastBit) {
  Settings settings = shortBar();
  settings.cgWidth = 1.0;
  const RunResult one = run(settings);
  settings.threads = 2;
  const RunResult two = run(settings);
  EXPECT_EQ(one.figures.energyFinal, two.figures.energyFinal);
  ASSERT_EQ(one.nodeVelocity.size(), two.nodeVelocity.size());
  for (std::size_t n = 0; n < one.nodeVelocity.size(); ++n)
    EXPECT_EQ(one.nodeVelocity[n].y, two.nodeVelocity[n].y) << "node " << n;
}

TEST(Conservation, AStepAboveTheCriticalOneIsRefusedAndWouldBreakDown) {
  Settings settings = shortBar();
  settings.shareOfCritical = 1.05;
  EXPECT_NE(refusal(settings).find("--dt auto"), std::string::npos) << refusal(settings);
  settings.shareOfCritical = 2.0;
  settings.beyondCritical = true;
  const RunFigures f = run(settings).figures;
  EXPECT_FALSE(f.finished);
  EXPECT_FALSE(f.stable);
  EXPECT_NE(f.failure.find("t = "), std::string::npos) << f.failure;
}

}  // namespace
}  // namespace dovetail::wave
