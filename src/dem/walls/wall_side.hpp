// On which side of one-sided walls a particle's centre is.
#pragma once

#include <span>

#include "met_facets.hpp"

namespace dovetail::dem {

/// Distances that differ by less, of the radius, count as equal.
inline constexpr double sameFoot = 1e-12;

/// Whether an edge, or a facet at a vertex, has no neighbour there: the end of an open surface.
bool onRim(const MetWall& met, std::size_t entry, geometry::Feature feature);

/// Whether the centre lies inside a one-sided wall, by the nearest feature alone: of an edge or a vertex the normals
/// around it, weighted with their angles, decide (Bærentzen & Aanæs, IEEE Trans. Vis. Comput. Graph. 11, 2005).
/// Beside a rim there is no inside.
/// @param nearest distance to it, m
bool insideWall(std::span<const MetWall> walls, double nearest);

}  // namespace dovetail::dem
