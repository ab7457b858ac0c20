// Which points markers go with.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "dovetail/mpm/markers.hpp"

namespace dovetail::mpm::detail {

/// Points of each marker: compressed rows.
struct Anchors {
  std::vector<std::size_t> first{0}, point;
};

/// The nearest point, and those that are hardly farther.
/// @throws InputError naming a marker that is not finite or farther than a spacing from every point
Anchors nearestPoints(const GridOptions& grid, std::span<const Vec3> points, std::span<const Vec3> markers,
                      const std::string& name);

/// map and images of markers at X among points at x, on a grid that has been laid out there.
void findMap(const GridOptions& grid, const GridRows& rows, const Anchors& anchors, std::span<const Vec3> x,
             Markers& markers);

}  // namespace dovetail::mpm::detail
