// Several walls that meet act as one surface.
#pragma once

#include <cstddef>
#include <span>

#include "dovetail/dem/walls/wall_clearances.hpp"

namespace dovetail::dem {

/// A wall with the contacts that its particles have with it alone.
struct WallAtSeam {
  const TriangulatedWall* wall;
  const WallCandidates* candidates;
  WallContacts* contacts;
  const WallClearances* clearances = nullptr;  ///< null: unknown
};

/// Particles that touch several of the walls meet the facets of all of them as those of one wall, under
/// EdgeRule::projected: one force per place. Each wall gets the contacts with its facets. Where a contact has passed
/// from one wall to the next, what it remembers goes with it. The same for any number of threads.
/// @param walls of one material, whose contacts are those of findWallContacts now, and have not been answered
void joinAtSeams(const Particles& particles, std::span<const WallAtSeam> walls);

namespace detail {
/// A row of what contacts remember goes to another wall, behind those of the same particle there.
void moveSpring(WallSprings& from, std::size_t row, WallSprings& to);
}  // namespace detail

}  // namespace dovetail::dem
