// Walls given by a formula: planes, cylinders, spheres.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "dovetail/dem/particles/particles.hpp"
#include "dovetail/dem/walls/wall_law.hpp"
#include "dovetail/dem/walls/wall_search.hpp"
#include "dovetail/dem/walls/wall_servo.hpp"

namespace dovetail::dem {

/// Contacts of one primitive wall, by particle; at most one for each.
struct PrimitiveContacts {
  std::vector<int> particle;
  std::vector<Vec3> normal;         ///< unit, from the wall to the particle
  std::vector<double> overlap;      ///< m, > 0; where the law reaches farther than touch down to −reach
  std::vector<Vec3> force, couple;  ///< on the particle, N, N m
  std::vector<double> energy;       ///< of the normal springs, J; if booked
  std::vector<double> sideEnergy;   ///< of those that the law remembers
  std::vector<double> memory;       ///< of the law, contact by contact
  WallMemoryKind memoryKind;        ///< PreparedLaws::wallMemoryKind
  /// Only where space repeats: which image of the particle touches; and the periods, m.
  std::vector<Image> image;
  Vec3 period;

  // Those of the last step.
  std::vector<int> oldParticle;
  std::vector<double> oldMemory;
  std::size_t size() const { return particle.size(); }
  /// What is to be added to the particle's position to have it next to the wall, m.
  Vec3 shift(std::size_t c) const { return image.empty() ? Vec3{} : shiftOf(image[c], period); }
};

/// The particles near a primitive wall, reused while neither they nor the wall have moved far.
struct PrimitiveSearch {
  std::vector<int> near;    ///< within radius + margin, ascending
  double margin = 0.0;      ///< the skin in use, m
  std::int64_t builds = 0;  ///< how often the list was made
  // What it was made from.
  std::int64_t particleRevision = -1;
  Vec3 point, axis;             ///< of the wall
  double radius = 0.0;          ///< of the wall, m
  double extent = 0.0;          ///< distance of the farthest particle from `point`, m
  double smallestRadius = 0.0;  ///< of all particles, m
  ParticleTravel travel;
  Vec3 lastPoint, lastAxis;  ///< of the wall when contacts were last found
};

/// A plane, or the inside or outside of an infinite cylinder or a sphere. It moves as a rigid body. It is unbounded: at
/// a corner it acts beside the other wall, as it should, but it cannot be joined to a mesh wall at a border. A mesh
/// wall that lies in it acts as well: where a plane is to have a patch of its own, make the plane a mesh wall too.
struct PrimitiveWall {
  enum class Shape { plane, cylinder, sphere };
  Shape shape = Shape::plane;
  Vec3 point;            ///< on the plane or the cylinder's axis, or the sphere's centre, m
  Vec3 axis{0, 0, 1};    ///< unit: normal of the plane, towards the particles, or axis of the cylinder
  double radius = 0.0;   ///< m
  bool inside = true;    ///< particles are inside the cylinder or sphere
  Vec3 velocity;         ///< of `point`, m/s
  Vec3 angularVelocity;  ///< about `point`, rad/s
  /// Of the surface over the wall, as of a belt, m/s: along the plane, or along the cylinder's axis. It turns with
  /// the wall, which it does not move.
  Vec3 surfaceVelocity;
  int material = 0;  ///< row of a LawTable
  /// Sets velocity and angularVelocity for the step that ends at `time`, s; empty: they stay. If it sets point or axis
  /// too, whence the wall drifts, the velocities are those at `time`.
  std::function<void(double time, PrimitiveWall& wall)> motion;
  std::optional<WallServo> servo;  ///< what moves it along the servo's direction, where `velocity` then follows
  /// m: particles closer than their radius + skin are candidates. Unset: 0.15 of their mean diameter; 0: all, at every
  /// step.
  std::optional<double> skin;

  double reach = 0.0;  ///< m: of the law beyond touch, see ContactLaws::reach; so far contacts are found

  PrimitiveContacts contacts;
  Vec3 force, torque;  ///< of the last sweep on the wall, N; about `point`, N m
  PrimitiveSearch search;
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

/// Velocity of the wall's surface at a place, m/s.
inline Vec3 velocityAt(const PrimitiveWall& wall, const Vec3& x) {
  return wall.velocity + wall.surfaceVelocity + cross(wall.angularVelocity, x - wall.point);
}
/// Half a step of the wall's servo, if it has one, with the force of the last sweep; before drift, and after the
/// forces.
void kickWall(PrimitiveWall& wall, double dt);
/// point += velocity dt; the axis and the surface velocity turn.
void drift(PrimitiveWall& wall, double dt);
/// Power that the wall puts into the particles, W, with the force and torque of the last sweep; without that of its
/// servo, which has its own account.
double drivingPower(const PrimitiveWall& wall);

/// Contacts as they are now. Particles are searched again when they and the wall may have used up the skin; the motion
/// of the wall is known from the wall itself, so moves.wall is not used.
/// @param periodicity  the particles': a wall is then repeated in every period, and has contact with the nearest image
/// of a particle
/// @throws InputError if the skin is not finite and ≥ 0, or the wall does not repeat with the periods (validate);
///         NumericalError if the wall is not at a finite place, or has moved past a particle by more than its radius
void findContacts(const Particles& particles, PrimitiveWall& wall, const Moves& moves,
                  const geometry::Periodicity& periodicity = {});

/// Whether the wall is one and the same in every period.
/// @param reach m; of the largest particle, radius + skin
/// @throws InputError: a plane whose normal, or a cylinder whose axis, is oblique to a period; a cylinder or sphere
/// that
///         does not fit into a period
void requireRepeats(const PrimitiveWall& wall, const geometry::Periodicity& periodicity, double reach);

/// Gives the wall's memory the new numbers of particles (< 0: removed). Returns the energy of the springs of removed
/// particles, J, for the caller to book.
double renumber(PrimitiveWall& wall, std::span<const int> newNumber);

inline WallFraction fractionOf(const PrimitiveContacts& contacts, std::size_t c) {
  return {contacts.overlap[c], 1.0, 1.0};
}

namespace detail {
/// Memories from the last step to this one; returns those whose contact has ended.
EndedMemories carryMemory(const Particles& particles, PrimitiveContacts& contacts, int memory,
                          const WallMemoryKind& kind);
/// Velocity of the particle relative to the wall at the contact, m/s.
Vec3 relativeVelocity(const Particles& particles, const PrimitiveWall& wall, std::size_t c, bool spins);
/// Adds the contact forces (and torques) to the particles, and their reactions up over the wall.
void addToParticles(Particles& particles, PrimitiveWall& wall, bool spins);

/// How a particle and the wall move at a contact.
struct AgainstPrimitive {
  const Particles& particles;
  const PrimitiveWall& wall;
  bool spins;
  Vec3 velocity(std::size_t c) const { return relativeVelocity(particles, wall, c, spins); }
  Vec3 spin(std::size_t) const { return wall.angularVelocity; }
};

/// ContactLaws::wall, with the law known.
template <class Law>
ContactWork collide(Particles& particles, PrimitiveWall& wall, const PreparedLaws<Law>& laws, double dt,
                    Booking booking) {
  PrimitiveContacts& contacts = wall.contacts;
  ContactWork work;
  contacts.force.resize(contacts.size());
  if constexpr (Law::rotates) contacts.couple.resize(contacts.size());
  if constexpr (Law::memory > 0) requireStep(dt);
  if (const int numbers = laws.wallNumbers(); numbers > 0) {
    const EndedMemories ended = carryMemory(particles, contacts, numbers, laws.wallMemoryKind());
    if (booking == Booking::on && dt > 0.0) work += bookEnded<Law>(ended, laws, wall.material, dt);
  } else {
    contacts.memory.clear();  // of a law that was there before
  }
  work += answerWall<Law>(particles, contacts, contacts.memory, laws, {.material = wall.material}, dt, booking,
                          AgainstPrimitive{particles, wall, Law::rotates && particles.rotates()});
  addToParticles(particles, wall, Law::rotates && particles.rotates());
  return work;
}

}  // namespace detail

}  // namespace dovetail::dem
