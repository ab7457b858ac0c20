// Patches of facets joined over edges, and which way round the closed ones should be.
#pragma once

#include <span>
#include <vector>

#include "dovetail/core/vec3.hpp"
#include "dovetail/geometry/surface_topology.hpp"

namespace dovetail::geometry {

/// Facets joined over edges that exactly two facets share. A facet that repeats a vertex is in no patch.
struct Patches {
  std::vector<std::vector<int>> facets;  ///< per patch, ascending; patches in the order of their first facet
  std::vector<char> turned;              ///< per facet: its sense is opposite to that of its patch's first facet
  std::vector<char> closed;              ///< per patch: every edge of it is shared by exactly two facets
  std::vector<char> oriented;            ///< per patch: a consistent choice of senses exists
};
Patches findPatches(std::span<const Facet> facets);

/// The closed patches whose facets, as they stand, enclose a volume of the wrong sign, ascending. Only those given.
/// @param patches lists of facets, each closed and consistently oriented
std::vector<int> wrongSideOut(std::span<const Vec3> x, std::span<const Facet> facets,
                              const std::vector<std::vector<int>>& patches);

}  // namespace dovetail::geometry
