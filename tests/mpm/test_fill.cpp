// Points that fill regions.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include "dovetail/core/error.hpp"
#include "dovetail/mpm/fill.hpp"

namespace dovetail::mpm {
namespace {

double volumeOf(const MaterialPoints& points) {
  return std::accumulate(points.volume.begin(), points.volume.end(), 0.0);
}

TEST(Fill, BoxesHaveEqualPartsAndAllOfTheVolume) {
  for (const bool plane : {true, false}) {
    const GridOptions grid{.spacing = 0.1, .plane = plane};
    const MaterialPoints points = fillBox(grid, {{0.1, -0.2, 0.3}, {0.4, 0.0, 0.4}}, 2, {1, 2, 3});
    ASSERT_EQ(points.x.size(), plane ? 24U : 48U);
    EXPECT_LE(norm(points.x.front() - Vec3{0.125, -0.175, plane ? 0.0 : 0.325}), 1e-15);
    EXPECT_NEAR(volumeOf(points), 0.3 * 0.2 * 0.1, 1e-15);
    for (const Vec3& v : points.v) EXPECT_EQ(v, (Vec3{1, 2, 3}));
    std::map<std::array<int, 3>, int> cells;
    for (const Vec3& x : points.x)
      ++cells[{static_cast<int>(std::floor(x.x / 0.1)), static_cast<int>(std::floor(x.y / 0.1)),
               static_cast<int>(std::floor(x.z / 0.1))}];
    for (const auto& [cell, count] : cells) EXPECT_EQ(count, plane ? 4 : 8);
  }
  const MaterialPoints odd = fillBox({.spacing = 0.1, .plane = false}, {{0, 0, 0}, {0.33, 0.04, 0.1}}, 2);
  EXPECT_EQ(odd.x.size(), 7U * 1U * 2U);
  EXPECT_NEAR(volumeOf(odd), 0.33 * 0.04 * 0.1, 1e-15);
}

/// First moments of a ball come out as its symmetry asks, second ones with the distance of points.
TEST(Fill, InsidesHaveTheirVolumeAndComeToTheirMoments) {
  const Vec3 centre{0.25, 0.5, -0.25};
  const double R = 0.5;
  std::vector<double> errors;
  for (const double h : {0.125, 0.0625}) {
    const GridOptions grid{.spacing = h, .plane = false};
    const double volume = 4.0 / 3.0 * std::numbers::pi * R * R * R;
    const MaterialPoints points = fillInside(
        grid, {centre - Vec3{R, R, R}, centre + Vec3{R, R, R}}, 2, [&](const Vec3& x) { return norm(x - centre) < R; },
        volume);
    EXPECT_NEAR(volumeOf(points), volume, 1e-12);
    Vec3 first;
    double second = 0.0;
    for (std::size_t p = 0; p < points.x.size(); ++p) {
      first += points.volume[p] * (points.x[p] - centre);
      second += points.volume[p] * squaredNorm(points.x[p] - centre);
    }
    EXPECT_LT(norm(first), 1e-12);
    errors.push_back(std::abs(second / (0.6 * volume * R * R) - 1.0));
    EXPECT_LT(errors.back(), 0.05);
  }
  EXPECT_LT(errors[1], errors[0]);
}

TEST(Fill, RefusesNothingToFill) {
  const GridOptions grid{.spacing = 0.1, .plane = false};
  EXPECT_THROW(fillBox(grid, {{0, 0, 0}, {1, 1, 0}}, 2), InputError);
  EXPECT_THROW(fillBox(grid, {{0, 0, 0}, {1, 1, 1}}, 0), InputError);
  EXPECT_THROW(fillBox({.spacing = 0.0}, {{0, 0, 0}, {1, 1, 1}}, 2), InputError);
  const auto nowhere = [](const Vec3&) { return false; };
  EXPECT_THROW(fillInside(grid, {{0, 0, 0}, {1, 1, 1}}, 2, nowhere, 1.0), InputError);
  EXPECT_THROW(fillInside(
                   grid, {{0, 0, 0}, {1, 1, 1}}, 2, [](const Vec3&) { return true; }, 0.0),
               InputError);
}

}  // namespace
}  // namespace dovetail::mpm
