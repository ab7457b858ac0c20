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

/// What is missing of the stresses that are held, Pa; 0 of the others.
Eigen::Matrix3d missing(const Rve& cell, const Servo& servo) {
  const Eigen::Matrix3d now = stress(cell).cauchy;
  Eigen::Matrix3d rest = Eigen::Matrix3d::Zero();
  for (int i = 0; i < cell.dimension(); ++i)
    for (int j = 0; j < cell.dimension(); ++j)
      if (const double wanted = servo.stress(i, j); !std::isnan(wanted)) rest(i, j) = wanted - now(i, j);
  return rest;
}

/// Strain of a step in proportion to what is missing, no faster than the inertial number allows.
Eigen::Matrix3d strainFor(const Rve& cell, const Servo& servo, const Eigen::Matrix3d& rest, double dt) {
  const double d = meanDiameter(cell), k = meanSlope(cell, servo.pressure);
  const double stiffness = k / (cell.shape == Shape::disc ? norm(cell.state.lattice.period[2]) : d);
  const double fastest = strainOfStep(cell, servo, servo.inertialNumber, dt);
  return (rest / (stiffness * servo.lag)).cwiseMin(fastest).cwiseMax(-fastest);
}

/// Grows while what is missing keeps its sign, for cells that are softer than k_n: those whose grains do not touch yet,
/// and those with few contacts, which yield in shear. Falls back where the sign changes.
class Gain {
public:
  double of(const Eigen::Matrix3d& part, double lag) {
    const bool kept = part.cwiseProduct(before_).sum() >= 0.0;
    now_ = kept ? std::min(now_ * (1.0 + growth / lag), std::max(1.0, lag / leastLag)) : std::max(1.0, fall * now_);
    before_ = part;
    return now_;
  }

private:
  static constexpr double growth = 0.5;  // in a lag
  static constexpr double fall = 0.125;
  double now_ = 1.0;
  Eigen::Matrix3d before_ = Eigen::Matrix3d::Zero();
};

/// What is missing times the gains, of its mean and of the rest, for which cells have other stiffnesses.
class Gains {
public:
  Eigen::Matrix3d times(const Eigen::Matrix3d& rest, const Servo& servo) {
    const Eigen::Vector3d held = (!servo.stress.diagonal().array().isNaN()).cast<double>();
    const Eigen::Matrix3d mean = (rest.trace() / std::max(1.0, held.sum()) * held).asDiagonal();
    const double ofMean = mean_.of(mean, servo.lag), ofOther = other_.of(rest - mean, servo.lag);
    return ofOther * rest + (ofMean - ofOther) * mean;
  }

private:
  Gain mean_, other_;
};

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
  return strainFor(cell, servo, missing(cell, servo), dt);
}

void holdStress(Rve& cell, const Servo& servo, std::int64_t& taken) {
  const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
  Gains gains;
  for (bool there = false; !there;) {
    std::int64_t quiet = 0;
    for (; quiet < servo.quiet && taken < servo.steps; ++taken) {
      const double dt = servo.stepFraction * cell.state.criticalStep;
      step(cell, dt, one + strainFor(cell, servo, gains.times(missing(cell, servo), servo), dt), servo.damping);
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
