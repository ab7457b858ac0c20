// Volume of the part of a sphere that lies in a box.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "dovetail/cg/averages.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/quadrature.hpp"

namespace dovetail::cg {

namespace {

/// Area of the part of the disc of radius r about the origin with coordinates below x and y.
double quadrantArea(double r, double x, double y) {
  if (x <= -r || y <= -r) return 0.0;
  x = std::min(x, r);
  y = std::min(y, r);
  // ∫ √(r² − t²) dt from −r to t, half the area left of t
  const auto left = [&](double t) {
    return 0.5 * (t * std::sqrt(std::max(0.0, (r - t) * (r + t))) +
                  r * r * (std::asin(std::clamp(t / r, -1.0, 1.0)) + 0.5 * std::numbers::pi));
  };
  const double half = std::sqrt((r - y) * (r + y));  // the chord at y runs from −half to half
  if (y >= 0.0) {
    // Below y: the whole column outside the chord, the lower half and y above it.
    if (x <= -half) return 2.0 * left(x);
    if (x <= half) return 2.0 * left(-half) + (left(x) - left(-half)) + y * (x + half);
    return 2.0 * left(-half) + (left(half) - left(-half)) + y * 2.0 * half + 2.0 * (left(x) - left(half));
  }
  // Only columns within the chord reach below y.
  if (x <= -half) return 0.0;
  const double end = std::min(x, half);
  return left(end) - left(-half) + y * (end + half);
}

double rectangleArea(double r, const std::array<double, 4>& side) {
  return std::max(0.0, quadrantArea(r, side[1], side[3]) - quadrantArea(r, side[0], side[3]) -
                           quadrantArea(r, side[1], side[2]) + quadrantArea(r, side[0], side[2]));
}

/// Heights within [low, high] at which the disc of a slice begins or ceases to meet a side or a corner of the
/// rectangle.
std::vector<double> events(double radius, const std::array<double, 4>& side, double low, double high) {
  std::vector<double> heights{low, high};
  const auto add = [&](double squaredDistance) {
    const double h2 = radius * radius - squaredDistance;
    if (!(h2 > 0.0)) return;
    for (const double h : {-std::sqrt(h2), std::sqrt(h2)})
      if (h > low && h < high) heights.push_back(h);
  };
  for (const double s : side) add(s * s);
  for (const int i : {0, 1})
    for (const int j : {2, 3}) add(side[i] * side[i] + side[j] * side[j]);
  std::sort(heights.begin(), heights.end());
  return heights;
}

}  // namespace

double sphereInBox(const Vec3& centre, double radius, const AverageBox& box) {
  requirePositive(radius, "radius");
  const Vec3 lower = box.lower - centre, upper = box.upper - centre;
  bool whole = true;
  for (int k = 0; k < 3; ++k) {
    if (!(std::isfinite(lower[k]) && std::isfinite(upper[k]) && lower[k] < upper[k]))
      throw InputError("the box is empty or not finite along axis " + std::to_string(k), "sphere in a box",
                       "give lower < upper");
    if (lower[k] >= radius || upper[k] <= -radius) return 0.0;
    whole = whole && lower[k] <= -radius && upper[k] >= radius;
  }
  if (whole) return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
  static const auto rule = gaussLegendre(32);
  const std::array<double, 4> side{lower.x, upper.x, lower.y, upper.y};
  const std::vector<double> heights = events(radius, side, std::max(lower.z, -radius), std::min(upper.z, radius));
  double volume = 0.0;
  integrateBetween(heights, rule, [&](double z, double weight) {
    const double r2 = (radius - z) * (radius + z);
    if (r2 > 0.0) volume += weight * rectangleArea(std::sqrt(r2), side);
  });
  return volume;
}

}  // namespace dovetail::cg
