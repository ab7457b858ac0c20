#include "dovetail/dem/walls/wall_servo.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::dem {

RigidMotion WallServo::pose() const {
  if (!turns) return {travel * direction, {}, speed * direction, {}};
  return {point, fromRotationVector(travel * direction), {}, speed * direction};
}

double WallServo::inverseMass(double lever) const {
  return (1.0 + localDamping) / mass * (turns ? lever * lever : 1.0);
}

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

void validate(const WallServo& servo) {
  makeServo(servo.direction, servo.load, servo.mass, servo.damping);
  if (!(servo.localDamping >= 0.0 && servo.localDamping < 1.0))
    throw InputError("the local damping is " + formatNumber(servo.localDamping), "servo wall",
                     "give 0 ≤ α < 1, such as 0.7");
  if (!(servo.fastest > 0.0))
    throw InputError("its fastest speed is " + formatNumber(servo.fastest), "servo wall", "give one above 0");
  if (!isFinite(servo.point))
    throw InputError("not a finite vector", "point of a servo wall", "give three finite numbers");
}

void takeContact(WallServo& servo, const Vec3& force, const Vec3& moment, const Vec3& about) {
  servo.contact = dot(servo.turns ? moment + cross(about - servo.point, force) : force, servo.direction);
}

void setLoad(WallServo& servo, double time) {
  if (!servo.loadAt) return;
  servo.load = servo.loadAt(time);
  if (!std::isfinite(servo.load))
    throw NumericalError("its load is not finite at t = " + formatNumber(time) + " s", "servo wall",
                         "give an expression that is finite at all times");
}

/// The dashpot acts with the speed at the end, which is stable for any damping.
void kickServo(WallServo& servo, double dt) {
  const double before = servo.speed, rate = dt / servo.mass, force = servo.unbalanced();
  const double against = before == 0.0 ? 0.0 : std::copysign(servo.localDamping * std::abs(force), before);
  const double wanted = (before + rate * (force - against)) / (1.0 + rate * servo.damping);
  servo.speed = std::clamp(wanted, -servo.fastest, servo.fastest);
  const double mean = 0.5 * (before + servo.speed);
  servo.work += dt * servo.load * mean;
  servo.lost += (dt * (against + servo.damping * wanted) + servo.mass * (wanted - servo.speed)) * mean;
}

Vec3 driftServo(WallServo& servo, double dt) {
  servo.travel += dt * servo.speed;
  return servo.turns ? Vec3{} : dt * servo.speed * servo.direction;
}

}  // namespace dovetail::dem
