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
  int node = -1;      ///< that springs or planes pull at more than elements do; then `solid` is their term
  /// "element 3 of "beam"" @param of  name of the solid
  std::string owner(const std::string& of) const;
};
/// Of the stiffest single element of all solids at the present displacement, with its lumped mass, and of the springs
/// to the ground and the contact planes (as if these were touched) at the node at which they pull most: 2/√(ω_e² +
/// k/m). Never above the limit of the assembled model, but for loads that follow the body.
/// @throws InputError if the model has no solid
ModelStableStep stableStep(Model& model);
/// 2/ω of all terms and constraints at the present state (TᵀKT and TᵀMT with the nodes' lumped mass) by Lanczos
/// iteration. The bound on the error of ω² is added to it, so that the step errs on the small side.
/// @param accuracy  relative, of ω²
/// @throws NumericalError if it does not settle; InputError for nodes without mass
double assembledStableStep(Model& model, double accuracy = 1e-4);

}  // namespace dovetail::fem
