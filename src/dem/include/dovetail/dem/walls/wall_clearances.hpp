// Distances of candidates from touch, so that most need no check at every step.
#pragma once

#include <vector>

#include "dovetail/dem/walls/wall_contacts.hpp"

namespace dovetail::dem {

/// Clearances of a list of candidates, and the motion of particles and vertices since.
struct WallClearances {
  /// Entry by entry of WallCandidates::facet: distance from the facet less the radius when the list was made, m.
  std::vector<double> whenListed;
  double travelled = 0.0;  ///< bound on how far any particle and any vertex together have come since then, m

  /// Whether a facet may be closer than radius + beyond (m) by now. Round-off of positions is allowed for.
  bool mayBeWithin(std::size_t entry, double radius, double beyond) const {
    return !(whenListed[entry] > travelled + beyond + 1e-6 * radius);
  }
};

/// Clearances of candidates whose list has just been made.
WallClearances clearancesNow(const Particles& particles, const TriangulatedWall& wall,
                             const WallCandidates& candidates);

/// The same contacts, digit for digit, as without clearances.
/// @param clearances  one per entry
void findWallContacts(const Particles& particles, const TriangulatedWall& wall, const WallCandidates& candidates,
                      const WallClearances& clearances, EdgeRule rule, WallContacts& contacts);

}  // namespace dovetail::dem
