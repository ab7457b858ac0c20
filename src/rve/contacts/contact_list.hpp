// Who may touch whom.
#pragma once

#include <vector>

#include "dovetail/rve/rve.hpp"

namespace dovetail::rve {

/// Reduces the lattice, wraps positions, lists pairs closer than their radii and the skin, and keeps what contacts
/// remember. Sets the remaining skin and the critical step.
/// @param thin  faces may be one of the largest diameters and a skin apart: the cell is to be repeated
/// @throws NumericalError if faces are closer than two of them, and the cell is not said to be thin
void updateNeighbourList(Rve& cell, bool thin = false);

/// 2/ω of the pair i, j that is fastest if either grain shares its mass among its pairs by what they ask of it
/// (dem::criticalStep): ω² = Σ k_i/m_i + Σ k_j/m_j, k the stiffer of pressing and sliding with turning; of elastic
/// spheres twice the larger of both.
/// @param stiffness  Σ k_n of each grain, N/m
double criticalStep(const Rve& cell, std::vector<double> stiffness);

/// Largest distance of centres at which pairs are listed, m.
double listReach(const Rve& cell);

/// Fraction of a contact that lies at this place in a framed cell: 1 over the number of places where it lies.
/// @param p, q  grains of the framed cell
double fractionOf(const Frame& frame, int p, int q);

}  // namespace dovetail::rve
