// Total energy of particles, contacts and solid, bouncing on each other.
#include <gtest/gtest.h>

#include "coupled_block.hpp"

namespace dovetail::surface {
namespace {

constexpr double duration = 0.1;
constexpr std::array<double, 5> macroSizes{1.4e-3, 7e-4, 3.5e-4, 1.75e-4, 8.75e-5};  // s
constexpr double energyThereIs = 0.6386;                                             // J

/// Mean slope of log(error) over log(macro step): errors of single runs scatter with the instants at which contacts
/// begin.
template <class Error>
double fittedOrder(Error&& error) {
  double meanX = 0.0, meanY = 0.0, xx = 0.0, xy = 0.0;
  std::vector<std::array<double, 2>> points;
  for (double h : macroSizes) points.push_back({std::log(h), std::log(error(h))});
  for (const auto& [x, y] : points) {
    meanX += x / static_cast<double>(points.size());
    meanY += y / static_cast<double>(points.size());
  }
  for (const auto& [x, y] : points) {
    xx += (x - meanX) * (x - meanX);
    xy += (x - meanX) * (y - meanY);
  }
  return xy / xx;
}

/// Of the largest |E − E₀|.
void expectSecondOrder(const BlockSetup& setup, int K) {
  const auto drift = [&](double h) { return runFor(setup, duration, h, K).worstDrift; };
  const double order = fittedOrder(drift);
  EXPECT_GT(order, 1.8);
  EXPECT_LT(order, 2.2);
  EXPECT_LT(drift(1e-4), 2e-5 * energyThereIs);
}

class EnergyExplicit : public ::testing::TestWithParam<int> {};

TEST_P(EnergyExplicit, ErrorIsSecondOrder) {
  for (double width : {0.0, 0.15}) expectSecondOrder({.width = width}, GetParam());
}

TEST_P(EnergyExplicit, ErrorIsSecondOrderOnTheSmoothSurface) {
  for (double width : {0.0, 0.15}) expectSecondOrder({.width = width, .smooth = true}, GetParam());
}

INSTANTIATE_TEST_SUITE_P(K, EnergyExplicit, ::testing::Values(1, 4, 8));

class EnergyImplicit : public ::testing::TestWithParam<int> {};

TEST_P(EnergyImplicit, ErrorIsSecondOrder) { expectSecondOrder({.stepping = Stepping::implicitSteps}, GetParam()); }

INSTANTIATE_TEST_SUITE_P(K, EnergyImplicit, ::testing::Values(1, 2, 3, 4));

/// Contacts kick the nodes through the whole mass matrix; with lumped masses in its place energy would be made.
TEST(EnergyConsistentMass, ErrorIsSecondOrder) {
  for (const double fraction : {0.5, 1.0})
    expectSecondOrder({.stepping = Stepping::implicitSteps, .massFraction = fraction}, 1);
}

TEST(EnergyScene, HasBouncesAndASolidThatTakesPart) {
  const Result result = runFor({}, duration, 2e-4, 1);
  EXPECT_NEAR(result.initial, energyThereIs, 1e-3);
  EXPECT_GT(result.withoutContact, result.macroSteps / 10);
  EXPECT_LT(result.withoutContact, result.macroSteps / 2);
  EXPECT_GT(result.largestStrainEnergy, 0.05 * result.initial);
}

/// Many bounces later the energy is still where it was.
TEST(EnergyScene, StaysBoundedOverManyBounces) {
  const double shortRun = runFor({}, 0.2, 5e-4, 1).worstDrift;
  const double longRun = runFor({}, 4.0, 5e-4, 1).worstDrift;
  EXPECT_LT(longRun, 5.0 * shortRun);
  EXPECT_LT(longRun, 1e-3 * energyThereIs);
}

/// What a dashpot takes in a kick is booked in equal parts with the velocities before and after, as the evaluations at
/// its ends see them: while a contact lasts the ledger is half a step behind. Between evaluations implicit solids
/// jump.
TEST(EnergyLost, DashpotsCloseTheLedger) {
  for (const int K : {1, 3})
    for (const Stepping stepping : {Stepping::explicitSteps, Stepping::implicitSteps}) {
      const auto books = [&](double h) { return runFor({.stepping = stepping, .restitution = 0.7}, duration, h, K); };
      const bool jumps = stepping == Stepping::implicitSteps;
      EXPECT_GT(fittedOrder([&](double h) { return books(h).residualApart; }), jumps ? 0.8 : 1.9) << K;
      EXPECT_GT(fittedOrder([&](double h) { return books(h).worstResidual; }), 0.9) << K;
      const Result fine = books(1e-4);
      EXPECT_GT(fine.dissipated, 0.05 * fine.initial);
      EXPECT_LT(fine.residualApart, (jumps ? 1e-3 : 1e-4) * fine.dissipated) << K;
      EXPECT_LT(fine.worstResidual, 5e-3 * fine.dissipated) << K;
    }
}

TEST(EnergyLost, WithoutDashpotsNothingIsBooked) {
  const Result result = runFor({.booksWork = true}, duration, 4e-4, 1);
  EXPECT_EQ(result.dissipated, 0.0);
  EXPECT_LT(std::abs(result.made), 1e-13 * result.initial);
}

/// What is booked as time splitting explains what the energy of macro steps of many steps lacks.
TEST(EnergyExplicitSplitting, IsTheLeadingTermOfWhatTheWindowStores) {
  const Result result = runFor({}, 0.096, 8e-4, 32);
  EXPECT_LT(result.worstResidual, 0.1 * result.worstDrift)
      << result.worstDrift << " J of drift, " << result.worstResidual << " J unexplained";
}

}  // namespace
}  // namespace dovetail::surface
