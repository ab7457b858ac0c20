// Forces of the contacts between particles and a triangulated wall.
#pragma once

#include <cmath>

#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/contact_work.hpp"
#include "dovetail/dem/laws.hpp"
#include "dovetail/dem/wall_contacts.hpp"

namespace dovetail::dem {

namespace detail {

/// Fills contacts.springs.next with the stretch carried over from the last step: from the same facet or one that shares
/// a vertex, the nearest normal first. Returns Σ|stretch|² of the springs whose contact has ended, m².
double carrySprings(WallContacts& contacts, const TriangulatedWall& wall);
/// Remembers the contacts and their stretch for the next step.
void keepSprings(WallContacts& contacts);
/// @throws InputError unless dt is finite and > 0
void requireStep(double dt);

/// Velocity of the particle relative to the wall at the contact, m/s.
template <bool withSpin>
Vec3 relativeVelocity(const Particles& particles, const TriangulatedWall& wall, const WallContacts& contacts,
                      std::size_t c) {
  const auto i = static_cast<std::size_t>(contacts.particle[c]);
  Vec3 velocity = particles.v[i] - wallVelocity(contacts, wall, c);
  if constexpr (withSpin)
    if (particles.rotates()) velocity += cross(particles.omega[i], contactPoint(contacts, wall, c) - particles.x[i]);
  return velocity;
}

/// Force of one contact; writes to places of this contact only.
template <class Law, class Normal>
ContactWork wallForce(const Particles& particles, const TriangulatedWall& wall, WallContacts& contacts, std::size_t c,
                      const Law& law, const Normal& normal, double dt) {
  const Vec3& n = contacts.normal[c];
  const double overlap = contacts.overlap[c], engagement = contacts.engagement[c];
  const double rootMass = std::sqrt(particles.mass[static_cast<std::size_t>(contacts.particle[c])]);
  const Vec3 velocity = relativeVelocity<Law::hasHistory>(particles, wall, contacts, c);
  const double separating = dot(n, velocity);
  const double pressure = normal.force(overlap, separating, engagement, rootMass);
  contacts.force[c] = pressure * n;
  ContactWork work;
  work.elasticEnergy = normal.energy(overlap, engagement);
  work.dissipatedPower = (normal.elasticForce(overlap) - pressure) * separating;
  if constexpr (Law::hasHistory) {
    const auto grip = law.tangential.respond(contacts.springs.next[c], n, velocity, pressure, dt);
    contacts.force[c] += grip.force;
    work.tangentialEnergy = grip.energy;
    work.frictionPower = grip.slipWork / dt;
  }
  return work;
}

}  // namespace detail

/// Sets contacts.force and adds it to particles.f (and its torque, if the law has friction and the particles spin).
/// Effective mass of a dashpot: the particle's. Call once per step if the law has friction: it stretches the springs.
///
/// Wall velocities enter with the weights that carry the force, so power balances: Σ force·(v_particle − v_wall)
/// = −d(elastic energy)/dt − dissipated power. The moment of elastic forces balances to round-off; that of a dashpot
/// does in a single contact, and where facets share a contact up to (dashpot force) × (overlap).
/// @param dt  step over which tangential springs stretch, s; of no concern to other laws
/// @throws InputError if the law has friction and dt is not finite and > 0
template <class Normal, class Tangential>
ContactWork collideWithWall(Particles& particles, const TriangulatedWall& wall, WallContacts& contacts,
                            const ContactLaw<Normal, Tangential>& law, double dt = 0.0) {
  using Law = ContactLaw<Normal, Tangential>;
  constexpr std::size_t grain = 256;
  ContactWork lost;
  if constexpr (Law::hasHistory) {
    detail::requireStep(dt);
    lost.frictionPower = 0.5 * law.tangential.stiffness * detail::carrySprings(contacts, wall) / dt;
  }
  if (contacts.size() > 0) {
    const auto normal = law.normal.prepare();
    const auto forces = [&](std::size_t begin, std::size_t end) {
      ContactWork sum;
      for (std::size_t c = begin; c < end; ++c) sum += detail::wallForce(particles, wall, contacts, c, law, normal, dt);
      return sum;
    };
    lost += contacts.size() <= grain ? forces(0, contacts.size()) : parallelSum(contacts.size(), grain, forces);
  }
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const auto i = static_cast<std::size_t>(contacts.particle[c]);
    particles.f[i] += contacts.force[c];
    if constexpr (Law::hasHistory)
      if (particles.rotates())
        particles.torque[i] += cross(contactPoint(contacts, wall, c) - particles.x[i], contacts.force[c]);
  }
  if constexpr (Law::hasHistory) detail::keepSprings(contacts);
  return lost;
}

}  // namespace dovetail::dem
