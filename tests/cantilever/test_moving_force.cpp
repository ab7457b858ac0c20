#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dovetail/core/error.hpp"
#include "reference/moving_force.hpp"

namespace dovetail::cantilever {
namespace {

constexpr double pi = std::numbers::pi;
constexpr Section unitSection{.bending = 1.0, .shear = 1.0, .mass = 1.0, .rotaryMass = 0.0};

BeamModes simplySupported(int count) {
  return computeModes(unitSection, 1.0,
                      {.supports = Supports::simplySupported, .shear = false, .rotaryInertia = false, .basis = 60},
                      count);
}

// Largest deflection of the middle over the static one, P L³ / 48 EI; α is the speed over (π/L) √(EI/ρA).
double peakFactor(const BeamModes& modes, double alpha, double dt) {
  const BeamHistory history = simulateMovingForce(modes, {.force = 1.0, .speed = alpha * pi, .dt = dt}, 0.5);
  return -48.0 * *std::min_element(history.deflection.begin(), history.deflection.end());
}

TEST(MovingForce, PeakOfTheMiddleHasTheKnownFactors) {
  const BeamModes modes = simplySupported(31);
  const double dt = 4e-5;
  EXPECT_NEAR(peakFactor(modes, 0.25, dt), 1.2576, 5e-5);
  EXPECT_NEAR(peakFactor(modes, 0.5, dt), 1.7054, 5e-5);
  EXPECT_NEAR(peakFactor(modes, 0.9, dt), 1.6127, 5e-5);
}

TEST(MovingForce, FollowsTheSeriesSolutionAtSecondOrder) {
  const BeamModes modes = simplySupported(7);
  const double alpha = 0.3;
  const auto largestError = [&](double dt) {
    const BeamHistory history = simulateMovingForce(modes, {.force = 1.0, .speed = alpha * pi, .dt = dt}, 0.4);
    double largest = 0.0;
    for (std::size_t i = 0; i < history.time.size(); ++i) {
      double series = 0.0;
      for (int j = 1; j <= 7; ++j) {
        const double omega = j * j * pi * pi, forced = std::sin(j * alpha * pi * pi * history.time[i]);
        series += std::sin(j * pi * 0.4) / (std::pow(j, 4) * (1.0 - alpha * alpha / (j * j))) *
                  (forced - alpha / j * std::sin(omega * history.time[i]));
      }
      largest = std::max(largest, std::abs(history.deflection[i] + 2.0 / std::pow(pi, 4) * series));
    }
    return largest;
  };
  const double coarse = largestError(4e-4), fine = largestError(2e-4);
  EXPECT_LT(fine, 1e-4 / 48.0);
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.1);
}

TEST(MovingForce, UnstableStepIsRefused) {
  const BeamModes modes = simplySupported(5);
  EXPECT_THROW(simulateMovingForce(modes, {.force = 1.0, .speed = 1.0, .dt = 2.01 / modes.omega.back()}, 0.5),
               InputError);
  EXPECT_THROW(simulateMovingForce(modes, {.force = 1.0, .speed = 0.0, .dt = 1e-4}, 0.5), InputError);
}

}  // namespace
}  // namespace dovetail::cantilever
