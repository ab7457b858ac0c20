// What goes on grain by grain in every step.
#pragma once

#include <Eigen/Core>

#include "dovetail/rve/rve.hpp"

namespace dovetail::rve {

/// v ← v + dt (f − D)/m, where D has the fraction `damping` of the size of f and is against v. Returns what D takes, J.
/// The same for spins, torques and inertias.
double kick(Components& v, const Components& force, const std::vector<double>& mass, double dt, double damping);

/// x ← G (x + v dt). Returns the largest |v|², NaN if one is not finite.
double advance(CellState& state, double dt, const Eigen::Matrix3d& G);

/// Turns vectors; what discs have of them stays in the plane or on z.
void turn(Components& field, const Eigen::Matrix3d& by);

}  // namespace dovetail::rve
