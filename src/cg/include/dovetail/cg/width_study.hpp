// Dependence of density and velocity on the kernel's width, to choose it by.
#pragma once

#include <span>
#include <vector>

#include "dovetail/cg/fields.hpp"
#include "dovetail/core/measure_curve.hpp"

namespace dovetail::cg {

/// Widths that are tried, evenly in their logarithm.
struct WidthRange {
  double least = 0.0, most = 0.0;  ///< m
  int samples = 25;
};

/// How much fields change per e-fold of the width. Small widths see single particles, large ones smooth what varies in
/// space; fields mean the most where they depend on the width the least (Goldhirsch, Granul. Matter 12, 2010;
/// Weinhart, Hartkamp, Thornton & Luding, Phys. Fluids 25, 2013).
struct WidthStudy {
  MeasureCurve curve;           ///< over the width, m: √(density² + velocity²)
  std::vector<double> density;  ///< ‖∂ρ/∂ln w‖/‖ρ‖, ‖·‖ being the root mean square over the points
  /// ‖∂v/∂ln w‖, of points with particles within the kernel, over the root mean square of the particles' velocities
  /// about their mean, both weighted by mass; 0 where they all move alike.
  std::vector<double> velocity;
};

/// The derivatives are differences of `sample` at widths between those tried. Nothing changes if all moves along,
/// steadily or to another place.
/// @param dimension  of the kernel   @param points  m, farther than the largest width from edges that are not meant
/// @throws InputError unless 0 < least < most, samples ≥ 3 and a point sees a particle at every width, and as `sample`
WidthStudy studyWidths(KernelShape shape, int dimension, std::span<const Vec3> points, const SnapshotView& snapshot,
                       const WidthRange& range);

}  // namespace dovetail::cg
