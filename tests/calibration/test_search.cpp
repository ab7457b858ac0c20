// The least measure and how flat it is.
#include <gtest/gtest.h>

#include <cmath>

#include "dovetail/calibration/search.hpp"
#include "dovetail/core/error.hpp"

namespace dovetail::calibration {
namespace {

const std::vector<FitParameter> two{{"x", 0.9, 0.0, 1.0}, {"y", 3.0, 0.0, 4.0}};

TEST(Search, FindsTheBottomOfABowlAndItsWidth) {
  const Optimum found = searchOptimum(
      two, [](std::span<const double> p) { return 1.0 + std::pow(p[0] - 0.3, 2) + std::pow(p[1] - 1.0, 2); },
      {.samples = 21, .refinements = 2});
  EXPECT_NEAR(found.value[0], 0.3, 1e-3);
  EXPECT_NEAR(found.value[1], 1.0, 1e-2);
  const MeasureCurve& x = found.profiles[0];
  EXPECT_NEAR(x.lower, 0.3 - std::sqrt(0.05), 2e-3);
  EXPECT_NEAR(x.upper, 0.3 + std::sqrt(0.05), 2e-3);
  EXPECT_NEAR(x.curvature, 2.0 * 0.3 * 0.3, 1e-3);
  EXPECT_FALSE(x.lowerOpen || x.upperOpen);
}

TEST(Search, TakesStepsAndTellsThatABoundIsOpen) {
  const std::vector<FitParameter> one{{"length", 1.0, 0.0, 10.0}};
  const Optimum found = searchOptimum(one,
                                      [](std::span<const double> p) -> std::optional<double> {
                                        if (p[0] > 9.5) return {};  // refused
                                        return 5.0 - std::floor(0.5 * p[0]);
                                      },
                                      {.samples = 11, .refinements = 1});
  EXPECT_GE(found.value[0], 8.0);
  EXPECT_DOUBLE_EQ(found.measure, 1.0);
  const Optimum flat = searchOptimum(one, [](std::span<const double>) { return 2.0; });
  EXPECT_TRUE(flat.profiles[0].lowerOpen && flat.profiles[0].upperOpen);
  EXPECT_EQ(flat.profiles[0].curvature, 0.0);
}

TEST(Search, RefusesWhatCannotBeSearched) {
  EXPECT_THROW(searchOptimum(two, [](auto) { return 1.0; }, {.samples = 2}), InputError);
  EXPECT_THROW(searchOptimum({}, [](auto) { return 1.0; }), InputError);
  EXPECT_THROW(searchOptimum(two, [](auto) { return std::optional<double>(); }), NumericalError);
}

}  // namespace
}  // namespace dovetail::calibration
