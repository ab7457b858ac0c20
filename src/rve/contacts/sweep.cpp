#include "sweep.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "bonded.hpp"
#include "dovetail/core/error.hpp"

namespace dovetail::rve {

void sweep(Rve& cell, double dt, const MeanMotion& motion) {
  for (Components* field : {&cell.state.force, &cell.state.torque})
    for (std::vector<double>& component : *field) std::fill(component.begin(), component.end(), 0.0);
  const bool slides = cell.springs.slides(), rolls = cell.springs.rolls();
  if (cell.springs.elasticSpheres())
    slides ? sweepSpheres<true, true>(cell, dt, motion) : sweepSpheres<false, true>(cell, dt, motion);
  else if (cell.shape == Shape::sphere)
    slides ? sweepSpheres<true, false>(cell, dt, motion) : sweepSpheres<false, false>(cell, dt, motion);
  else if (rolls)
    slides ? sweepDiscs<true, true>(cell, dt, motion) : sweepDiscs<false, true>(cell, dt, motion);
  else
    slides ? sweepDiscs<true, false>(cell, dt, motion) : sweepDiscs<false, false>(cell, dt, motion);
  if (!cell.state.contacts.bond.empty()) sweepBonds(cell, dt, motion);
}

void requireFiniteForces(const Rve& cell) {
  if (cell.state.virial.allFinite()) return;
  std::size_t grain = 0;
  for (const std::vector<double>& component : cell.state.force) {
    const auto at = std::ranges::find_if(component, [](double f) { return !std::isfinite(f); });
    if (at != component.end()) grain = static_cast<std::size_t>(at - component.begin());
  }
  throw NumericalError("forces are not finite", "grain " + std::to_string(grain) + " of a cell",
                       "take shorter steps, and keep centres apart");
}

}  // namespace dovetail::rve
