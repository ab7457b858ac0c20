// Checks and repair of surfaces by CGAL's Polygon_mesh_processing, which is under the GPL: a program that links this
// component is bound by it. Nothing else in the library needs it.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "dovetail/core/vec3.hpp"
#include "dovetail/geometry/triangle_mesh.hpp"

namespace dovetail::geometry {

/// What CGAL says about a surface as it stands.
struct CgalReport {
  bool isMesh = false;  ///< manifold and consistently oriented; if not, the other entries are empty
  bool closed = false;
  bool boundsVolume = false;                         ///< closed, and all patches turned the right way round
  std::vector<std::array<int, 2>> selfIntersection;  ///< pairs of facets {i < j}, sorted
};

/// @throws InputError on a vertex that is not finite, or a facet that names a missing vertex, or one vertex twice
CgalReport checkWithCgal(std::span<const Vec3> x, std::span<const Facet> facets);

struct CgalRepairOptions {
  bool fillHoles = true;  ///< each open border gets a patch of triangles
};
struct CgalRepair {
  int filledHoles = 0;
  bool closed = false;            ///< afterwards
  bool boundsVolume = false;      ///< afterwards
  bool selfIntersecting = false;  ///< afterwards; such places are left as they are
};

/// Merges points with equal coordinates and facets with equal vertices, drops what has no area, orients, splits
/// vertices and edges where more than two sheets meet, stitches borders that lie on each other, fills holes, and turns
/// closed patches the right way round. Vertices and facets are numbered anew.
/// @throws InputError as checkWithCgal, but for repeated vertices, which are dropped; NumericalError if CGAL gives up
CgalRepair repairWithCgal(TriangleMesh& mesh, const CgalRepairOptions& options = {});

}  // namespace dovetail::geometry
