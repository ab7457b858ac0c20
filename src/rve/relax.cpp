#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/setup/fire.hpp"
#include "dovetail/rve/equilibrium.hpp"
#include "projection.hpp"
#include "rest_settings.hpp"

namespace dovetail::rve {

void validate(const RestSettings& settings) {
  requirePositive(settings.unbalanced, "unbalanced share of forces");
  if (!(settings.stepShare > 0.0 && settings.stepShare < 1.0))
    throw InputError("the share of the critical step is " + formatNumber(settings.stepShare), "rest of a cell",
                     "give one above 0 and below 1");
}

namespace {

constexpr std::int64_t lookEvery = 10;

/// Accelerations that the conditions of the frame leave.
struct Accelerations {
  Components linear, angular;

  void find(const Cell& cell) {
    divide(cell.state.force, cell.mass, linear);
    divide(cell.state.torque, cell.inertia, angular);
    project(cell, linear, angular);
  }

private:
  static void divide(const Components& forces, const std::vector<double>& by, Components& result) {
    for (std::size_t k = 0; k < 3; ++k) {
      result[k].resize(forces[k].size());
      for (std::size_t i = 0; i < forces[k].size(); ++i) result[k][i] = forces[k][i] / by[i];
    }
  }
};

void addSums(const Components& v, const Components& a, const std::vector<double>& mass, dem::FireSums& sums) {
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < v[k].size(); ++i)
      sums += {mass[i] * a[k][i] * v[k][i], mass[i] * v[k][i] * v[k][i], mass[i] * a[k][i] * a[k][i]};
}

void lean(Components& v, const Components& a, const dem::FireMix& mix) {
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < v[k].size(); ++i) v[k][i] = mix.keep * v[k][i] + mix.lean * a[k][i];
}

}  // namespace

RestReport relax(Cell& cell, const RestSettings& settings) {
  validate(settings);
  CellState& s = cell.state;
  stop(cell);
  dem::Fire fire(settings.stepShare * s.criticalStep);
  Accelerations accelerations;
  RestReport report;
  for (;; ++report.steps) {
    if (report.steps % lookEvery == 0 || report.steps >= settings.steps) {
      report.unbalanced = balance(cell).unbalanced;
      report.atRest = report.unbalanced <= settings.unbalanced;
      if (report.atRest || report.steps >= settings.steps) break;
      fire.setLongest(settings.stepShare * s.criticalStep);
    }
    accelerations.find(cell);
    dem::FireSums sums;
    addSums(s.v, accelerations.linear, cell.mass, sums);
    addSums(s.spin, accelerations.angular, cell.inertia, sums);
    const dem::FireMix mix = fire.next(sums);
    lean(s.v, accelerations.linear, mix);
    lean(s.spin, accelerations.angular, mix);
    s.book.damping += 0.5 * sums.speed - kineticEnergy(cell);
    step(cell, fire.dt());
  }
  stop(cell);
  return report;
}

}  // namespace dovetail::rve
