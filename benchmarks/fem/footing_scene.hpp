// A strip footing on weightless soil up to its bearing capacity.
#pragma once

#include <cstdint>
#include <vector>

#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/plasticity.hpp"

namespace dovetail::fem {

/// Half of a smooth rigid footing 1 m wide, pushed into a block of soil 5 m wide (its half) and 5 m deep, in plane
/// strain, with strains so small that the geometry does not change.
struct Footing {
  static constexpr double halfWidth = 0.5, side = 5.0, cohesion = 1.0, young = 1e6;  // m, Pa
  double friction = 20.0, dilatancy = 20.0;                                          // degrees
  ElementShape shape = ElementShape::hex20;
  Formulation formulation = Formulation::standard;
  int under = 3, beside = 7, deep = 7;  ///< cells below the footing, beside it, and downwards; one across
  double settlement = 2e-4;             ///< m
  int steps = 20;

  /// c cot φ (e^(π tan φ) tan²(π/4 + φ/2) − 1), Pa (Prandtl 1920), or (2 + π) c without friction: what Mohr–Coulomb
  /// soil with associated flow carries.
  double prandtlPressure() const;
};

struct FootingResult {
  std::vector<double> settlement;  ///< m
  std::vector<double> pressure;    ///< mean below the footing, Pa
  std::int64_t iterations;
  int cuts;
  double seconds;
};
FootingResult settle(const Footing& footing);

}  // namespace dovetail::fem
