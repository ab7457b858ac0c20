// The grid under material points: the nodes that they reach, and their weights.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "dovetail/core/vec3.hpp"
#include "dovetail/mpm/shapes.hpp"

namespace dovetail::mpm {

enum class BorderKind {
  symmetry,  ///< nothing moves through it: motion beyond is the mirror image
  held       ///< nothing moves at it: motion beyond is the opposite of the mirror image
};

/// A plane normal to an axis through nodes, which the body does not pass. What nodes beyond it would weigh goes to
/// their mirror images, so that Σ weight = 1 and fields that obey the border are reproduced up to it.
struct GridBorder {
  int axis = 1;        ///< 0 … 2; in the plane 0, 1
  bool above = false;  ///< whether it bounds the body from above (larger coordinates)
  double place = 0.0;  ///< m, along the axis
  BorderKind kind = BorderKind::symmetry;
};

struct GridOptions {
  double spacing = 0.0;  ///< h of the nodes, m
  Shape shape = Shape::quadratic;
  bool plane = true;  ///< plane strain: x and y, one layer of nodes at z = 0
  Vec3 origin{};      ///< where a node would lie, m
  std::vector<GridBorder> borders{};
  double gimpHalf = 0.25;  ///< of the box of `gimp` along an axis, over the spacing
};

/// @throws InputError for a spacing that is not positive, a border of another axis, off the nodes, twice on one side,
/// or two that leave less room than a point reaches
void validate(const GridOptions& grid);

/// Points of one cell reach the same nodes. Nodes are those that some point reaches, in the order of z, y, x.
struct GridRows {
  std::size_t perPoint = 0;         ///< nodes that a point reaches
  std::vector<int> cell;            ///< of each point
  std::vector<int> node;            ///< [perPoint cell + a]
  std::vector<std::uint8_t> flip;   ///< the same: bit c: component c is that of a mirror image, with the other sign
  std::vector<Vec3> reached;        ///< the same: where it was before it was mirrored, m
  std::vector<double> weight;       ///< [perPoint point + a]
  std::vector<Vec3> slope;          ///< the same, ∂weight/∂x, 1/m
  std::vector<int> firstOfCell;     ///< CSR over `pointOfCell`
  std::vector<int> pointOfCell;     ///< ascending within a cell
  std::vector<int> firstOfNode;     ///< CSR over `entryOfNode`
  std::vector<int> entryOfNode;     ///< places in `node`, ascending
  std::vector<Vec3> X;              ///< of nodes, m
  std::vector<std::uint8_t> fixed;  ///< of nodes: bits of components that a border or the plane holds

  std::size_t points() const { return cell.size(); }
  std::size_t nodes() const { return X.size(); }
  std::size_t cells() const { return node.size() / perPoint; }
};

/// @throws NumericalError naming a point that is not finite or lies beyond a border
GridRows rowsAt(const GridOptions& grid, std::span<const Vec3> x, const std::string& name);

/// Points in a cell of the grid: the mean of the cells whose neighbours along the axes hold points too or lie beyond a
/// border, of all that hold points where there are none such. Below `leastPerCell` nodes move points without a strain
/// that any point sees, and a body that is renewed sinks for ever under its weight.
double pointsPerCell(const GridOptions& grid, std::span<const Vec3> x);
inline double leastPerCell(const GridOptions& grid) {
  if (!grid.plane) return 3.0;
  return grid.shape == Shape::cubic ? 2.4 : 2.0;
}

/// v with the components of `flip` turned round.
inline Vec3 flipped(const Vec3& v, std::uint8_t flip) {
  return {flip & 1 ? -v.x : v.x, flip & 2 ? -v.y : v.y, flip & 4 ? -v.z : v.z};
}

/// Calls visit(a, value) for the nodes that a point reaches, with the value as the point sees it.
template <class Visit>
void eachReached(const GridRows& rows, std::size_t point, std::span<const Vec3> nodal, Visit&& visit) {
  const std::size_t begin = rows.perPoint * static_cast<std::size_t>(rows.cell[point]);
  for (std::size_t a = 0; a < rows.perPoint; ++a)
    visit(a, flipped(nodal[static_cast<std::size_t>(rows.node[begin + a])], rows.flip[begin + a]));
}

/// Σ weight value at a point.
inline Vec3 valueAt(const GridRows& rows, std::size_t point, std::span<const Vec3> nodal) {
  Vec3 sum;
  const double* const weight = &rows.weight[rows.perPoint * point];
  eachReached(rows, point, nodal, [&](std::size_t a, const Vec3& value) { sum += weight[a] * value; });
  return sum;
}

}  // namespace dovetail::mpm
