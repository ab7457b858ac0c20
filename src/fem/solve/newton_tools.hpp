// What the Newton iterations of statics and dynamics share.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "dovetail/core/vec3.hpp"

namespace dovetail::fem::detail {

/// Euclidean norms.
inline double normOf(std::span<const double> x) {
  double sum = 0.0;
  for (const double value : x) sum += value * value;
  return std::sqrt(sum);
}
inline double normOf(std::span<const Vec3> x) {
  double sum = 0.0;
  for (const Vec3& value : x) sum += squaredNorm(value);
  return std::sqrt(sum);
}

inline double product(std::span<const double> a, std::span<const double> b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// A smaller share of an increment, for a line search (Matthies & Strang 1979): where the slope r · increment vanishes
/// by the secant, kept between a tenth and eight tenths of the share tried; a quarter if there is no slope.
/// @param slopeAtZero  at share 0   @param slope  at `share`; NaN if the forces there are not finite
inline double shorterShare(double share, double slopeAtZero, double slope) {
  if (!std::isfinite(slope) || slope == slopeAtZero) return 0.25 * share;
  return std::clamp(-slopeAtZero * share / (slope - slopeAtZero), 0.1 * share, 0.8 * share);
}

}  // namespace dovetail::fem::detail
