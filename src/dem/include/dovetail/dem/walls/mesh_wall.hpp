// A triangulated wall of a scene: its motion, its candidates and its contacts.
#pragma once

#include <limits>
#include <variant>
#include <vector>

#include "dovetail/dem/walls/rigid_wall.hpp"
#include "dovetail/dem/walls/wall.hpp"
#include "dovetail/dem/walls/wall_candidates.hpp"
#include "dovetail/dem/walls/wall_contacts.hpp"
#include "dovetail/dem/walls/wall_servo.hpp"

namespace dovetail::dem {

struct AtRest {};

/// wall.x and wall.v are written from outside, such as by the owner of a solid whose skin the wall is, with the
/// distance that vertices have moved since contacts were last found.
struct MovedByOthers {
  /// Bound on the displacement of any vertex, m; findContacts takes it away, so that none is forgotten.
  double travel = std::numeric_limits<double>::quiet_NaN();
};

/// What moves a wall. All but MovedByOthers keep its shape.
using WallMotion = std::variant<AtRest, PrescribedMotion, WallOnBody, WallServo, MovedByOthers>;

/// A triangulated wall with its contacts.
struct MeshWall {
  TriangulatedWall wall;
  WallMotion motion;         ///< at rest, unless set
  std::vector<Vec3> offset;  ///< with a PrescribedMotion or a WallServo: see prescribe
  /// Of the surface over the wall, as of a belt, m/s, in the frame of the vertices' offsets. It does not move them,
  /// only adds to wall.v; take one along the facets. Of no concern to a wall moved by others.
  Vec3 surfaceVelocity;
  EdgeRule rule = EdgeRule::projected;
  WallCandidates candidates;  ///< candidates.skin is the caller's to set
  WallContacts contacts;
  double step = 0.0;         ///< bound on how far any vertex has moved since contacts were last found, m
  Vec3 belt;                 ///< surfaceVelocity as it is now, m/s
  std::size_t lookedAt = 0;  ///< vertices of a wall at rest are checked in turn
};

/// Gives the wall a motion: `reference` is the point, in the wall as it lies now, that the motion's x is the place of,
/// and the turn counts from how it lies now. So a motion that starts at x = reference with turn 1 starts from here.
void prescribe(MeshWall& mesh, PrescribedMotion motion, const Vec3& reference);

/// The same for a servo, which moves the wall from where it lies now.
void prescribe(MeshWall& mesh, const WallServo& servo);

/// Half a step of the wall's servo, if it has one, with the vertex forces as they are; before moveWall, and after the
/// forces.
void kickWall(MeshWall& mesh, double dt);
/// Places the wall by its motion at the end of a step, or by its body; sets the vertices' velocities. After bodies have
/// moved, and once more, with dt = 0, after velocities of bodies and servos have changed.
/// @param time at the end of the step, s @param dt of the step, s
/// @param bodies  those that WallOnBody names one of; else unused
/// @throws InputError if the wall is on a body and there is none, or a prescribed motion is empty or has no offsets
void moveWall(MeshWall& mesh, double time, double dt, const Bodies* bodies = nullptr);

/// Candidates and contacts as they are now, and vertex forces zero.
/// @param moves  of the particles; those of the wall are known here
/// @throws InputError if the wall was moved without notice; NumericalError naming a particle that the wall has moved
/// past by more than its radius since the last call
void findContacts(const Particles& particles, MeshWall& mesh, const Moves& moves,
                  const geometry::Periodicity& periodicity = {});

/// Contact forces on to the vertices, and from there to the body, if the wall is on one.
/// @throws InputError if the wall is on a body and there is none
void gatherForces(MeshWall& mesh, Bodies* bodies = nullptr);

/// Power that the wall puts into the particles, W, with the forces of the last sweep; of a wall on a body or a servo
/// only what its surface velocity does, as the rest is theirs.
double drivingPower(const MeshWall& mesh);

}  // namespace dovetail::dem
