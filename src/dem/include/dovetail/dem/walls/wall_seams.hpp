// Walls that join act as one surface.
#pragma once

#include <cstdint>
#include <span>

#include "dovetail/dem/laws/contact_laws.hpp"
#include "dovetail/dem/walls/wall_clearances.hpp"

namespace dovetail::dem {

/// By what the contacts of a wall are answered.
struct WallAnswer {
  const ContactLaws* laws = nullptr;
  int material = 0;

  friend bool sameAnswer(const WallAnswer& a, const WallAnswer& b) {
    if (!(a.laws == b.laws || (a.laws && b.laws && sameLaws(*a.laws, *b.laws)))) return false;
    return a.material == b.material || (a.laws && a.laws->materials() == 1);
  }
};

/// A wall with the contacts that its particles have with it alone.
struct WallAtSeam {
  const TriangulatedWall* wall;
  const WallCandidates* candidates;
  WallContacts* contacts;
  WallAnswer answer;
  const WallClearances* clearances = nullptr;  ///< null: unknown
  std::span<const std::uint8_t> absent{};      ///< particles, not 0, that it does not push; empty: none
};

/// Particles that touch several of the walls with the same answer have contact with the facets of all of them as with
/// those of one wall, under EdgeRule::projected: one force per place. Each wall gets the contacts with its facets. The
/// same for any number of threads.
/// @param walls whose contacts are those of findWallContacts now, and have not been answered
void joinAtSeams(const Particles& particles, std::span<const WallAtSeam> walls);

/// Contacts of a wall, or of a part of it.
struct AnsweredContacts {
  WallContacts* contacts;
  WallAnswer answer;
};

/// Where a contact has passed to another wall with the same answer, its memory goes with it.
/// @param walls whose contacts have not been answered
void passMemories(std::span<const AnsweredContacts> walls);

}  // namespace dovetail::dem
