// A solid in equilibrium with a packing that it takes over.
#pragma once

#include <span>
#include <vector>

#include "dovetail/arlequin/coupling_options.hpp"
#include "dovetail/core/vec3.hpp"
#include "dovetail/dem/model/model.hpp"
#include "dovetail/fem/mesh/solid_mesh.hpp"
#include "dovetail/fem/model/model.hpp"
#include "dovetail/fem/solve/statics.hpp"

namespace dovetail::arlequin {

/// What particles at rest hand over to the solid that they are about to share an overlap with, N per node: Φᵀ of the
/// forces that their weighed contacts, walls and weights leave out of balance, which is ∇w·σ with σ their stress. A tie
/// exerts these forces in equilibrium.
/// @param grains       at rest, without the tie; those beyond the border (particlesBeyond) hand nothing over
/// @param solid        where the mesh is now; its elements have the weight 1 − w   @param nodalWeight  w per node
/// @param leastWeight   as CouplingOptions::leastWeight
/// @throws InputError as makeArlequinCoupling
std::vector<Vec3> initialLoad(const dem::Model& grains, const fem::SolidMesh& mesh, fem::Model& solid,
                              std::span<const double> nodalWeight, double leastWeight = CouplingOptions{}.leastWeight);

struct InitialEquilibriumOptions {
  fem::StaticOptions statics{};
  double tolerance = 1e-6;  ///< largest change of the handed load between two rounds over the largest load
  int rounds = 100;
  double leastWeight = CouplingOptions{}.leastWeight;  ///< of the tie that is to be made
};

/// Initial stress: deforms the solid until it is in equilibrium under its own terms and what the particles hand over
/// where its mesh then is: the overlap moves with the mesh, so give all particles, and take those beyond the border
/// (particlesBeyond) out afterwards, before you tie. They are tied where they are, without a gap, and what a tie of
/// elements cannot balance particle by particle is left to coupling::relax. A particle that has left the overlap in
/// one round, or is elsewhere in periodic space, hands nothing over from then on. Loads and prescribed motions are
/// those of the solid's time, in which nothing creeps; velocities stay; masses are set if they are not (fem::addMass).
/// @param change  if given: what is left between the load that the solid carries and that which it is handed where it
///   then is, over the largest of a node. More than the tolerance where the weight of a contact jumps at the place
///   where the solid comes to stand
/// @throws InputError as initialLoad, for options out of range, or for particles that are tied to this solid already;
///   NumericalError as fem::solveStatics, and if the load still changes after the last round, telling by how much
/// @return rounds taken
int initialEquilibrium(const dem::Model& grains, const fem::SolidMesh& mesh, fem::Model& solid,
                       std::span<const double> nodalWeight, const InitialEquilibriumOptions& options = {},
                       double* change = nullptr);

}  // namespace dovetail::arlequin
