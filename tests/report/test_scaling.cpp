#include <gtest/gtest.h>

#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/report/scaling.hpp"

namespace dovetail::report {
namespace {

CostCurve power(const std::string& name, double factor, double exponent, const std::vector<double>& sizes) {
  CostCurve curve{name, sizes, {}};
  for (const double size : sizes) curve.seconds.push_back(factor * std::pow(size, exponent));
  return curve;
}
const std::vector<double> sizes{2, 4, 8};

TEST(Scaling, GrowthIsThatBetweenPoints) {
  const Growth cubic = growthOf(power("a", 3.0, 2.5, sizes));
  EXPECT_NEAR(cubic.exponent, 2.5, 1e-12);
  EXPECT_NEAR(cubic.least, 2.5, 1e-12);
  EXPECT_NEAR(cubic.most, 2.5, 1e-12);
  const Growth bent = growthOf({"b", {1, 2, 4}, {1, 2, 16}});
  EXPECT_NEAR(bent.exponent, 3.0, 1e-12);
  EXPECT_NEAR(bent.least, 1.0, 1e-12);
  EXPECT_NEAR(bent.most, 3.0, 1e-12);
}

TEST(Scaling, PowersMeetWhereTheyMust) {
  const CostCurve dear = power("grains", 1.0, 3.0, sizes), cheap = power("cells", 20.0, 1.0, sizes);
  const auto at = breakEven(dear, cheap);
  ASSERT_TRUE(at);
  EXPECT_NEAR(at->size, std::sqrt(20.0), 1e-9);
  EXPECT_FALSE(at->range);  // within what was run
  const auto beyond = breakEven(dear, power("cells", 1000.0, 1.0, sizes));
  ASSERT_TRUE(beyond && beyond->range);
  EXPECT_NEAR(beyond->size, std::sqrt(1000.0), 1e-9);
  EXPECT_NEAR((*beyond->range)[0], beyond->size, 1e-9);
  EXPECT_NEAR((*beyond->range)[1], beyond->size, 1e-9);
}

TEST(Scaling, WhatIsCheaperFromTheStartOrNeverHasNoBreakEven) {
  const CostCurve dear = power("a", 2.0, 2.0, sizes), cheap = power("b", 1.0, 2.0, sizes);
  EXPECT_FALSE(breakEven(dear, cheap));
  EXPECT_FALSE(breakEven(cheap, dear));
  EXPECT_FALSE(breakEven(power("c", 1.0, 1.0, sizes), dear));
}

TEST(Scaling, TheRangeFollowsTheGrowthBetweenPoints) {
  const CostCurve dear{"a", {1, 2, 4}, {1, 4, 32}}, cheap{"b", {1, 2, 4}, {50, 50, 100}};  // 2 then 3; 0 then 1
  const auto at = breakEven(dear, cheap);
  ASSERT_TRUE(at && at->range);
  EXPECT_NEAR(at->size, 4.0 * std::sqrt(100.0 / 32.0), 1e-9);
  EXPECT_NEAR((*at->range)[0], 4.0 * std::cbrt(100.0 / 32.0), 1e-9);  // 3 against 0
  EXPECT_NEAR((*at->range)[1], 4.0 * 100.0 / 32.0, 1e-9);             // 2 against 1
  const Table table = breakEvens({dear, cheap}, "size");
  ASSERT_EQ(table.rows.size(), 1u);
  EXPECT_EQ(table.rows[0], (std::vector<std::string>{"b", "a", "7.07", "5.85 to 12.5"}));
}

TEST(Scaling, CurvesOfOtherSizesMeetWhereBothAre) {
  const CostCurve dear = power("a", 1.0, 3.0, {1, 2, 4, 8, 16}), cheap = power("b", 64.0, 1.0, {4, 16});
  const auto at = breakEven(dear, cheap);
  ASSERT_TRUE(at);
  EXPECT_NEAR(at->size, 8.0, 1e-9);
  EXPECT_FALSE(at->range);
  // The dear one was not run at the larger sizes: it has a range there.
  const auto beyond = breakEven(power("a", 1.0, 3.0, {1, 2}), power("b", 64.0, 1.0, {1, 2, 4, 8, 16}));
  ASSERT_TRUE(beyond && beyond->range);
  EXPECT_NEAR(beyond->size, 8.0, 1e-9);
}

TEST(Scaling, WhatHasNoGrowthIsRefused) {
  EXPECT_THROW(growthOf({"a", {1}, {1}}), InputError);
  EXPECT_THROW(growthOf({"a", {2, 1}, {1, 2}}), InputError);
  EXPECT_THROW(growthOf({"a", {1, 2}, {0, 2}}), InputError);
  EXPECT_THROW(growthOf({"a", {1, 2}, {1, std::nan("")}}), InputError);
}

TEST(Scaling, FiguresGoOnBeyondWhatWasRun) {
  const Figure figure = scalingFigure({power("a", 1.0, 3.0, sizes), {"b", {4}, {7}}}, "s", "size", "run time");
  ASSERT_EQ(figure.curves.size(), 3u);
  EXPECT_EQ(figure.curves[2].like, 0u);
  EXPECT_TRUE(figure.curves[2].dashed);
  EXPECT_NEAR(figure.curves[2].x[1], 32.0, 1e-12);
  EXPECT_NEAR(figure.curves[2].y[1], 32768.0, 1e-6);
  const std::string svg = svgOf(figure);
  EXPECT_NE(svg.find("class=\"dashed c0\""), std::string::npos);
  EXPECT_EQ(svg.find("class=\"dashed c2\""), std::string::npos);
}

}  // namespace
}  // namespace dovetail::report
