// The largest stable step of the explicit integrator.
#pragma once

#include "dovetail/fem/elements/critical_element.hpp"
#include "dovetail/fem/model/model.hpp"

namespace dovetail::fem {

/// A step, and who sets it.
struct ModelStableStep {
  double dt;          ///< s
  int element;        ///< number in its mesh
  std::string solid;  ///< name of its term
};
/// 2/ω of the stiffest single element of all solids at the present displacement, with its lumped mass. Never above the
/// limit of the assembled solids; springs and contact planes are not looked at (assembledStableStep does).
/// @throws InputError if the model has no solid
ModelStableStep stableStep(Model& model);
/// 2/ω of all terms and constraints at the present state (TᵀKT and TᵀMT with the nodes' lumped mass) by Lanczos
/// iteration. The bound on the error of ω² is added to it, so that the step errs on the small side.
/// @param accuracy  relative, of ω²
/// @throws NumericalError if it does not settle; InputError for nodes without mass
double assembledStableStep(Model& model, double accuracy = 1e-4);

}  // namespace dovetail::fem
