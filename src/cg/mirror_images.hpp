// Mirror images of a point in the sides of a rectangle: a kernel summed over them does not lose what passes the sides.
#pragma once

#include <array>
#include <cmath>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "dovetail/core/vec3.hpp"

namespace dovetail::cg {

/// A patch that is a flat rectangle.
struct Rectangle {
  Vec3 corner;
  std::array<Vec3, 2> direction;   ///< unit, at right angles
  std::array<double, 2> length{};  ///< m
};

namespace detail {

/// An edge that only one of the facets has; zero if there is none.
inline Vec3 rimEdge(std::span<const Vec3> X, std::span<const std::array<int, 3>> facets, std::span<const int> patch) {
  std::map<std::pair<int, int>, int> uses;
  for (int f : patch)
    for (int k = 0; k < 3; ++k) ++uses[std::minmax(facets[f][k], facets[f][(k + 1) % 3])];
  for (const auto& [edge, count] : uses)
    if (count == 1) return X[edge.second] - X[edge.first];
  return {};
}

}  // namespace detail

/// Whether the given facets fill a flat rectangle, up to 1e-9 of its size.
/// @return its lengths are zero if not
inline Rectangle asRectangle(std::span<const Vec3> X, std::span<const std::array<int, 3>> facets,
                             std::span<const int> patch) {
  const Vec3 edge = detail::rimEdge(X, facets, patch);
  Vec3 normal;
  double area = 0.0;
  for (int f : patch) {
    const Vec3 twice = cross(X[facets[f][1]] - X[facets[f][0]], X[facets[f][2]] - X[facets[f][0]]);
    normal += twice;
    area += 0.5 * norm(twice);
  }
  if (!(norm(edge) > 0.0) || !(norm(normal) > 0.0)) return {};
  const Vec3 first = normalized(edge), n = normalized(normal);
  const std::array<Vec3, 3> axes{first, cross(n, first), n};
  const Vec3 origin = X[facets[patch[0]][0]];
  std::array<double, 3> lower{}, upper{};
  for (int f : patch)
    for (int v : facets[f])
      for (int k = 0; k < 3; ++k) {
        const double s = dot(axes[k], X[v] - origin);
        lower[k] = std::fmin(lower[k], s);
        upper[k] = std::fmax(upper[k], s);
      }
  const double a = upper[0] - lower[0], b = upper[1] - lower[1];
  constexpr double tolerance = 1e-9;
  if (upper[2] - lower[2] > tolerance * (a + b) || std::abs(a * b - area) > tolerance * area) return {};
  return {origin + lower[0] * axes[0] + lower[1] * axes[1], {axes[0], axes[1]}, {a, b}};
}

/// Offsets from a point of the rectangle to itself and its images up to the given width outside, m; two coincide for a
/// point on a side. Across a side shorter than 1/64 of the width the kernel is even, so no images are taken there.
inline std::vector<Vec3> mirrorImages(const Rectangle& rectangle, const Vec3& point, double width) {
  std::array<std::vector<double>, 2> steps;
  for (int k = 0; k < 2; ++k) {
    const double length = rectangle.length[k], s = dot(rectangle.direction[k], point - rectangle.corner);
    const double periods = std::ceil(0.5 * width / length);
    if (!(periods <= 32.0)) {
      steps[k].push_back(0.0);
      continue;
    }
    for (int period = -static_cast<int>(periods); period <= static_cast<int>(periods) + 1; ++period)
      for (const double image : {2.0 * period * length + s, 2.0 * period * length - s})  // twice where they coincide
        if (image > -width && image < length + width) steps[k].push_back(image - s);
  }
  std::vector<Vec3> offsets;
  for (double first : steps[0])
    for (double second : steps[1]) offsets.push_back(first * rectangle.direction[0] + second * rectangle.direction[1]);
  return offsets;
}

}  // namespace dovetail::cg
