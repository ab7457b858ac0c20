// How far points have moved since candidates were found.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "dovetail/core/vec3.hpp"

namespace dovetail::surface {

/// Largest displacement between two states, m; NaN if any is NaN, so that a comparison with a margin fails.
inline double largestTravel(std::span<const Vec3> now, std::span<const Vec3> then) {
  double squared = 0.0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const double d2 = squaredNorm(now[i] - then[i]);
    if (!(d2 <= squared)) squared = d2;
    if (std::isnan(squared)) break;
  }
  return std::sqrt(squared);
}

/// The same for some nodes; then[k] belongs to node[k].
inline double largestTravel(std::span<const Vec3> now, std::span<const int> node, std::span<const Vec3> then) {
  double squared = 0.0;
  for (std::size_t k = 0; k < node.size(); ++k) {
    const double d2 = squaredNorm(now[node[k]] - then[k]);
    if (!(d2 <= squared)) squared = d2;
    if (std::isnan(squared)) break;
  }
  return std::sqrt(squared);
}

}  // namespace dovetail::surface
