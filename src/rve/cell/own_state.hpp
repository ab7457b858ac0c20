// Whether a state is one of a cell.
#pragma once

#include "dovetail/rve/rve.hpp"

namespace dovetail::rve {

/// @throws InputError if the state is of other grains, springs or bonds, or from before the cell's last compress()
void requireOwn(const Rve& cell, const CellState& state);

}  // namespace dovetail::rve
