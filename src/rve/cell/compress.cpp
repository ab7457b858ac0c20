// Preparation of cells.
#include <cmath>
#include <limits>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/rve/equilibrium.hpp"
#include "motion/servo.hpp"

namespace dovetail::rve {

namespace {

void check(const Rve& cell, const CompressionOptions& settings) {
  validate(settings.rest, "rest of a cell");
  if (!cell.frame.empty()) throw InputError("the cell has a frame", "compression of a cell", "give a periodic cell");
  for (int k = 0; k < cell.dimension(); ++k) requirePositive(settings.pressure[k], "pressure");
  requirePositive(settings.tolerance, "tolerance of the pressures");
  requirePositive(settings.inertialNumber, "inertial number");
  requireFraction(settings.damping, "damping", "compression of a cell", true);
}

Servo servoFor(const Rve& cell, const CompressionOptions& settings) {
  Servo servo{.stress = Eigen::Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN()),
              .pressure = settings.pressure.x,
              // A wave crosses the cell in some ten steps a grain; answers that are slower than that do not overshoot.
              // The servo grows faster where the cell is softer.
              .lag = 20.0 * std::pow(static_cast<double>(cell.size()), 1.0 / cell.dimension()),
              .inertialNumber = settings.inertialNumber,
              .tolerance = settings.tolerance,
              .damping = settings.damping,
              .stepFraction = settings.stepFraction,
              .rest = settings.rest,
              .steps = settings.steps,
              .where = "compression of a cell"};
  for (int k = 0; k < cell.dimension(); ++k) servo.stress(k, k) = -settings.pressure[k];
  return servo;
}

void makeReference(Rve& cell) {
  cell.state.F.setIdentity();
  cell.volume = volume(cell);
  cell.state.ledger = {};
}

}  // namespace

void compress(Rve& cell, const CompressionOptions& settings) {
  check(cell, settings);
  const Servo servo = servoFor(cell, settings);
  const Springs own = cell.springs;
  Springs preparing = own;
  preparing.friction = settings.friction;
  setSprings(cell, preparing);
  std::int64_t taken = 0;
  holdStress(cell, servo, taken);
  setSprings(cell, own);
  // With less friction contacts may slip now.
  if (!(balance(cell).unbalanced <= settings.rest.tolerance && stressOff(cell, servo) <= settings.tolerance))
    holdStress(cell, servo, taken);
  makeReference(cell);
}

}  // namespace dovetail::rve
