// How far from the origin things may lie.
#pragma once

#include <cmath>

#include "dovetail/core/vec3.hpp"

namespace dovetail {

/// m, along each axis: farther out squares of distances are of no use, and coordinates in other units are likelier.
inline constexpr double farthestPlace = 1e15;

/// So is a place that is no number.
inline bool isTooFar(const Vec3& x) {
  const auto isNear = [](double value) { return std::abs(value) <= farthestPlace; };
  return !(isNear(x.x) && isNear(x.y) && isNear(x.z));
}

}  // namespace dovetail
