// The space of fluctuations of a framed cell.
#pragma once

#include "dovetail/rve/rve.hpp"

namespace dovetail::rve {

/// Takes velocities, or accelerations, to the nearest ones, in the norm of the masses, that the frame's conditions
/// allow. What that takes is what reactions do. Nothing happens in cells that repeat.
void project(const Rve& cell, Components& v, Components& spin);

/// Forces and torques less what the reactions of the frame hold, N and N m: masses times projected accelerations.
void freeForces(const Rve& cell, Components& force, Components& torque);

/// Inverse of Σ A ⊗ A of area vectors; if all are parallel, along these.
Eigen::Matrix2d inverseOfAreas(const Eigen::Matrix2d& areas);

}  // namespace dovetail::rve
