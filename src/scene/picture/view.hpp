// From where a scene is seen.
#pragma once

#include <optional>
#include <vector>

#include "dovetail/geometry/box.hpp"
#include "dovetail/picture/draw.hpp"

namespace dovetail::scene {

/// Box of what is drawn. Of many balls, a few that have flown off do not count.
geometry::Box boxOf(const picture::Drawing& drawing);

/// Directions of a view; centre and scale are left open.
/// @param up  any length but 0; azimuth, elevation in degrees: the first counts about `up` from −y (from z, where −y is
///   upwards) counter-clockwise. Not given: along the shorter horizontal side of the box, a little from the right and
///   from above, more so for what is flat
picture::Camera viewOf(const geometry::Box& box, const Vec3& up, std::optional<double> azimuth,
                       std::optional<double> elevation);

/// Whether nothing of a flat box is seen.
bool isSeenFromItsEdge(const geometry::Box& box, const picture::Camera& camera);

/// Extents of the corners of a box in a view, m: to the right and upwards.
struct Extent {
  double left = 1e300, right = -1e300, below = 1e300, above = -1e300;
  void add(const picture::Camera& camera, const Vec3& place, double radius);
};

}  // namespace dovetail::scene
