#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/rve/equilibrium.hpp"

namespace dovetail::rve {

namespace {

constexpr const char* where = "path of a cell";

void check(const Rve& cell, const Eigen::Matrix3d& F, const PathOptions& settings) {
  validate(settings.rest, where);
  if (!(settings.inertialNumber > 0.0 && settings.inertialNumber <= 1e-2))
    throw InputError("the inertial number is " + formatNumber(settings.inertialNumber), where,
                     "give one above 0, of at most 0.01: faster is not quasi-static");
  requireFraction(settings.damping, "damping", where, true);
  requireFraction(settings.stepFraction, "the fraction of the critical step", where);
  if (!F.allFinite() || !(F.determinant() > 0.0))
    throw InputError("the determinant of F is " + formatNumber(F.determinant()), where,
                     "give an F that is finite and "
                     "turns nothing inside out");
  const Eigen::Matrix3d G = relativeDeformation(cell, F) - Eigen::Matrix3d::Identity();
  const double strain = (0.5 * (G + G.transpose())).norm();
  if (!(strain <= 0.05))
    throw InputError("F is a strain of " + formatNumber(strain) + " away", where,
                     "approach it in steps of at most 0.05");
}

/// Pressures below which durations are no longer told by the stress.
double leastPressure(const Rve& cell) {
  const double r = 0.5 * meanDiameter(cell), k = slopeAt(cell.springs, normalStiffness(cell.springs, r, r), 1e-4 * r);
  return 1e-6 * k / (cell.shape == Shape::disc ? norm(cell.state.lattice.period[2]) : 2.0 * r);
}

double duration(const Rve& cell, const Eigen::Matrix3d& F, double inertialNumber) {
  const Eigen::Matrix3d G = relativeDeformation(cell, F) - Eigen::Matrix3d::Identity();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(0.5 * (G + G.transpose()), Eigen::EigenvaluesOnly);
  const Eigen::Vector3d& e = solver.eigenvalues();
  const double gamma = std::max({e[2] - e[0], std::abs(e[0]), std::abs(e[2])});
  const double pressure = std::max(stress(cell).pressure, leastPressure(cell));
  return gamma * meanDiameter(cell) / (inertialNumber * std::sqrt(pressure / cell.density));
}

}  // namespace

PathReport followPath(Rve& cell, const Eigen::Matrix3d& F, const PathOptions& settings) {
  check(cell, F, settings);
  PathReport report;
  const Eigen::Matrix3d start = cell.state.F;
  const double whole = duration(cell, F, settings.inertialNumber), workBefore = cell.state.ledger.work;
  double done = 0.0;
  while (done < 1.0) {
    // Equal steps, unless new contacts ask for shorter ones.
    const double left = (1.0 - done) * whole, longest = settings.stepFraction * cell.state.criticalStep;
    const double steps = std::max(1.0, std::ceil(left / longest * (1.0 - 1e-12)));
    const double dt = whole > 0.0 ? left / steps : longest;
    done = steps > 1.0 ? done + dt / whole : 1.0;
    const Eigen::Matrix3d next = start + done * (F - start);
    step(cell, dt, relativeDeformation(cell, next), settings.damping);
    ++report.steps;
  }
  const double work = cell.state.ledger.work - workBefore;
  report.kineticFraction = work != 0.0 ? kineticEnergy(cell) / std::abs(work) : 0.0;
  if (settings.rest.steps > 0) report.rest = relax(cell, settings.rest);
  return report;
}

}  // namespace dovetail::rve
