// Strains that give way to stresses: what holds stresses in preparations and in tests.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "dovetail/core/rest.hpp"
#include "dovetail/rve/rve.hpp"

namespace dovetail::rve {

/// Lag, in steps, that cells whose grains touch do not overshoot by: they answer at once.
constexpr double leastLag = 10.0;

struct Servo {
  Eigen::Matrix3d stress;        ///< Cauchy, wanted, Pa; NaN where none is held
  double pressure = 0.0;         ///< of mean contacts, by which stiffness and speed are told, > 0, Pa
  double lag = 1.0;              ///< steps in which what is missing would be made good
  double inertialNumber = 1e-2;  ///< of the fastest strain
  double tolerance = 1e-3;       ///< of the stresses, relative
  double damping = 0.7, stepFraction = 0.8;
  std::optional<RestCriterion> rest = {};  ///< none: the cell is left in motion
  std::int64_t quiet = 200;                ///< steps for which stresses are to be within half the tolerance
  std::int64_t steps = 1000000;            ///< given up after so many
  const char* where = "servo";             ///< for messages
};

/// Largest relative distance of the stresses from those that are held; of such as should be 0 over the largest of them,
/// or the pressure.
double stressOff(const Rve& cell, const Servo& servo);

/// Strain of a step that goes with an inertial number.
double strainOfStep(const Rve& cell, const Servo& servo, double inertialNumber, double dt);

/// Strain of a step in the components whose stress is held, in proportion to what is missing, no faster than the
/// inertial number allows; 0 in the others.
Eigen::Matrix3d servoStrain(const Rve& cell, const Servo& servo, double dt);

/// Strains the cell until the stresses are those wanted, at rest. What stays missing is made good ever faster, down to
/// the least lag.
/// @param taken  steps, so far and on return
/// @throws NumericalError if it gives up, or as step
void holdStress(Rve& cell, const Servo& servo, std::int64_t& taken);

}  // namespace dovetail::rve
