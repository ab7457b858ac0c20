// A triangulated surface as it is read, checked and repaired, before it becomes a wall.
#pragma once

#include <span>
#include <vector>

#include "dovetail/core/vec3.hpp"
#include "dovetail/geometry/surface_topology.hpp"

namespace dovetail::geometry {

struct TriangleMesh {
  std::vector<Vec3> x;        ///< vertices, m
  std::vector<Facet> facets;  ///< vertex numbers, counter-clockwise seen from the side the normal points to
};

/// Makes one vertex of those that lie within `tolerance` of each other: in ascending order, each vertex goes to the
/// first one kept that is not farther than `tolerance`; that one does not move. Facets keep their number, order and
/// sense, and may name a vertex twice afterwards. Unused vertices are kept.
/// @param tolerance m, ≥ 0; 0 = equal coordinates only
/// @return how many vertices went
/// @throws InputError if the tolerance is not finite and ≥ 0, a vertex is not finite, or a facet names a missing vertex
int weldVertices(TriangleMesh& mesh, double tolerance);

/// Of closed patches that enclose a negative volume where it ought to be positive.
enum class ClosedPatches { turn, keep };

/// What repairSurface did.
struct SurfaceRepair {
  int weldedVertices = 0;
  int degenerateFacets = 0;     ///< dropped: a vertex twice, or no area to round-off
  int duplicateFacets = 0;      ///< dropped: the same three vertices as an earlier facet, whatever their order
  int turnedFacets = 0;         ///< their sense was turned
  int turnedPatches = 0;        ///< closed patches turned as a whole, as their normals pointed inwards
  int unusedVertices = 0;       ///< dropped
  int unorientablePatches = 0;  ///< patches in which no choice of senses agrees (Möbius strips); left as they were
  bool changedAnything() const {
    return weldedVertices + degenerateFacets + duplicateFacets + turnedFacets + unusedVertices > 0;
  }
};

/// Welds, drops facets without area and duplicates, and orients each patch of facets joined over edges that two share:
/// in a patch most facets keep their sense (the first one's, at a tie); a closed patch is turned so that it encloses a
/// positive volume, or a negative one where it is a cavity (an odd number of closed patches around it). Drops unused
/// vertices last. Holes are not filled and intersections not cut: check again afterwards with checkSurface.
/// @param tolerance for the welding, m
/// @throws InputError as weldVertices
/// @param closed  whether closed patches are turned at all
SurfaceRepair repairSurface(TriangleMesh& mesh, double tolerance = 0.0, ClosedPatches closed = ClosedPatches::turn);

/// ⅙ Σ a·(b × c) over the facets, m³: the volume enclosed by a closed surface whose normals point outwards, negative
/// where they point inwards; of no meaning for open ones.
double signedVolume(std::span<const Vec3> x, std::span<const Facet> facets);

/// Solid angle of the surface seen from `point`, over 4π: 1 inside a closed surface with outward normals, 0 outside
/// (Van Oosterom & Strackee, IEEE Trans. Biomed. Eng. 30, 1983).
double windingNumber(std::span<const Vec3> x, std::span<const Facet> facets, const Vec3& point);

}  // namespace dovetail::geometry
