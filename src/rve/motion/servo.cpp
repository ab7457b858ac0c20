#include "servo.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/rve/equilibrium.hpp"

namespace dovetail::rve {

namespace {

/// k_n, N/m, of mean grains that press each other with the force of a pressure on their section.
double meanSlope(const Rve& cell, double pressure) {
  const double d = meanDiameter(cell), k = normalStiffness(cell.springs, 0.5 * d, 0.5 * d);
  return slopeAt(cell.springs, k, std::pow(1.5 * pressure * d * d / k, 2.0 / 3.0));
}

}  // namespace

double stressOff(const Rve& cell, const Servo& servo) {
  const Eigen::Matrix3d now = stress(cell).cauchy;
  double most = 0.0;
  for (int i = 0; i < cell.dimension(); ++i)
    for (int j = 0; j < cell.dimension(); ++j) {
      const double wanted = servo.stress(i, j);
      if (wanted == 0.0)
        most = std::max(most, std::abs(now(i, j)) / servo.pressure);
      else if (!std::isnan(wanted))
        most = std::max(most, std::abs(now(i, j) / wanted - 1.0));
    }
  return most;
}

double strainOfStep(const Rve& cell, const Servo& servo, double inertialNumber, double dt) {
  const double mean = stress(cell).pressure, least = 1e-2 * servo.pressure;
  return inertialNumber * std::sqrt(std::max(mean, least) / cell.density) / meanDiameter(cell) * dt;
}

Eigen::Matrix3d servoStrain(const Rve& cell, const Servo& servo, double dt) {
  const double d = meanDiameter(cell), k = meanSlope(cell, servo.pressure);
  const double stiffness = k / (cell.shape == Shape::disc ? norm(cell.state.lattice.period[2]) : d);
  const double fastest = strainOfStep(cell, servo, servo.inertialNumber, dt);
  const Eigen::Matrix3d now = stress(cell).cauchy;
  Eigen::Matrix3d strain = Eigen::Matrix3d::Zero();
  for (int i = 0; i < cell.dimension(); ++i)
    for (int j = 0; j < cell.dimension(); ++j)
      if (const double wanted = servo.stress(i, j); !std::isnan(wanted))
        strain(i, j) = std::clamp((wanted - now(i, j)) / (stiffness * servo.lag), -fastest, fastest);
  return strain;
}

void holdStress(Rve& cell, const Servo& servo, std::int64_t& taken) {
  const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
  for (bool there = false; !there;) {
    std::int64_t quiet = 0;
    for (; quiet < servo.quiet && taken < servo.steps; ++taken) {
      const double dt = servo.stepFraction * cell.state.criticalStep;
      step(cell, dt, one + servoStrain(cell, servo, dt), servo.damping);
      quiet = stressOff(cell, servo) <= 0.5 * servo.tolerance ? quiet + 1 : 0;
    }
    RestReport rest{.atRest = true};
    if (servo.rest) {
      rest = relax(cell, *servo.rest, servo.stepFraction);
      taken += std::max<std::int64_t>(rest.steps, 1);
    }
    const double off = stressOff(cell, servo);
    there = rest.atRest && off <= servo.tolerance;
    if (!there && taken >= servo.steps)
      throw NumericalError(
          "stresses are off by " + formatNumber(off) + " of those wanted, forces by " + formatNumber(rest.residual),
          servo.where, "take more steps, or larger tolerances");
  }
}

}  // namespace dovetail::rve
