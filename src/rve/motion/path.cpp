#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/rve/deformation_path.hpp"
#include "dovetail/rve/equilibrium.hpp"

namespace dovetail::rve {

namespace {

constexpr const char* where = "path of a cell";

void check(const PathOptions& settings) {
  validate(settings.rest, where);
  if (!(settings.inertialNumber > 0.0 && settings.inertialNumber <= 1e-2))
    throw InputError("the inertial number is " + formatNumber(settings.inertialNumber), where,
                     "give one above 0, of at most 0.01: faster is not quasi-static");
  requireFraction(settings.damping, "damping", where, true);
  requireFraction(settings.stepFraction, "the fraction of the critical step", where);
}

DeformationPath pathTo(const Rve& cell, const Eigen::Matrix3d& F) {
  const DeformationPath path(cell, F);
  if (!(path.strain() <= 0.05))
    throw InputError("F is a strain of " + formatNumber(path.strain()) + " away", where,
                     "approach it in steps of at most 0.05");
  return path;
}

/// Pressures below which durations are no longer told by the stress.
double leastPressure(const Rve& cell) {
  const double r = 0.5 * meanDiameter(cell), k = slopeAt(cell.springs, normalStiffness(cell.springs, r, r), 1e-4 * r);
  return 1e-6 * k / (cell.shape == Shape::disc ? norm(cell.state.lattice.period[2]) : 2.0 * r);
}

double duration(const Rve& cell, const Eigen::Vector3d& strains, double inertialNumber) {
  const double gamma = std::max({strains[2] - strains[0], std::abs(strains[0]), std::abs(strains[2])});
  const double pressure = std::max(stress(cell).pressure, leastPressure(cell));
  return gamma * meanDiameter(cell) / (inertialNumber * std::sqrt(pressure / cell.density));
}

}  // namespace

PathReport followPath(Rve& cell, const Eigen::Matrix3d& F, const PathOptions& settings) {
  check(settings);
  const DeformationPath path = pathTo(cell, F);
  PathReport report;
  const double whole = duration(cell, path.strains(), settings.inertialNumber), workBefore = cell.state.ledger.work;
  if (whole == 0.0) deform(cell, relativeDeformation(cell, F));  // a turn takes no time
  for (double done = whole > 0.0 ? 0.0 : 1.0; done < 1.0;) {
    // Equal steps, unless new contacts ask for shorter ones.
    const double left = (1.0 - done) * whole, longest = settings.stepFraction * cell.state.criticalStep;
    const double steps = std::max(1.0, std::ceil(left / longest * (1.0 - 1e-12))), dt = left / steps;
    done = steps > 1.0 ? done + dt / whole : 1.0;
    step(cell, dt, relativeDeformation(cell, path.at(done)), settings.damping);
    ++report.steps;
  }
  const double work = cell.state.ledger.work - workBefore;
  report.kineticFraction = work != 0.0 ? kineticEnergy(cell) / std::abs(work) : 0.0;
  if (settings.rest.steps > 0) report.rest = relax(cell, settings.rest);
  return report;
}

}  // namespace dovetail::rve
