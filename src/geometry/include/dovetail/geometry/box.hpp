// Axis-aligned boxes.
#pragma once

#include <algorithm>

#include "dovetail/core/vec3.hpp"

namespace dovetail::geometry {

/// Closed axis-aligned box, lower ≤ upper in every component (m).
struct Box {
  Vec3 lower, upper;
  friend constexpr bool operator==(const Box&, const Box&) = default;
};

/// Bounding box of three points, such as the vertices of a facet.
inline Box boundingBox(const Vec3& a, const Vec3& b, const Vec3& c) {
  return {{std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y}), std::min({a.z, b.z, c.z})},
          {std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y}), std::max({a.z, b.z, c.z})}};
}

/// The box grown by `margin` (m) on all six sides.
inline Box expanded(const Box& box, double margin) {
  const Vec3 m{margin, margin, margin};
  return {box.lower - m, box.upper + m};
}

}  // namespace dovetail::geometry
