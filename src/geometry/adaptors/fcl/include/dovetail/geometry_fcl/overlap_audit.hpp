// Which bodies of a set-up overlap, by the Flexible Collision Library: slow, and independent of the hierarchical grid.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "dovetail/core/vec3.hpp"
#include "dovetail/geometry/triangle_mesh.hpp"

namespace dovetail::geometry {

/// Bodies to be held against each other. Spheres have the numbers 0 … n − 1, meshes follow.
struct AuditBodies {
  std::span<const Vec3> centre;        ///< of the spheres, m
  std::span<const double> radius;      ///< m, as many
  std::span<const TriangleMesh> mesh;  ///< vertices where they are now, m
};

/// All pairs of bodies {i < j} that overlap, sorted. A mesh that is closed and oriented outwards is solid: what lies
/// inside it overlaps with it; any other is a sheet without thickness. Whether bodies that touch to round-off are
/// listed is open.
/// @throws InputError if centres and radii differ in number, a radius is not finite and > 0, a position is not finite,
///   or a mesh has no facets or names a missing vertex
std::vector<std::array<int, 2>> auditOverlaps(const AuditBodies& bodies);

}  // namespace dovetail::geometry
