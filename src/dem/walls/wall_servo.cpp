#include "dovetail/dem/walls/wall_servo.hpp"

#include <cmath>
#include <numeric>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/model/contact_step.hpp"

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

DemandBefore demandBefore(const ContactDemand& demand) {
  return {demand.links.size(), std::accumulate(demand.stiffness.begin(), demand.stiffness.end(), 0.0),
          std::accumulate(demand.damping.begin(), demand.damping.end(), 0.0)};
}

void addServoDemand(ContactDemand& demand, const WallServo& servo, const DemandBefore& before) {
  const DemandBefore now = demandBefore(demand);
  for (std::size_t k = before.links; k < demand.links.size(); ++k) {
    demand.links[k].wallStiff = (now.stiffness - before.stiffness) / servo.mass;
    demand.links[k].wallDamped = (now.damping - before.damping) / servo.mass;
  }
}

}  // namespace dovetail::dem
