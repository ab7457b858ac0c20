// What is wrong with a triangulated surface, facet by facet.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "dovetail/core/vec3.hpp"
#include "dovetail/geometry/surface_topology.hpp"

namespace dovetail::geometry {

/// Facets that contact search treats as an edge or a point, edges that spoil a closed oriented skin, and skins that
/// cross themselves or are inside out. Each list is ascending.
struct SurfaceDefects {
  std::vector<int> repeatedVertex;  ///< facets that name a vertex twice
  std::vector<int> zeroArea;        ///< facets whose area is zero to round-off (height ≤ 1e-14 longest edge)
  std::vector<int> needle;          ///< further facets whose height is below `needleRatio` of their longest edge
  std::vector<std::array<int, 2>> duplicate;    ///< {facet, earlier facet} with the same three vertices in any order
  std::vector<std::array<int, 2>> boundary;     ///< {facet, edge} that no other facet shares
  std::vector<std::array<int, 2>> nonManifold;  ///< {facet, edge} shared by more than two facets
  std::vector<std::array<int, 2>> flipped;      ///< {facet, edge} that the neighbour runs through in the same sense
  std::vector<std::array<int, 2>> selfIntersection;  ///< pairs of facets, see selfIntersections
  std::vector<int> insideOut;     ///< first facet of each closed patch that encloses a volume of the wrong sign
  std::vector<int> unusedVertex;  ///< vertices that no facet names

  bool badFacets() const { return !repeatedVertex.empty() || !zeroArea.empty() || !needle.empty(); }
  bool closedAndOriented() const { return boundary.empty() && nonManifold.empty() && flipped.empty(); }
  /// No entry in any list: fit for a one-sided wall.
  bool none() const {
    return !badFacets() && closedAndOriented() && duplicate.empty() && selfIntersection.empty() && insideOut.empty() &&
           unusedVertex.empty();
  }
};

/// Reports, and changes nothing. Takes facets that makeTopology would refuse for a repeated vertex (their edges then
/// count as they stand). Vertices are the same where their numbers are the same: weld first (weldVertices).
///
/// insideOut: of closed, consistently oriented patches, joined over edges. A patch should enclose a positive volume;
/// one that lies within an odd number of others is a cavity and should enclose a negative one.
/// @param needleRatio height / longest edge below which a facet counts as a needle
/// @throws InputError on a vertex number outside the range of x, or a vertex that is not finite
SurfaceDefects checkSurface(std::span<const Vec3> x, std::span<const Facet> facets, double needleRatio = 1e-6);

/// One line per kind of defect with its count and the first few facets; "no defects" if there are none.
std::string describe(const SurfaceDefects& defects);

/// Pairs of facets {i < j} that have more in common than the vertices and edges whose numbers they share, sorted.
/// Decided with exact arithmetic on the coordinates as they are. Facets that touch without sharing a vertex number
/// count, coplanar overlaps and facets folded onto their neighbour too. Left out: facets without area, and pairs with
/// all three vertices in common (duplicates). Candidates come from the hierarchical grid, O(N) for even meshes.
/// @throws InputError on a vertex number outside the range of x, or a vertex that is not finite
std::vector<std::array<int, 2>> selfIntersections(std::span<const Vec3> x, std::span<const Facet> facets);

}  // namespace dovetail::geometry
