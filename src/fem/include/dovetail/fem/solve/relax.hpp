// Dynamic relaxation: equilibria without tangents.
#pragma once

#include "dovetail/core/rest.hpp"
#include "dovetail/fem/solve/statics.hpp"

namespace dovetail::fem {

struct RelaxOptions {
  /// Of each step: the residual is the norm of the forces out of balance over the largest one of a term's forces.
  RestCriterion rest{.tolerance = 1e-6, .steps = 100000};
  double absoluteTolerance = 0.0;  ///< N, added to what the criterion allows
  double firstStep = 0.1;          ///< s of model time
  double largestStep = 1e300;      ///< s
  double smallestStep = 1e-6;      ///< s; below it the run stops
  int maxAugmentations = 30;       ///< per step, for contact by augmented Lagrangian
  /// Of the motion to rest with the nodes' masses, s; 0 = nine tenths of stableStep(model), which asks the laws for
  /// tangents of single elements, springs and contact planes.
  double iterationStep = 0.0;
};

/// Takes the model from model.t to tEnd through equilibria like solveStatics, without any matrix: the nodes come
/// to rest in a motion of their own with the lumped masses in nodes.mass, damped critically for the frequency ω² =
/// uᵀΔf/uᵀMu that the displacement u since the last equilibrium and the force Δf that it cost show (Underwood 1983;
/// Oakley & Knight 1995). Prescribed motion and loads come on over the first iterations of a step. The terms see model
/// time, not that of the motion.
/// @return iterations are evaluations of the forces
/// @throws as solveStatics; InputError for nodes without mass
StaticReport relax(Model& model, double tEnd, const RelaxOptions& options = {}, const StaticObserver& observer = {});

}  // namespace dovetail::fem
