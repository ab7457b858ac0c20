#include <gtest/gtest.h>

#include <cmath>

#include "short_bar.hpp"

namespace dovetail::wave {
namespace {

using test::figuresOf;
using test::shortBar;

TEST(Conservation, PenaltyAndMultipliersLoseNothingForAnyWidth) {
  for (const char* constraint : {"penalty", "multiplier"})
    for (const char* width : {"0", "1.5"}) {
      SCOPED_TRACE(std::string(constraint) + ", width " + width);
      const RunFigures f = test::runAndCompare(shortBar({"--constraint", constraint, "--cg-width", width})).figures;
      EXPECT_TRUE(f.stable);
      EXPECT_LT(std::abs(f.lostFraction), 5e-5);
      EXPECT_LT(f.ledgerResidual, 5e-5);
      // Round-off of multipliers: up to 4e-12, of either sign, for pulses of 5.9 to 6.3 elements.
      EXPECT_LT(std::abs(f.couplingWorkFraction), 1e-11);
      EXPECT_LT(f.momentumResidual, 1e-12);
      EXPECT_LT(f.massResidual, 1e-4);
      EXPECT_TRUE(f.compared);
      EXPECT_LT(f.waveformErrorFem, 0.03);
      EXPECT_LT(f.reflectedFraction, 1e-4);
    }
}

TEST(Conservation, TheResidualFallsWithTheSquareOfTheStep) {
  Settings settings = shortBar({"--constraint", "multiplier"});
  const double coarse = run(settings).figures.ledgerResidual;
  settings.dtFactor *= 0.5;
  EXPECT_NEAR(coarse / run(settings).figures.ledgerResidual, 4.0, 0.4);
}

TEST(Conservation, WhatADashpotLosesIsBooked) {
  const RunFigures f = figuresOf({"--constraint", "dashpot", "--weight-floor", "0.1"});
  EXPECT_LT(f.couplingWorkFraction, -0.01);
  EXPECT_NEAR(f.lostFraction, -f.couplingWorkFraction, 1e-4);
  EXPECT_LT(f.ledgerResidual, 1e-4);
  EXPECT_LT(f.momentumResidual, 1e-12);
}

TEST(Conservation, WhatTheAbsorberTakesIsBookedApart) {
  // An impulse has waves that the mesh cannot carry.
  const RunFigures without = figuresOf({"--particles-per-edge", "2", "--signal", "impulse"}),
                   with = figuresOf({"--particles-per-edge", "2", "--signal", "impulse", "--absorber", "1"});
  EXPECT_EQ(without.absorbedFraction, 0.0);
  EXPECT_GT(with.absorbedFraction, 0.01);
  EXPECT_LT(with.absorbedFraction, 1.0);
  EXPECT_LT(std::abs(with.lostFraction), 2e-3);
  EXPECT_LT(with.momentumResidual, 1e-12);
}

TEST(Conservation, TheEnergyOfAWeakPulseGrowsWithTheSquareOfItsAmplitude) {
  const double one = figuresOf({"--amplitude", "0.01"}).energyInput;
  EXPECT_NEAR(figuresOf({"--amplitude", "0.02"}).energyInput / one, 4.0, 1e-3);
}

TEST(Conservation, ParticlesAloneHaveNoSolidAndKeepTheirEnergy) {
  const RunResult result = run(shortBar({"--full-dem"}));
  EXPECT_EQ(result.figures.elements, 0u);
  EXPECT_TRUE(result.nodePosition.empty());
  EXPECT_TRUE(std::isinf(result.figures.critical.solid));
  EXPECT_LT(std::abs(result.figures.lostFraction), 5e-5);
}

TEST(Conservation, ThreadsDoNotChangeTheLastBit) {
  const RunResult one = run(shortBar({"--cg-width", "1"})), two = run(shortBar({"--cg-width", "1", "--threads", "2"}));
  EXPECT_EQ(one.figures.energyFinal, two.figures.energyFinal);
  ASSERT_EQ(one.nodeVelocity.size(), two.nodeVelocity.size());
  for (std::size_t n = 0; n < one.nodeVelocity.size(); ++n)
    EXPECT_EQ(one.nodeVelocity[n].y, two.nodeVelocity[n].y) << "node " << n;
}

TEST(Conservation, AStepAboveTheCriticalOneIsRefusedAndWouldBreakDown) {
  const std::string message = test::refusal({"--dt-fraction", "1.05"});
  EXPECT_NE(message.find("--dt auto"), std::string::npos) << message;
  const RunFigures f = figuresOf({"--dt-fraction", "2", "--insist"});
  EXPECT_FALSE(f.finished);
  EXPECT_FALSE(f.stable);
  EXPECT_NE(f.failure.find("t = "), std::string::npos) << f.failure;
}

}  // namespace
}  // namespace dovetail::wave
