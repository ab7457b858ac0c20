// Total energy of particles, contacts and solid, bouncing on each other.
#include <gtest/gtest.h>

#include "coupled_block.hpp"

namespace dovetail::surface {
namespace {

constexpr double duration = 0.1;
constexpr std::array<double, 5> windowSizes{1.6e-3, 8e-4, 4e-4, 2e-4, 1e-4};  // s

/// Mean slope of log(error) over log(window): errors of single runs scatter with the instants at which contacts begin.
template <class Error>
double fittedOrder(Error&& error) {
  double meanX = 0.0, meanY = 0.0, xx = 0.0, xy = 0.0;
  std::vector<std::array<double, 2>> points;
  for (double h : windowSizes) points.push_back({std::log(h), std::log(error(h))});
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

/// @param drift  largest |E − E₀| of a run with this window, J
template <class Drift>
void expectSecondOrder(Drift&& drift) {
  const double order = fittedOrder(drift);
  EXPECT_GT(order, 1.8);
  EXPECT_LT(order, 2.2);
  EXPECT_LT(drift(1e-4), 2e-5 * 0.6386) << "of the energy there is";
}

class EnergyExplicit : public ::testing::TestWithParam<int> {};

TEST_P(EnergyExplicit, ErrorIsSecondOrder) {
  const int K = GetParam();
  for (double width : {0.0, 0.15})
    expectSecondOrder(
        [&](double h) { return runExplicit(flatModel({.width = width}), duration, h / K, K).worstDrift; });
}

TEST_P(EnergyExplicit, ErrorIsSecondOrderOnTheSmoothSurface) {
  const int K = GetParam();
  for (double width : {0.0, 0.15})
    expectSecondOrder(
        [&](double h) { return runExplicit(smoothModel({.width = width}), duration, h / K, K).worstDrift; });
}

INSTANTIATE_TEST_SUITE_P(K, EnergyExplicit, ::testing::Values(1, 4, 8));

class EnergyImplicit : public ::testing::TestWithParam<int> {};

TEST_P(EnergyImplicit, ErrorIsSecondOrder) {
  const int K = GetParam();
  expectSecondOrder([&](double h) { return runImplicit(flatModel({}), duration, h / K, K).worstDrift; });
}

INSTANTIATE_TEST_SUITE_P(K, EnergyImplicit, ::testing::Values(1, 2, 3, 4));

/// Contacts kick the nodes through the whole mass matrix; with lumped masses in its place energy would be made.
TEST(EnergyConsistentMass, ErrorIsSecondOrder) {
  for (const double share : {0.5, 1.0}) {
    const auto drift = [&](double h) {
      CoupledModel model = flatModel({});
      fem::ImplicitMotion solid(*model.solid,
                                {.scheme = fem::newmark(), .massShare = share, .relativeTolerance = 1e-10});
      const auto energy = [&] {
        return storedEnergy(model) - fem::kineticEnergy(model.solid->nodes) + solid.kineticEnergy();
      };
      Profile profile;
      start(model, h, profile);
      const double initial = energy();
      double worst = 0.0;
      for (long w = 0; w < std::lround(duration / h); ++w) {
        stepImplicit(model, solid, h, 1, {}, true, profile);
        worst = std::max(worst, std::abs(energy() - initial));
      }
      return worst;
    };
    expectSecondOrder(drift);
  }
}

TEST(EnergyScene, HasBouncesAndASolidThatTakesPart) {
  const Result result = runExplicit(flatModel({}), duration, 2e-4, 1);
  EXPECT_GT(result.withoutContact, result.steps / 10);
  EXPECT_LT(result.withoutContact, result.steps / 2);
  EXPECT_GT(result.largestStrainEnergy, 0.05 * result.initial);
}

/// Many bounces later the energy is still where it was.
TEST(EnergyScene, StaysBoundedOverManyBounces) {
  const double shortRun = runExplicit(flatModel({}), 0.2, 5e-4, 1).worstDrift;
  const double longRun = runExplicit(flatModel({}), 4.0, 5e-4, 1).worstDrift;
  EXPECT_LT(longRun, 5.0 * shortRun);
  EXPECT_LT(longRun, 1e-3 * 0.6386);
}

/// Dashpots act with the velocities of half a step ago: what is booked is right to first order in the DEM step.
TEST(EnergyLost, DashpotsCloseTheLedgerToFirstOrder) {
  for (int K : {1, 3}) {
    const auto books = [&](double h, bool implicitSolid) {
      const BlockSetup setup{.restitution = 0.7};
      return implicitSolid ? runImplicit(flatModel(setup), duration, h / K, K)
                           : runExplicit(flatModel(setup), duration, h / K, K);
    };
    for (bool implicitSolid : {false, true}) {
      const double order = fittedOrder([&](double h) { return books(h, implicitSolid).worstResidual; });
      EXPECT_GT(order, 0.9);
      EXPECT_LT(order, 1.3);
      const Result fine = books(1e-4, implicitSolid);
      EXPECT_GT(fine.dissipated, 0.05 * fine.initial);
      EXPECT_LT(fine.worstResidual, 5e-3 * fine.dissipated);
    }
  }
}

TEST(EnergyLost, WithoutDashpotsNothingIsBooked) {
  const Result result = runExplicit(flatModel({}), duration, 4e-4, 1);
  EXPECT_EQ(result.dissipated, 0.0);
  EXPECT_EQ(result.made, 0.0);
}

/// v·V″v of the solid, by central differences of its internal forces.
double stiffnessAlongVelocity(const CoupledModel& model) {
  const double s = 1e-6;
  fem::Nodes& nodes = model.solid->nodes;
  const fem::Nodes kept = nodes;
  double sum = 0.0;
  for (double sign : {1.0, -1.0}) {
    for (std::size_t i = 0; i < nodes.u.size(); ++i) nodes.u[i] = kept.u[i] + sign * s * kept.v[i];
    fem::evaluateForces(*model.solid, {});
    for (std::size_t i = 0; i < nodes.u.size(); ++i) sum -= sign * dot(nodes.f[i], nodes.v[i]) / (2.0 * s);
  }
  nodes = kept;
  return sum;
}

/// With its velocity term added, splittingEnergy explains what the energy of the multiple-time-step scheme lacks.
TEST(EnergyExplicitSplitting, IsTheLeadingTermOfWhatTheWindowStores) {
  const double h = 8e-4;
  const int K = 32;
  CoupledModel model = flatModel({});
  Profile profile;
  start(model, h / K, profile);
  const auto shadow = [&] {
    return storedEnergy(model) + splittingEnergy(model.solid->nodes, model.seam.load(), h) +
           h * h / 12.0 * stiffnessAlongVelocity(model);
  };
  const double initial = storedEnergy(model), initialShadow = shadow();
  double drift = 0.0, shadowDrift = 0.0;
  for (int w = 0; w < 120; ++w) {
    stepExplicit(model, h / K, K, {}, true, profile);
    drift = std::max(drift, std::abs(storedEnergy(model) - initial));
    shadowDrift = std::max(shadowDrift, std::abs(shadow() - initialShadow));
  }
  EXPECT_LT(shadowDrift, 0.1 * drift) << drift << " J of drift, " << shadowDrift << " J unexplained";
}

}  // namespace
}  // namespace dovetail::surface
