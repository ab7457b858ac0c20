#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/setup/fire.hpp"
#include "dovetail/rve/equilibrium.hpp"
#include "projection.hpp"

namespace dovetail::rve {

namespace {

constexpr std::int64_t lookEvery = 10;

void addSums(const Components& v, const Components& force, const std::vector<double>& mass, dem::FireSums& sums) {
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < v[k].size(); ++i)
      sums += {force[k][i] * v[k][i], mass[i] * v[k][i] * v[k][i], force[k][i] * force[k][i] / mass[i]};
}

void lean(Components& v, const Components& force, const std::vector<double>& mass, const dem::FireMix& mix) {
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < v[k].size(); ++i) v[k][i] = mix.keep * v[k][i] + mix.lean * force[k][i] / mass[i];
}

}  // namespace

RestReport relax(Rve& cell, const RestCriterion& rest, double stepFraction) {
  validate(rest, "rest of a cell");
  requireFraction(stepFraction, "the fraction of the critical step", "rest of a cell");
  CellState& s = cell.state;
  stop(cell);
  dem::Fire fire(stepFraction * s.criticalStep);
  Components force, torque;
  RestReport report;
  for (;; ++report.steps) {
    if ((report.steps % lookEvery == 0 || report.steps >= rest.steps) && report.judge(balance(cell).unbalanced, rest))
      break;
    fire.setLongest(stepFraction * s.criticalStep);
    freeForces(cell, force, torque);
    dem::FireSums sums;
    addSums(s.v, force, cell.mass, sums);
    addSums(s.spin, torque, cell.inertia, sums);
    const dem::FireMix mix = fire.next(sums);
    lean(s.v, force, cell.mass, mix);
    lean(s.spin, torque, cell.inertia, mix);
    s.ledger.damping += 0.5 * sums.speed - kineticEnergy(cell);
    step(cell, fire.dt());
  }
  stop(cell);
  return report;
}

}  // namespace dovetail::rve
