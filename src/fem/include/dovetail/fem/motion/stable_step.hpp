// The largest stable step of the explicit integrator.
#pragma once

#include "dovetail/fem/elements/critical_element.hpp"
#include "dovetail/fem/model/model.hpp"

namespace dovetail::fem {

/// Of the stiffest single element of all solids at the present displacement, with its lumped mass, and of what
/// else stores energy (springs to the ground, contact planes as if they were touched, energies of gradients) at the
/// node at which it pulls most: 2/√(ω_e² + k/m) with the row sums k of Term::addStiffness. Never above the limit of the
/// assembled model, but for loads that follow the body.
/// @param of  what the owner is called by, "element 3 of "beam""; empty: the name of the term
/// @throws InputError if the model has no solid
StableStep stableStep(Model& model, const std::string& of = {});
/// 2/ω of all terms and constraints at the present state (TᵀKT and TᵀMT with the nodes' lumped mass) by Lanczos
/// iteration. The bound on the error of ω² is added to it, so that the step errs on the small side.
/// @param accuracy  relative, of ω²
/// @throws NumericalError if it does not settle; InputError for nodes without mass
double assembledStableStep(Model& model, double accuracy = 1e-4);

}  // namespace dovetail::fem
