// Sides that give way.
#pragma once

#include <algorithm>

#include "dovetail/rve/rve.hpp"

namespace dovetail::benchmark {

/// Strain of a step along an axis, in proportion to what presses there too much (pressure, Pa), at most `most`.
inline double givingWay(const rve::Rve& cell, int axis, double pressure, double most) {
  const double r = 0.5 * rve::meanDiameter(cell);
  const double k = rve::normalStiffness(cell.springs, r, r) / norm(cell.state.lattice.period[2]);
  const double excess = -rve::stress(cell).cauchy(axis, axis) - pressure;
  return std::clamp(excess / (10.0 * k), -most, most);
}

}  // namespace dovetail::benchmark
