// Forces of the contacts between particles and a triangulated wall.
#pragma once

#include "dovetail/dem/walls/wall_contacts.hpp"
#include "dovetail/dem/walls/wall_law.hpp"

namespace dovetail::dem {

inline WallFraction fractionOf(const WallContacts& contacts, std::size_t c) {
  return {contacts.overlap[c] / contacts.engagement[c], contacts.engagement[c], contacts.energyFraction[c]};
}

namespace detail {

/// Cosine between two normals from which on they mean one place of a particle.
inline constexpr double samePlace = 0.9;
/// Fills contacts.springs.next with the memories carried over from the last step, from the nearest normal at the same
/// place. Returns those of contacts that have ended, and of contacts that act with
/// another fraction now what they have less of it.
EndedMemories carrySprings(const Particles& particles, WallContacts& contacts, int memory, const WallMemoryKind& kind);
/// Remembers the contacts and what they remember for the next step.
void keepSprings(WallContacts& contacts);

/// How a particle and the wall move at a contact.
struct AgainstFacets {
  const Particles& particles;
  const TriangulatedWall& wall;
  const WallContacts& contacts;
  bool spins;
  Vec3 velocity(std::size_t c) const;
  Vec3 spin(std::size_t c) const;
};

/// Adds the contact forces (and torques) to the particles.
void addToParticles(Particles& particles, const TriangulatedWall& wall, const WallContacts& contacts, bool spins);

/// ContactLaws::wall, with the law known.
template <class Law>
ContactWork collide(Particles& particles, const TriangulatedWall& wall, WallContacts& contacts,
                    const PreparedLaws<Law>& laws, double dt, Booking booking) {
  ContactWork work;
  if constexpr (Law::memory > 0) requireStep(dt);
  if (const int numbers = laws.wallNumbers(); numbers > 0) {
    const EndedMemories ended = carrySprings(particles, contacts, numbers, laws.wallMemoryKind());
    if (booking == Booking::on && dt > 0.0) work += bookEnded<Law>(ended, laws, wall.material, dt);
  } else {
    contacts.springs = {};  // of a law that was there before
  }
  if constexpr (Law::rotates) contacts.couple.assign(contacts.size(), Vec3{});
  const bool spins = Law::rotates && particles.rotates();
  work += answerWall<Law>(particles, contacts, contacts.springs.next, laws, {wall.material, wall.mass}, dt, booking,
                          AgainstFacets{particles, wall, contacts, spins});
  addToParticles(particles, wall, contacts, spins);
  if (laws.wallNumbers() > 0) keepSprings(contacts);
  return work;
}

}  // namespace detail

}  // namespace dovetail::dem
