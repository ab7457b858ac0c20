// Who may touch whom.
#pragma once

#include "dovetail/rve/cell.hpp"

namespace dovetail::rve {

/// Reduces the lattice, wraps positions, lists pairs closer than their radii and the skin, and keeps what contacts
/// remember. Sets the room and the critical step.
/// @throws NumericalError if faces are closer than two of the largest diameters and skins
void renew(Cell& cell);

/// Largest distance of centres at which pairs are listed, m.
double listReach(const Cell& cell);

/// Share of a contact that lies at this place in a framed cell: 1 over the number of places where it lies.
/// @param p, q  grains of the framed cell
double shareOf(const Frame& frame, int p, int q);

}  // namespace dovetail::rve
