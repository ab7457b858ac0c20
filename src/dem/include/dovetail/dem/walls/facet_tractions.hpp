// Traction on the facets of a wall: where and how strongly particles push.
#pragma once

#include <vector>

#include "dovetail/dem/walls/wall_contacts.hpp"

namespace dovetail::dem {

/// Impulses that facets have received, to be averaged over time. A facet's fraction of a contact is the contact's
/// force.
struct FacetTractions {
  std::vector<Vec3> impulse;  ///< N s, per facet
  double time = 0.0;          ///< s, over which they were gathered
};

/// Adds the contacts of a step. Call after the forces are known, as often as wanted; nothing is spent otherwise.
/// @param dt s, that the contacts stand for
/// @throws InputError unless dt is finite and > 0
void gatherTractions(FacetTractions& tractions, const TriangulatedWall& wall, const WallContacts& contacts, double dt);

/// Mean force on each facet over its area as it is now, Pa: what particles do to the wall, so a push along −normal.
/// Zero for facets without area, and if nothing was gathered.
std::vector<Vec3> meanTractions(const FacetTractions& tractions, const TriangulatedWall& wall);

}  // namespace dovetail::dem
