#include "dovetail/dem/walls/wall_servo.hpp"

#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::dem {

WallServo makeServo(const Vec3& direction, double load, double mass, double damping) {
  const double length = norm(direction);
  if (!(length > 0.0) || !std::isfinite(length))
    throw InputError("the vector has no direction", "direction of a servo wall",
                     "give three finite numbers that are not all zero");
  if (!std::isfinite(load)) throw InputError("not finite", "load of a servo wall", "give a force, N");
  WallServo servo;
  servo.direction = direction / length;
  servo.load = load;
  servo.mass = requirePositive(mass, "mass of a servo wall");
  servo.damping = requireNonNegative(damping, "damping of a servo wall");
  return servo;
}

/// The dashpot acts with the speed at the end, which is stable for any damping.
void kickServo(WallServo& servo, double dt) {
  const double before = servo.speed, rate = dt / servo.mass;
  servo.speed = (before + rate * servo.unbalanced()) / (1.0 + rate * servo.damping);
  const double mean = 0.5 * (before + servo.speed);
  servo.work += dt * servo.load * mean;
  servo.lost += dt * servo.damping * servo.speed * mean;
}

Vec3 driftServo(WallServo& servo, double dt) {
  servo.travel += dt * servo.speed;
  return dt * servo.speed * servo.direction;
}

}  // namespace dovetail::dem
