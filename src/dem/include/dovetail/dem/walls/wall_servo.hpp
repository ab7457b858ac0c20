// Walls with a prescribed force in place of a path: plates of a press, lids of an oedometer.
#pragma once

#include <cstddef>

#include "dovetail/core/vec3.hpp"

namespace dovetail::dem {

/// A wall of some mass that is free along one direction only, where a load pushes it against its contacts. At rest
/// their force balances the load. It is a body with one degree of freedom: particles + contacts + kineticEnergy + lost
/// − work is constant, as far as the particles' own dashpots and sliders lose nothing.
struct WallServo {
  Vec3 direction{0, 0, 1};  ///< unit, in space
  double load = 0.0;        ///< N, on the wall along direction; may be changed between steps
  double mass = 0.0;        ///< kg, > 0: larger = slower and smoother, smaller = a shorter step
  double damping = 0.0;  ///< N s/m, ≥ 0, against its speed; 2 √(mass × stiffness of what it presses) is critical

  double speed = 0.0;    ///< m/s, along direction
  double travel = 0.0;   ///< m, so far
  double contact = 0.0;  ///< N, force of the last contacts on the wall along direction
  double work = 0.0;     ///< J, done by the load so far
  double lost = 0.0;     ///< J, lost in the damping so far

  double kineticEnergy() const { return 0.5 * mass * speed * speed; }
  /// Sum of all forces along direction, without damping, N: 0 when the load is carried.
  double unbalanced() const { return load + contact; }
};

/// @throws InputError: a direction without length, a load that is not finite, mass not > 0, damping not ≥ 0
WallServo makeServo(const Vec3& direction, double load, double mass, double damping = 0.0);

/// speed += dt × force / mass; half a step each before the drift and after the forces, as for particles.
void kickServo(WallServo& servo, double dt);
/// travel += speed dt. Returns the displacement, m.
Vec3 driftServo(WallServo& servo, double dt);

}  // namespace dovetail::dem
