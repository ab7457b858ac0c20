// Forces of the contacts between particles and a triangulated wall.
#pragma once

#include "dovetail/dem/walls/wall_contacts.hpp"
#include "dovetail/dem/walls/wall_law.hpp"

namespace dovetail::dem {

inline WallShare shareOf(const WallContacts& contacts, std::size_t c) {
  return {contacts.overlap[c] / contacts.engagement[c], contacts.engagement[c], contacts.energyShare[c]};
}

namespace detail {

/// Fills contacts.springs.next with the memories carried over from the last step: from the same facet or one that
/// shares a vertex, the nearest normal first. Returns those of contacts that have ended, leavers' (renumber) among
/// them.
EndedMemories carrySprings(const Particles& particles, WallContacts& contacts, const TriangulatedWall& wall,
                           int memory);
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

}  // namespace detail

/// Sets contacts.force and adds it to particles.f (and its torque, if the law exerts torques and the particles spin).
/// The wall counts as flat: the effective radius is the particle's, and the effective mass too unless the wall has one
/// (TriangulatedWall::mass). Where facets share a
/// contact, each answers with its share (engagement) of what the law says to the overlap of particle and facet alone.
/// Call once per step if the law remembers.
///
/// Wall velocities enter with the weights that carry the force, so power balances: Σ force·(v_particle − v_wall)
/// = −d(elastic energy)/dt − dissipated power. The moment of elastic forces balances to round-off; that of a dashpot
/// does in a single contact, and where facets share a contact up to (dashpot force) × (overlap).
/// @param dt  step over which memories advance, s; of no concern to laws without memory
/// @throws InputError if the law remembers and dt is not finite and > 0
template <class Law>
ContactWork collideWithWall(Particles& particles, const TriangulatedWall& wall, WallContacts& contacts,
                            const PreparedLaws<Law>& laws, double dt, Booking booking = Booking::on) {
  ContactWork work;
  if constexpr (Law::memory > 0) {
    detail::requireStep(dt);
    const EndedMemories ended = detail::carrySprings(particles, contacts, wall, Law::memory);
    if (booking == Booking::on) work += detail::bookEnded<Law>(ended, laws, wall.material, dt);
  }
  if constexpr (Law::rotates) contacts.couple.assign(contacts.size(), Vec3{});
  const bool spins = Law::rotates && particles.rotates();
  work += detail::answerWall<Law>(particles, contacts, contacts.springs.next, laws, {wall.material, wall.mass}, dt,
                                  booking, detail::AgainstFacets{particles, wall, contacts, spins});
  detail::addToParticles(particles, wall, contacts, spins);
  if constexpr (Law::memory > 0) detail::keepSprings(contacts);
  return work;
}

template <class Normal, class Tangential, class Rolling, class Adhesion>
ContactWork collideWithWall(Particles& particles, const TriangulatedWall& wall, WallContacts& contacts,
                            const ContactLaw<Normal, Tangential, Rolling, Adhesion>& law, double dt = 0.0,
                            Booking booking = Booking::on) {
  return collideWithWall(particles, wall, contacts, prepare(law), dt, booking);
}

}  // namespace dovetail::dem
