// Preparation of cells.
#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/rve/equilibrium.hpp"

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

/// Largest relative distance of the pressures from those wanted.
double pressureOff(const Rve& cell, const Vec3& wanted) {
  const Eigen::Matrix3d now = stress(cell).cauchy;
  double most = 0.0;
  for (int k = 0; k < cell.dimension(); ++k) most = std::max(most, std::abs(-now(k, k) / wanted[k] - 1.0));
  return most;
}

/// k_n, N/m, of mean grains that press each other with the force of a pressure on their section.
double meanSlope(const Rve& cell, double pressure) {
  const double d = meanDiameter(cell), k = normalStiffness(cell.springs, 0.5 * d, 0.5 * d);
  return slopeAt(cell.springs, k, std::pow(1.5 * pressure * d * d / k, 2.0 / 3.0));
}

/// Strain of one step: in proportion to what is missing, no faster than the inertial number allows.
Eigen::Matrix3d servoStep(const Rve& cell, const CompressionOptions& settings, double dt) {
  const double d = meanDiameter(cell), k = meanSlope(cell, settings.pressure.x);
  const double stiffness = k / (cell.shape == Shape::disc ? norm(cell.state.lattice.period[2]) : d);
  const double mean = stress(cell).pressure, least = 1e-2 * settings.pressure.x;
  const double fastest = settings.inertialNumber * std::sqrt(std::max(mean, least) / cell.density) / d * dt;
  // A wave crosses the cell in some ten steps a grain; answers that are slower than that do not overshoot.
  const double lag = 20.0 * std::pow(static_cast<double>(cell.size()), 1.0 / cell.dimension());
  const Eigen::Matrix3d now = stress(cell).cauchy;
  Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
  for (int a = 0; a < cell.dimension(); ++a)
    G(a, a) -= std::clamp((settings.pressure[a] + now(a, a)) / (stiffness * lag), -fastest, fastest);
  return G;
}

void makeReference(Rve& cell) {
  cell.state.F.setIdentity();
  cell.volume = volume(cell);
  cell.state.ledger = {};
}

}  // namespace

namespace {

/// Strains the cell until the pressures are those wanted, at rest.
/// @param taken  steps, so far and on return
void press(Rve& cell, const CompressionOptions& settings, std::int64_t& taken) {
  for (bool there = false; !there;) {
    int quiet = 0;
    for (; quiet < 200 && taken < settings.steps; ++taken) {
      const double dt = settings.stepFraction * cell.state.criticalStep;
      step(cell, dt, servoStep(cell, settings, dt), settings.damping);
      quiet = pressureOff(cell, settings.pressure) <= 0.5 * settings.tolerance ? quiet + 1 : 0;
    }
    const RestReport rest = relax(cell, settings.rest, settings.stepFraction);
    taken += std::max<std::int64_t>(rest.steps, 1);
    const double off = pressureOff(cell, settings.pressure);
    there = rest.atRest && off <= settings.tolerance;
    if (!there && taken >= settings.steps)
      throw NumericalError(
          "pressures are off by " + formatNumber(off) + " of those wanted, forces by " + formatNumber(rest.residual),
          "compression of a cell", "take more steps, or larger tolerances");
  }
}

}  // namespace

void compress(Rve& cell, const CompressionOptions& settings) {
  check(cell, settings);
  const Springs own = cell.springs;
  Springs preparing = own;
  preparing.friction = settings.friction;
  setSprings(cell, preparing);
  std::int64_t taken = 0;
  press(cell, settings, taken);
  setSprings(cell, own);
  // With less friction contacts may slip now.
  if (!(balance(cell).unbalanced <= settings.rest.tolerance &&
        pressureOff(cell, settings.pressure) <= settings.tolerance))
    press(cell, settings, taken);
  makeReference(cell);
}

}  // namespace dovetail::rve
