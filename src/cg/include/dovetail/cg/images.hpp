// Periodic images, so that fields near the border of a periodic cell include particles across it.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "dovetail/core/vec3.hpp"
#include "dovetail/geometry/hierarchical_grid.hpp"

namespace dovetail::cg {

/// Items of a cell and their images: image m is item source[m], moved by shift[m].
struct PeriodicImages {
  std::vector<int> source;
  std::vector<Vec3> shift;  ///< whole periods, m

  std::size_t size() const { return source.size(); }
  /// Places of the images, m.
  std::vector<Vec3> moved(std::span<const Vec3> x) const {
    std::vector<Vec3> places;
    for (std::size_t m = 0; m < size(); ++m) places.push_back(x[static_cast<std::size_t>(source[m])] + shift[m]);
    return places;
  }
  /// What the images carry: velocities, masses, forces.
  template <class Value>
  std::vector<Value> copied(std::span<const Value> values) const {
    std::vector<Value> copies;
    for (const int i : source) copies.push_back(values[static_cast<std::size_t>(i)]);
    return copies;
  }
};

/// All images of points that lie in the cell grown by `reach`, by item, then shift. Along periodic axes the points may
/// lie anywhere; along the others every point counts once, wherever it is.
/// @param space the cell and its periodic axes
/// @param reach m: the kernel's width, for particles; and half the longest branch more, for branches by their middle
/// @throws InputError unless the cell is finite with lower < upper along periodic axes, reach is finite, ≥ 0 and at
/// most
///         32 periods, and points are finite
PeriodicImages periodicImages(std::span<const Vec3> x, const geometry::Periodicity& space, double reach);

}  // namespace dovetail::cg
