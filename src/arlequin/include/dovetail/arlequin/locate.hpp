// Which brick holds a point, and where in it.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "dovetail/core/vec3.hpp"
#include "dovetail/geometry/hierarchical_grid.hpp"

namespace dovetail::arlequin {

/// A point's place in a mesh.
struct Place {
  int element;
  Vec3 xi;                      ///< parent coordinates, each within −1 … 1 up to round-off
  std::array<double, 8> shape;  ///< ψ_a(ξ); their sum is one
};

/// Bricks in some configuration, sorted for look-up. A point on a face that several bricks share belongs to the one
/// with the lowest number: every point has one owner.
class ElementLocator {
public:
  /// @param position  of the nodes, m: reference, or X + u
  /// @throws InputError without elements, or for a node number out of range
  ElementLocator(std::span<const std::array<int, 8>> elements, std::span<const Vec3> position);

  /// Nothing if the point is outside.
  std::optional<Place> find(const Vec3& point) const;

private:
  std::vector<std::array<Vec3, 8>> corners_;
  geometry::HierarchicalGrid grid_;
};

/// Parent coordinates of a point in a brick by Newton's method; nothing if it does not settle near the brick.
/// @param corners  in the order of Bricks::elements, m
std::optional<Vec3> parentCoordinates(const std::array<Vec3, 8>& corners, const Vec3& point);

}  // namespace dovetail::arlequin
