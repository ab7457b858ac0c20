// Walls given by a formula: planes, cylinders, spheres.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "dovetail/dem/particles/particles.hpp"
#include "dovetail/dem/walls/wall_law.hpp"

namespace dovetail::dem {

/// Contacts of one primitive wall, by particle; at most one for each.
struct PrimitiveContacts {
  std::vector<int> particle;
  std::vector<Vec3> normal;         ///< unit, from the wall to the particle
  std::vector<double> overlap;      ///< m, > 0
  std::vector<double> engagement;   ///< 1: nobody shares these contacts
  std::vector<Vec3> force, couple;  ///< on the particle, N, N m
  std::vector<double> memory;       ///< of the law, contact by contact

  // Those of the last step.
  std::vector<int> oldParticle;
  std::vector<double> oldMemory;
  std::size_t size() const { return particle.size(); }
};

/// A plane, or the inside or outside of an infinite cylinder or a sphere. It moves as a rigid body.
struct PrimitiveWall {
  enum class Shape { plane, cylinder, sphere };
  Shape shape = Shape::plane;
  Vec3 point;            ///< on the plane or the cylinder's axis, or the sphere's centre, m
  Vec3 axis{0, 0, 1};    ///< unit: normal of the plane, towards the particles, or axis of the cylinder
  double radius = 0.0;   ///< m
  bool inside = true;    ///< particles are inside the cylinder or sphere
  Vec3 velocity;         ///< of `point`, m/s
  Vec3 angularVelocity;  ///< about `point`, rad/s
  int material = 0;      ///< row of a LawTable
  /// Sets velocity and angularVelocity for the step that ends at `time`, s; empty: they stay.
  std::function<void(double time, PrimitiveWall& wall)> motion;
  double skin = 0.0;  ///< m: particles closer than their radius + skin are looked at; 0 = all, at every step

  PrimitiveContacts contacts;
  Vec3 force, torque;  ///< of the last collide on the wall, N; about `point`, N m

  std::vector<int> near;  ///< particles looked at
  double travel = 0.0;    ///< how far particles and wall may have moved since `near` was made, m
  std::size_t particlesAtSearch = 0;
  bool searched = false;
};

/// @throws InputError: a normal or axis of no length, a point that is not finite
PrimitiveWall makePlane(const Vec3& point, const Vec3& normal);
/// @throws InputError: an axis of no length, a radius not finite and > 0
PrimitiveWall makeCylinder(const Vec3& point, const Vec3& axis, double radius, bool inside = true);
PrimitiveWall makeSphere(const Vec3& centre, double radius, bool inside = true);

/// Distance of a point from the wall, m, > 0 on the particles' side, and the direction away from it (unit).
struct WallDistance {
  double distance;
  Vec3 normal;
};
WallDistance distanceTo(const PrimitiveWall& wall, const Vec3& x);

/// Velocity of the wall's material at a place, m/s.
inline Vec3 velocityAt(const PrimitiveWall& wall, const Vec3& x) {
  return wall.velocity + cross(wall.angularVelocity, x - wall.point);
}
/// point += velocity dt; the axis turns.
void drift(PrimitiveWall& wall, double dt);

/// Contacts as they are now. Particles are searched again when they and the wall may have used up the skin.
/// @param step bound on how far any particle has moved since the last call, m
void findContacts(const Particles& particles, PrimitiveWall& wall, double step);

/// Gives the wall's memory the new numbers of particles (< 0: gone).
void renumber(PrimitiveWall& wall, std::span<const int> newNumber);

namespace detail {
/// Memories from the last step to this one; returns those whose contact has ended.
EndedMemories carryMemory(PrimitiveContacts& contacts, int memory);
void addToParticles(Particles& particles, PrimitiveWall& wall, bool spins);
}  // namespace detail

/// Adds the contact forces (and torques) to the particles; sets the wall's force and torque.
/// Effective mass and radius are the particle's. Call once per step if the law remembers.
/// @throws InputError if the law remembers and dt is not finite and > 0
template <class Law>
ContactWork collide(Particles& particles, PrimitiveWall& wall, const PreparedLaws<Law>& laws, double dt) {
  PrimitiveContacts& contacts = wall.contacts;
  ContactWork work;
  contacts.force.assign(contacts.size(), Vec3{});
  if constexpr (Law::rotates) contacts.couple.assign(contacts.size(), Vec3{});
  if constexpr (Law::memory > 0) {
    detail::requireStep(dt);
    const detail::EndedMemories ended = detail::carryMemory(contacts, Law::memory);
    detail::requireMaterials(particles, laws.materials);
    work += detail::bookEnded<Law>(particles, ended, laws, wall.material, dt);
  }
  work += detail::answerWall<Law>(particles, contacts, contacts.memory, laws, wall.material, dt, [&](std::size_t c) {
    const auto i = static_cast<std::size_t>(contacts.particle[c]);
    const Vec3 arm = (contacts.overlap[c] - particles.radius[i]) * contacts.normal[c];
    Vec3 velocity = particles.v[i] - velocityAt(wall, particles.x[i] + arm);
    if (Law::rotates && particles.rotates()) velocity += cross(particles.omega[i], arm);
    return velocity;
  });
  detail::addToParticles(particles, wall, Law::rotates && particles.rotates());
  return work;
}

}  // namespace dovetail::dem
