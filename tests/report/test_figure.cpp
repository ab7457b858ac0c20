#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "dovetail/report/figure.hpp"

namespace dovetail::report {
namespace {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t number = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++number;
  return number;
}

TEST(RoundTicks, AreRoundAndLieInTheRange) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-1.0, 1.0), decade(-12.0, 12.0);
  for (int k = 0; k < 1000; ++k) {
    const double size = std::pow(10.0, decade(random));
    const double low = size * place(random), high = low + size * std::pow(10.0, 0.3 * decade(random));
    const std::vector<double> ticks = roundTicks(low, high, 6);
    ASSERT_GE(ticks.size(), 2u) << low << " … " << high;
    ASSERT_LE(ticks.size(), 6u);
    const double step = ticks[1] - ticks[0], power = std::pow(10.0, std::floor(std::log10(step) + 1e-9));
    const double factor = step / power;
    const bool round = std::abs(factor - 1.0) < 1e-3 || std::abs(factor - 2.0) < 1e-3 || std::abs(factor - 5.0) < 1e-3;
    EXPECT_TRUE(round) << step << " of " << low << " … " << high;
    for (const double tick : ticks) EXPECT_NEAR(tick / step, std::round(tick / step), 1e-3);
  }
  EXPECT_EQ(roundTicks(0.0, 1.0, 6), (std::vector<double>{0.0, 0.2, 0.4, 0.6000000000000001, 0.8, 1.0}));
}

TEST(Svg, MarksOfManyCurvesDiffer) {
  Figure figure{"f", "", {"x"}, {"y"}, {}, {}};
  for (int k = 0; k < 12; ++k) figure.curves.push_back({"c" + std::to_string(k), {0, 1}, {0.0, k + 1.0}, false, true});
  const std::string svg = svgOf(figure);
  for (const char* const mark : {"\"mc3\"", "\"ring c3\"", "\"mc7\""}) EXPECT_EQ(count(svg, mark), 3u) << mark;
  EXPECT_EQ(count(svg, "\"ring c7\""), 0u);
}

TEST(Svg, LinesOfManyCurvesDiffer) {
  Figure figure{"f", "", {"x"}, {"y"}, {}, {}};
  for (int k = 0; k < 10; ++k) figure.curves.push_back({"c" + std::to_string(k), {0, 1}, {0.0, k + 1.0}});
  const std::string svg = svgOf(figure);
  for (const char* const line : {"\"c1\"", "\"c7\"", "\"dashed c1\""}) EXPECT_EQ(count(svg, line), 2u) << line;
}

TEST(Svg, HasAxesLegendAndOneLinePerCurve) {
  const Figure figure{"f",
                      "A <title>",
                      {"time (s)"},
                      {"energy (J)"},
                      {{"one & two", {0, 1, 2}, {0, 1e-6, 4e-6}}, {"three", {0, 1, 2}, {1e-6, 1e-6, 1e-6}, true, true}},
                      {}};
  const std::string svg = svgOf(figure);
  EXPECT_EQ(count(svg, "<path class=\"c0\""), 2u);  // the curve and its mark in the legend
  EXPECT_EQ(count(svg, "<circle class=\"mc1\""), 4u);
  for (const char* part : {"A &lt;title&gt;", "one &amp; two", "time (s)", "energy (J) × 10⁻⁶"})
    EXPECT_NE(svg.find(part), std::string::npos) << part << " in\n" << svg;
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("<style>"), std::string::npos);
  EXPECT_NE(svgFileOf(figure).find("prefers-color-scheme"), std::string::npos);
}

TEST(Svg, RangesReachBeyondTheirPointsAndWidenTheAxis) {
  Figure figure{"f", "", {"x"}, {"y", true}, {{"a", {1, 2}, {10, 10}, true, true}}, {}};
  EXPECT_EQ(svgOf(figure).find("10³"), std::string::npos);
  figure.curves.front().ranges = {{{5, 900}}, {{0, 20}}};  // the second from below the axis
  figure.curves.push_back({"limit", {1, 2}, {10, 10}, true, false, true});
  const std::string svg = svgOf(figure);
  EXPECT_NE(svg.find("10³"), std::string::npos);
  EXPECT_EQ(count(svg, "<path class=\"c0\""), 4u);  // two ranges, the curve and its mark in the legend
  EXPECT_NE(svg.find("M422.0 220.0V"), std::string::npos);
  EXPECT_EQ(count(svg, "\"dashed c1\""), 2u);  // the line and its mark in the legend
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(Svg, LeavesOutWhatCannotBeDrawn) {
  const double nan = std::nan(""), infinite = std::numeric_limits<double>::infinity();
  const std::vector<Figure> figures{
      {"f", "", {"x"}, {"y"}, {}, {}},
      {"f", "", {"x"}, {"y"}, {{"none", {}, {}}}, {}},
      {"f", "", {"x"}, {"y"}, {{"flat", {0, 1}, {0, 0}}}, {}},
      {"f", "", {"x"}, {"y"}, {{"far", {1e300, 1e301}, {-1e-300, 1e-300}}}, {}},
      {"f", "", {"x"}, {"y"}, {{"broken", {0, 1, 2, 3}, {1, nan, infinite, 2}}}, {}},
      {"f", "", {"x", true}, {"y", true}, {{"logs", {0, 1, -2, 1e-9}, {1, 0, 3, 1e9}, false, true}}, {}}};
  for (const Figure& figure : figures) {
    const std::string svg = svgOf(figure);
    for (const char* part : {"nan", "inf"}) EXPECT_EQ(svg.find(part), std::string::npos) << svg;
  }
  const std::string broken = svgOf(figures[4]), head = "<path class=\"c0\" d=\"";
  EXPECT_EQ(count(broken.substr(broken.find(head), broken.find('>', broken.find(head)) - broken.find(head)), "M"), 2u);
  EXPECT_NE(svgOf(figures[5]).find("10⁻⁹"), std::string::npos);
}

TEST(Svg, TicksOfNarrowRangesDiffer) {
  const std::string svg = svgOf({"f", "", {"x"}, {"y (m)"}, {{"c", {0, 1}, {4.00000001, 4.00000003}}}, {}});
  EXPECT_NE(svg.find("y (m) − 4.00000001 × 10⁻⁹"), std::string::npos) << svg;
  EXPECT_NE(svg.find(">20</text>"), std::string::npos) << svg;
}

TEST(Svg, LongCurvesKeepTheirExtremes) {
  Curve curve{"long", {}, {}};
  for (int k = 0; k < 100000; ++k) {
    curve.x.push_back(k);
    curve.y.push_back(k == 54321 ? 100.0 : std::sin(0.01 * k));
  }
  const std::string svg = svgOf({"f", "", {"x"}, {"y"}, {curve}, {}});
  EXPECT_LT(svg.size(), 40000u);
  EXPECT_NE(svg.find(" 10.0"), std::string::npos) << "the peak is at the top, y = 10";
}

TEST(Svg, BarsAreAsLongAsTheirShare) {
  const std::string svg = svgOf({"f", "Time", {}, {"s"}, {}, {{"search", 2.0}, {"sweep", 1.0}}});
  EXPECT_NE(svg.find("width=\"412.0\""), std::string::npos) << svg;
  EXPECT_NE(svg.find("width=\"206.0\""), std::string::npos) << svg;
  EXPECT_NE(svg.find("2 s"), std::string::npos);
}

}  // namespace
}  // namespace dovetail::report
