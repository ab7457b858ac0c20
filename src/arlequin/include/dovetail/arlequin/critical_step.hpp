// The largest stable step of the coupled explicit integrator, and who sets it.
#pragma once

#include "dovetail/arlequin/stepper.hpp"

namespace dovetail::arlequin {

/// 2/ω of velocity Verlet, s; infinite for a part that is absent.
struct CriticalStep {
  double particles;  ///< contacts between weighted particles, all of them closed
  double solid;      ///< weighted bricks with the mass matrix in use
  double together;   ///< all, with the stiffness of the constraint
};

/// From the largest eigenvalue of M⁻¹K of the model as it is now (Lanczos; the bound on its error is added, so the step
/// errs on the small side). Multipliers only lower ω; dashpots and the absorber have limits of their own (see
/// makeDashpot and Absorber).
/// @throws NumericalError if the iteration meets a number that is not finite
CriticalStep criticalStep(Model& model);

}  // namespace dovetail::arlequin
