// Who may touch whom.
#pragma once

#include <span>

#include "dovetail/rve/rve.hpp"

namespace dovetail::rve {

/// Reduces the lattice, wraps positions, lists pairs closer than their radii and the skin, and keeps what contacts
/// remember. Sets the room and the critical step.
/// @throws NumericalError if faces are closer than two of the largest diameters and skins
void updateNeighbourList(Rve& cell);

/// 2/ω with ω² ≤ max 2 Σ k/m over the pairs of a grain, k the stiffer of pressing and sliding with turning: the matrix
/// of a pair is at most twice its blocks of each grain, and in one block normal and tangent are orthogonal.
/// @param stiffness  Σ k_n of each grain, N/m
double criticalStep(const Rve& cell, std::span<const double> stiffness);

/// Largest distance of centres at which pairs are listed, m.
double listReach(const Rve& cell);

/// Fraction of a contact that lies at this place in a framed cell: 1 over the number of places where it lies.
/// @param p, q  grains of the framed cell
double fractionOf(const Frame& frame, int p, int q);

}  // namespace dovetail::rve
