// Options of a volume coupling.
#pragma once

#include "dovetail/arlequin/gap_operator.hpp"

namespace dovetail::arlequin {

enum class ConstraintKind {
  penalty,     ///< on the accumulated gap, energy-storing (default)
  multiplier,  ///< workless
  dashpot      ///< the paper's penalty on increments; loses what it damps
};

struct CouplingOptions {
  GapForm form = GapForm::atParticles;
  ProjectionOptions projection{};
  ConstraintKind constraint = ConstraintKind::penalty;
  double penalty = 0.0;            ///< p, or ε of the dashpot, Pa/m²; 0 = automaticPenalty (dashpot: none)
  bool consistentDashpot = false;  ///< ∫ψ_iψ_j instead of its row sums
  /// The forces of a macro step's increment act over the whole of the next one, as in the published dashpot (Cheng et
  /// al. 2023); implicit solids only. Between two macro steps their mean acts.
  bool dashpotLags = false;
  double absorberRate = 0.0;  ///< 1/s; 0 = no absorber
  /// Particles with a smaller weight have passed the border of the particles within the solid: they are removed. The
  /// floor of the weights, or less.
  double leastWeight = 1e-3;
};

}  // namespace dovetail::arlequin
