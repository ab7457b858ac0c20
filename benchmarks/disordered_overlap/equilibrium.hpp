// A column under gravity that is joined to a solid: with the correction that brings both to equilibrium, and without.
#pragma once

#include <cstdint>
#include <vector>

#include "stress.hpp"

namespace dovetail::disordered_overlap {

struct EquilibriumOptions {
  ColumnSize size{.width = 4.0 * grain::diameter, .height = 18.0 * grain::diameter, .seed = 1};
  double element = 2.0 * grain::diameter;  ///< m
  int solid = 6;                           ///< height of its top above the packing's floor, elements
  int overlap = 6, below = 2;              ///< elements: below the solid's top, and below the packing's floor
  double weight = 0.5;                     ///< of the critical step
  double rest = 1e-7;                      ///< kinetic over elastic energy that the correction ends at
  std::int64_t steps = 100000;             ///< afterwards
};

/// The column with its correction: arlequin::initialEquilibrium, and coupling::relax, whose loss has the channel
/// "brought to rest".
struct Corrected {
  bool atRest = false;
  int rounds = 0;                           ///< of initialEquilibrium
  std::int64_t macroSteps = 0;              ///< of settle
  double broughtToRest = 0.0;               ///< over the elastic energy
  double kinetic = 0.0;                     ///< largest over the elastic energy, in the steps afterwards
  double moved = 0.0;                       ///< by any grain in these steps, in diameters
  double residual = 0.0;                    ///< of the ledger in these steps over the elastic energy
  double stressDrift = 0.0;                 ///< largest change of a layer's stress in these steps, relative
  double meanDensity = 0.0, surface = 0.0;  ///< of the packing, kg/m³; height of as much with that density, m
  std::vector<LayerStress> layers;
  std::vector<double> packingAbove;  ///< weight in the packing alone above the same layers, Pa
};
Corrected runCorrected(const dem::Model& packing, const EquilibriumOptions& settings);

/// Largest kinetic energy after a start without any correction, or with initialEquilibrium alone.
struct Start {
  double joules = 0.0;
  double overElastic = 0.0;  ///< over the elastic energy at the same instant
};
Start peakWithout(const dem::Model& packing, const EquilibriumOptions& settings, bool initialEquilibrium);

}  // namespace dovetail::disordered_overlap
