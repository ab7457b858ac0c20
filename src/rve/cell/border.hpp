// The border of a disc cell that repeats: which grains lie on it, in which order.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "dovetail/rve/rve.hpp"

namespace dovetail::rve {

/// A grain at a place: centre = that of the cell + H image.
struct Placed {
  int grain;
  geometry::Image image;
};

/// One period's worth of grains, and the copies that close the frame.
struct Border {
  /// Counter-clockwise from the corner: bottom, right, top, left, each with the corner at its beginning.
  std::array<std::vector<Placed>, 4> side;
  std::size_t sideways, upwards;  ///< period that leads from left to right, and from bottom to top
  std::vector<Placed> inner;
};

Vec3 centreOf(const Rve& cell, const Placed& placed);

/// The border through a grain as corner; nothing if it is no simple polygon, or a grain lies on both of its lines.
std::optional<Border> borderThrough(const Rve& cell, int corner);

}  // namespace dovetail::rve
