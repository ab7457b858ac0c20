// Initial equilibrium of a solid with the packing in its overlap.
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

/// Load of particles at rest on the solid with which they will share an overlap, N per node: Φᵀ of the unbalanced
/// forces of their weighted contacts, walls and weights, which is ∇w·σ with σ their stress. The coupling exerts these
/// forces in equilibrium.
/// @param grains       at rest, without the coupling; those beyond the border (particlesBeyond) do not contribute
/// @param solid        where the mesh is now; its elements have the weight 1 − w   @param nodalWeight  w per node
/// @param leastWeight   as CouplingOptions::leastWeight
/// @throws InputError as makeArlequinCoupling
std::vector<Vec3> initialLoad(const dem::Model& grains, const fem::SolidMesh& mesh, fem::Model& solid,
                              std::span<const double> nodalWeight, double leastWeight = CouplingOptions{}.leastWeight);

struct InitialEquilibriumOptions {
  fem::StaticOptions statics{};
  double tolerance = 1e-6;  ///< largest change of the load between two rounds over the largest load
  int rounds = 100;
  double leastWeight = CouplingOptions{}.leastWeight;  ///< of the coupling that is to be made
};

/// Initial stress: deforms the solid until it is in equilibrium under its own terms and the load of the particles on
/// the deformed mesh. The overlap moves with the mesh, so give all particles, and remove those beyond the border
/// (particlesBeyond) afterwards, before the coupling is made. They are tied at their positions, without a gap;
/// imbalances of single particles, which the nodes cannot balance, are left to coupling::relax. A particle that has
/// left the overlap in one round, or moved to another periodic image, no longer contributes. Loads and prescribed
/// motions are those at the solid's time, without creep; velocities are kept; masses are set if they are not
/// (fem::addMass).
/// @param change  if given: the remaining difference between the load that the solid carries and the load on its final
/// mesh, over the largest nodal load. Above the tolerance where the weight of a contact jumps at the final position
/// @throws InputError as initialLoad, for options out of range, or for particles that are tied to this solid already;
/// NumericalError as fem::solveStatics, and if the load still changes after the last round, with the amount
/// @return rounds taken
int initialEquilibrium(const dem::Model& grains, const fem::SolidMesh& mesh, fem::Model& solid,
                       std::span<const double> nodalWeight, const InitialEquilibriumOptions& options = {},
                       double* change = nullptr);

}  // namespace dovetail::arlequin
