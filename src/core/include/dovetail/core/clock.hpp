// Simulation time with sub-steps.
#pragma once

#include <cstdint>

namespace dovetail {

/// Counts fine steps; time is steps × dt, never an accumulated sum, so that restarts agree bit for bit.
struct Clock {
  double dt = 0.0;               ///< fine (DEM) step, s
  int substepsPerMacroStep = 1;  ///< fine steps per coarse (FEM) step
  std::int64_t step = 0;         ///< fine steps done

  double time() const { return static_cast<double>(step) * dt; }
  double coarseStep() const { return dt * substepsPerMacroStep; }
  void advanceMacroStep() { step += substepsPerMacroStep; }
};

}  // namespace dovetail
