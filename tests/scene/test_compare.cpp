// What is compared, and what is found.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <sstream>

#include "../io/scratch_folder.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/io/time_series.hpp"
#include "dovetail/scene/compare.hpp"

namespace dovetail::scene::test {
namespace {

using io::test::ScratchFolder;

/// Columns that are linear in time, so that interpolation is exact.
io::TimeSeries lines(const std::vector<double>& times, double factor = 1.0) {
  io::TimeSeries table({"time_s", "kinetic_J", "residual_J", "ball_x_m", "ball_y_m"});
  for (const double t : times) table.append({t, 100.0 * t, 1e-9 * factor * t, 3.0 * t, 1e-3 * t});
  return table;
}

const Difference& of(const Comparison& comparison, const std::string& what) {
  for (const Difference& one : comparison.differences)
    if (one.what == what) return one;
  throw std::runtime_error("no " + what);
}

Comparison compared(const io::TimeSeries& a, const io::TimeSeries& b) {
  const ScratchFolder folder;
  io::writeCsv(folder / "a.csv", a, {});
  io::writeCsv(folder / "b.csv", b, {});
  return compare(folder / "a.csv", folder / "b.csv");
}

TEST(Compare, FindsWhereSeriesDiffer) {
  const Comparison same = compared(lines({0, 1, 2}), lines({0, 1, 2}));
  EXPECT_TRUE(same.within(0.0));
  EXPECT_EQ(same.differences.size(), 5U);
  // Energies have one scale: noise beside 200 J is none. Vectors too.
  const Comparison noise = compared(lines({0, 1, 2}), lines({0, 1, 2}, 3.0));
  EXPECT_TRUE(noise.within(1e-10));
  EXPECT_FALSE(noise.within(1e-12));
  EXPECT_NEAR(of(noise, "a residual_J").largest, 4e-9, 1e-20);
  EXPECT_EQ(of(noise, "a residual_J").where, "t = 2 s");
  EXPECT_EQ(of(noise, "a residual_J").scale, 200.0);
  EXPECT_EQ(of(noise, "a ball_y_m").scale, 6.0);
}

TEST(Compare, InterpolatesSeriesOfOtherTimes) {
  const Comparison found = compared(lines({0, 0.4, 1.1, 2}), lines({0, 0.5, 1, 1.5, 1.9}));
  ASSERT_EQ(found.unlike.size(), 1U);
  EXPECT_NE(found.unlike[0].find("leaves out 1"), std::string::npos) << found.unlike[0];
  EXPECT_FALSE(found.within(1.0));
  for (const Difference& one : found.differences) EXPECT_LT(one.relative(), 1e-15) << one.what;
}

TEST(Compare, RowsOfOneTimeMeetInTheirOrder) {
  io::TimeSeries steps({"time_s", "tip_m"});
  for (const double tip : {0.0, 0.1, 0.2}) steps.append({0.0, tip});
  steps.append({1.0, 0.3});
  EXPECT_TRUE(compared(steps, steps).within(0.0));
  io::TimeSeries other({"time_s", "tip_m"});
  for (const double tip : {0.0, 0.1, 0.25}) other.append({0.0, tip});
  other.append({1.0, 0.3});
  EXPECT_NEAR(of(compared(steps, other), "a tip_m").largest, 0.05, 1e-15);
}

TEST(Compare, ANumberAndNoneAreFarApart) {
  io::TimeSeries gone({"time_s", "ball_x_m"}), there = gone;
  gone.append({0.0, std::nan("")});
  there.append({0.0, 1.0});
  EXPECT_FALSE(compared(gone, there).within(1e9));
  EXPECT_TRUE(compared(gone, gone).within(0.0));
}

TEST(Compare, SaysWhatOnlyOneHas) {
  const ScratchFolder a, b;
  io::writeCsv(a / "series.csv", lines({0, 1}), {});
  EXPECT_EQ(compare(a.path(), b.path()).unlike, std::vector<std::string>{"series.csv is in the first only."});
  EXPECT_THROW(compare(b.path(), b.path()), InputError);
  EXPECT_THROW(compare(a / "series.csv", b.path()), InputError);
  EXPECT_THROW(compare(a / "none.csv", a / "series.csv"), InputError);
  io::TimeSeries more({"time_s", "kinetic_J", "extra"});
  more.append({0, 0, 0});
  const Comparison found = compared(lines({0}), more);
  EXPECT_EQ(found.unlike.size(), 4U);
  EXPECT_EQ(found.differences.size(), 2U);
  std::ostringstream text;
  print(found, 1e-9, 5, text);
  EXPECT_NE(text.str().find("extra in the second only"), std::string::npos) << text.str();
  EXPECT_NE(text.str().find("NOT the same"), std::string::npos);
}

}  // namespace
}  // namespace dovetail::scene::test
