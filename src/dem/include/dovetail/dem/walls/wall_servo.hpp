// Walls with a prescribed force in place of a path: plates of a press, lids of an oedometer.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <type_traits>

#include "dovetail/core/vec3.hpp"
#include "dovetail/dem/walls/rigid_motion.hpp"

namespace dovetail::dem {

/// A wall of some mass that is free along one direction only, where a load pushes it against its contacts. At rest
/// their force balances the load. It is a body with one degree of freedom: particles + contacts + kineticEnergy + lost
/// − work is constant, as far as the particles' own dashpots and sliders lose nothing.
///
/// One that `turns` is free to turn about an axis only: its load is a torque, N m, and its mass a moment of inertia,
/// kg m²; damping N m s, speed rad/s, travel rad.
struct WallServo {
  Vec3 direction{0, 0, 1};  ///< unit, in space; of the axis
  bool turns = false;
  Vec3 point;         ///< on the axis, m
  double load = 0.0;  ///< N, on the wall along direction; may be changed between steps
  /// The load at a time, s, in its place; the caller sets `load` to that at the start.
  std::function<double(double time)> loadAt;
  double mass = 0.0;     ///< kg, > 0: larger = slower and smoother, smaller = a shorter step
  double damping = 0.0;  ///< N s/m, ≥ 0, against its speed; 2 √(mass × stiffness of what it presses) is critical
  /// Fraction of the unbalanced force that acts against the motion, 0 ≤ α < 1 (Cundall 1987): damps whatever the
  /// stiffness, and does nothing at rest.
  double localDamping = 0.0;
  double fastest = std::numeric_limits<double>::infinity();  ///< m/s: what the load would give beyond is lost

  double speed = 0.0;    ///< m/s, along direction
  double travel = 0.0;   ///< m, so far
  double contact = 0.0;  ///< N, force of the last contacts on the wall along direction
  double work = 0.0;     ///< J, done by the load so far
  double lost = 0.0;     ///< J, lost in the damping and at the fastest speed so far

  double kineticEnergy() const { return 0.5 * mass * speed * speed; }
  /// Sum of all forces along direction, without damping, N: 0 when the load is carried.
  double unbalanced() const { return load + contact; }
  /// m/s and rad/s of a point of the wall.
  Vec3 velocityAt(const Vec3& x) const { return speed * (turns ? cross(direction, x - point) : direction); }
  Vec3 spin() const { return turns ? speed * direction : Vec3{}; }
  /// m, from the axis.
  double leverOf(const Vec3& x) const { return norm(cross(direction, x - point)); }
  /// How far the wall has come from where it lay at travel 0: its x is the place of the origin, or of `point`.
  RigidMotion pose() const;
  /// 1/kg of the wall at its contacts, for the limit of the step. @param lever m, the largest, if it turns
  double inverseMass(double lever) const;
};

template <class Archive, class Servo>
void archiveFields(Archive& archive, Servo& s) requires std::is_same_v<std::remove_const_t<Servo>, WallServo> {
  archive(s.direction, s.turns, s.point, s.load, s.mass, s.damping, s.localDamping, s.fastest, s.speed, s.travel,
          s.contact, s.work, s.lost);
}

/// @throws InputError: a direction without length, a load that is not finite, mass not > 0, damping not ≥ 0
WallServo makeServo(const Vec3& direction, double load, double mass, double damping = 0.0);
/// @throws InputError as makeServo; localDamping not within [0, 1), fastest not > 0, a point that is not finite
void validate(const WallServo& servo);

/// The force of the last contacts, as one that turns feels it.
/// @param force N @param moment N m, about `about`, m
void takeContact(WallServo& servo, const Vec3& force, const Vec3& moment, const Vec3& about);
/// Sets the load of a time, s.
void setLoad(WallServo& servo, double time);

/// speed += dt × force / mass; half a step each before the drift and after the forces, as for particles.
void kickServo(WallServo& servo, double dt);
/// travel += speed dt. Returns the displacement, m, of one that does not turn.
Vec3 driftServo(WallServo& servo, double dt);

}  // namespace dovetail::dem
