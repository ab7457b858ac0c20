// Triangulated surfaces: adjacency, dihedral angles, smooth patches.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "dovetail/core/vec3.hpp"

namespace dovetail::geometry {

/// Vertex numbers, counter-clockwise seen from the side the normal points to.
using Facet = std::array<int, 3>;

/// Adjacency of facets. Edge k of a facet runs from its vertex k to its vertex (k + 1) mod 3.
struct SurfaceTopology {
  /// [facet][edge]: the facet across the edge, −1 at a boundary and where more than two facets share the edge
  std::vector<std::array<int, 3>> neighbours;
  /// CSR: the facets at vertex v are vertexFacets[vertexFacetOffsets[v] … vertexFacetOffsets[v + 1] − 1], ascending
  std::vector<int> vertexFacetOffsets, vertexFacets;

  std::span<const int> facetsAtVertex(int v) const {
    const auto begin = static_cast<std::size_t>(vertexFacetOffsets[static_cast<std::size_t>(v)]);
    const auto end = static_cast<std::size_t>(vertexFacetOffsets[static_cast<std::size_t>(v) + 1]);
    return std::span<const int>(vertexFacets).subspan(begin, end - begin);
  }
};

/// Vertices are the same where their numbers are the same: coincident points are not merged.
/// Two facets that share an edge but run through it in the same sense (one of them flipped) still are neighbours.
/// @throws InputError on a vertex number outside [0, vertexCount) or a facet that repeats a vertex, naming the facet
SurfaceTopology makeTopology(std::span<const Facet> facets, int vertexCount);

/// Number, in facet b, of the edge that b shares with edge `edge` of facet a; −1 if there is none.
int sharedEdge(std::span<const Facet> facets, int a, int edge, int b);

/// Angle (rad) between the normals of a facet and of its neighbour across an edge: 0 = flat, > 0 convex (a ridge seen
/// from the side the facet's normal points to), < 0 concave (a valley), π folded back upon itself.
/// The neighbour's normal is taken as if both ran through the edge in opposite senses, so a flipped neighbour does
/// not change the answer. 0 if a normal vanishes.
/// @throws InputError if the edge has no neighbour
double edgeAngle(std::span<const Vec3> x, std::span<const Facet> facets, int facet, int edge,
                 const SurfaceTopology& topology);

/// Patch number (0, 1, … in the order of each patch's first facet) per facet. Two facets are in one patch when a chain
/// of neighbours joins them, none of whose edges is sharper than `sharpAngle` (rad, |edgeAngle| > sharpAngle).
/// A facet without area joins no patch but its own, so that it cannot bridge a sharp edge.
std::vector<int> smoothPatches(std::span<const Vec3> x, std::span<const Facet> facets, const SurfaceTopology& topology,
                               double sharpAngle);

}  // namespace dovetail::geometry
