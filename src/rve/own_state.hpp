// Whether a state is one of a cell.
#pragma once

#include "dovetail/rve/cell.hpp"

namespace dovetail::rve {

/// @throws InputError if the state is of other grains, springs or bonds, or from before the cell's last compress()
void requireOwn(const Cell& cell, const CellState& state);

}  // namespace dovetail::rve
