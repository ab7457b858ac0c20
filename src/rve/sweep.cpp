#include "sweep.hpp"

#include <algorithm>

#include "bonded.hpp"

namespace dovetail::rve {

void sweep(Cell& cell, double dt, const Eigen::Matrix3d& L) {
  for (Components* field : {&cell.state.force, &cell.state.torque})
    for (std::vector<double>& component : *field) std::fill(component.begin(), component.end(), 0.0);
  const bool slides = cell.springs.slides(), rolls = cell.springs.rolls();
  if (cell.shape == Shape::sphere)
    slides ? sweepSpheres<true>(cell, dt, L) : sweepSpheres<false>(cell, dt, L);
  else if (rolls)
    slides ? sweepDiscs<true, true>(cell, dt, L) : sweepDiscs<false, true>(cell, dt, L);
  else
    slides ? sweepDiscs<true, false>(cell, dt, L) : sweepDiscs<false, false>(cell, dt, L);
  if (!cell.state.contacts.bond.empty()) sweepBonds(cell, dt, L);
}

}  // namespace dovetail::rve
