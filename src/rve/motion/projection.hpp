// The space of fluctuations of a framed cell.
#pragma once

#include "dovetail/rve/rve.hpp"

namespace dovetail::rve {

/// Takes velocities, or accelerations, to the nearest ones, in the norm of the masses, that the frame's conditions
/// allow. What that takes is what reactions do. Nothing happens in cells that repeat.
void project(const Rve& cell, Components& v, Components& spin);

/// Forces and torques less what the reactions of the frame hold, N and N m: masses times projected accelerations.
void freeForces(const Rve& cell, Components& force, Components& torque);

/// Direction of the first component of the frame's conditions: F e_x where it matters.
Eigen::Vector2d alongOf(const Rve& cell);

/// Σ A of places in the frame, m².
Eigen::Vector2d areaOf(const Frame& frame, const std::vector<int>& set);

/// Inverse of Σ A ⊗ A of area vectors; if all are parallel, along these; 0 if there are none.
Eigen::Matrix2d inverseOfAreas(const Eigen::Matrix2d& areas);

}  // namespace dovetail::rve
