// Where in a cell a point lies.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "dovetail/fem/mesh/solid_mesh.hpp"
#include "dovetail/geometry/box.hpp"

namespace dovetail::fem::detail {

/// The box of a cell's Bézier points: cells with curved edges bulge out of the box of their nodes, but not out of this.
geometry::Box boxOf(ElementShape shape, std::span<const Vec3> nodes);

/// What Newton's method says of a point, from the centre of the cell.
enum class Verdict {
  inside,
  outside,   ///< it went to a place beyond the cell; in folded cells another solution may hide within
  unsettled  ///< nothing
};
struct ParentGuess {
  Verdict verdict;
  Vec3 xi;
};
/// Solves x(ξ) = point. Of plane cells x and y alone are asked. Within means up to round-off: 1e-12, and what 64 ε of
/// the size of the coordinates are in parent coordinates.
/// @param nodes  of the cell, as many as the shape has
ParentGuess guessParent(ElementShape shape, std::span<const Vec3> nodes, const Vec3& point);

/// The same and sure, but slow: cuts the cell into parts until Newton's method finds the point from the centre of one,
/// or no part's box holds it.
/// @param cell  its name in errors
/// @return nothing if the point is outside
/// @throws NumericalError naming cell and point if the cell is so flat or folded that its parts do not tell
std::optional<Vec3> searchParent(ElementShape shape, std::span<const Vec3> nodes, const Vec3& point,
                                 const std::string& cell);

}  // namespace dovetail::fem::detail
