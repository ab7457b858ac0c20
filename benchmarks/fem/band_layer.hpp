// A sheared layer whose stress falls by H per shear strain beyond a peak: its band in closed form and in elements.
#pragma once

#include "dovetail/fem/mesh/solid_mesh.hpp"

namespace dovetail::benchmark {

/// Stress 1 at the peak; moduli and D over it.
struct SoftLayer {
  double shear = 1.0;        ///< G, before the peak and outside the band
  double softening = 0.1;    ///< H
  double modulus = 1.0;      ///< D of the gradient, times a length squared
  double bandsAcross = 5.0;  ///< height of the layer over the width of the band
};

/// Δ = Δ_peak + opening · (drop of the stress) − height/G · (drop of the stress).
struct Band {
  double width = 0.0;    ///< where the strain is above that of the peak
  double opening = 0.0;  ///< of the band alone, per drop of the stress
};

/// 2 √(D/H) (π − arctan √(H/G)), and (1/H + 1/G) (width + 2 √(D/G)).
Band exactBand(const SoftLayer& layer);
/// By one column of quad4, or of quad8 with 2 × 2 points, so many to the width of the exact band; statics at drops of
/// a quarter and half of the peak.
Band bandOfElements(const SoftLayer& layer, fem::ElementShape shape, double elementsPerBand);

}  // namespace dovetail::benchmark
