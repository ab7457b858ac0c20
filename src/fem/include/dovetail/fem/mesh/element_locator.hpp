// Which element holds a point, and where in it.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "dovetail/core/vec3.hpp"
#include "dovetail/fem/mesh/solid_mesh.hpp"
#include "dovetail/geometry/hierarchical_grid.hpp"

namespace dovetail::fem {

/// A point's place in a mesh.
struct CellPlace {
  int element = -1;           ///< number in the mesh
  Vec3 xi;                    ///< parent coordinates, within the parent cell up to round-off
  std::vector<double> shape;  ///< ψ_a(ξ) of the element's nodes; their sum is one
};

/// Elements of any shape in some configuration, sorted for look-up. A point on a face that several elements share
/// belongs to the one with the lowest number: every point has one owner. What counts as on a face is round-off of the
/// coordinates (64 ε of their size), so that no point is lost far from the origin.
class ElementLocator {
public:
  /// In the reference configuration. @throws InputError as below
  explicit ElementLocator(const SolidMesh& mesh);
  /// @param position  of the nodes, m: reference, or X + u
  /// @throws InputError without elements, for a node number out of range, or for an element without extent;
  ///         NumericalError naming a node whose position is not finite
  ElementLocator(std::span<const ElementGroup> groups, std::span<const Vec3> position);

  /// Nothing if the point is outside. Plane elements are asked for x and y alone. Any number of threads may ask.
  /// @throws NumericalError naming element and point if the element is so flat or folded that it cannot be told;
  ///         InputError for a point that is not finite
  std::optional<CellPlace> find(const Vec3& point) const;

  /// The same, and for a point outside that is nearer than `reach` (m) to the mesh the place in the nearest element:
  /// its parent coordinates are then beyond the parent cell, so that Σ ψ_a x_a is the point. Which of several equally
  /// near elements it is, is the one with the lowest number.
  std::optional<CellPlace> findNear(const Vec3& point, double reach) const;

private:
  struct Cell {
    ElementShape shape;
    std::span<const int> node;
  };
  Cell cell(int element) const;
  Vec3 inPlane(const Vec3& point) const;
  CellPlace placeAt(int element, const Vec3& xi) const;

  std::vector<ElementGroup> groups_;
  std::vector<int> end_;  // of each group: the number behind its last element
  std::vector<Vec3> position_;
  std::vector<geometry::Box> box_;  // per element
  geometry::HierarchicalGrid grid_;
  bool plane_ = false;  // plane elements, all at one z
};

}  // namespace dovetail::fem
