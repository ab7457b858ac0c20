// The largest stable step of particles and a solid that share an overlap, and what sets it.
#pragma once

#include "dovetail/arlequin/arlequin_coupling.hpp"

namespace dovetail::arlequin {

/// 2/ω of velocity Verlet, s; infinite for a part that is absent.
struct CriticalStep {
  double particles;  ///< contacts between weighted particles, all of them closed
  double solid;      ///< weighted elements with their mass matrix
  double together;   ///< all, with the stiffness of the tie
};

/// From the largest eigenvalue of M⁻¹K of the state as it is now (Lanczos; the bound on its error is added, so the step
/// errs on the small side): sharper than CoupledRun::criticalStep and much more expensive. Multipliers only lower ω;
/// dashpots and the absorber have limits of their own (see makeDashpot and Absorber). Pairs must be listed.
/// @param side       of the one solid; null: particles alone   @param massFraction  of its consistent mass
/// @param tie        null: none
/// @throws NumericalError if the iteration meets a number that is not finite
CriticalStep criticalStep(dem::Model& grains, coupling::SolidSide* side, double massFraction, ArlequinCoupling* tie);

}  // namespace dovetail::arlequin
