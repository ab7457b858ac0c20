// States of cells to bytes and back.
#pragma once

#include "dovetail/core/archive.hpp"
#include "dovetail/rve/cell.hpp"

namespace dovetail::rve {

/// Writes a state of this cell, with a checksum of what the cell is.
void writeState(const Cell& cell, const CellState& state, ByteWriter& archive);

/// Reads one back; a cell that gets it goes on with the same digits.
/// @throws InputError if it was written for other grains or springs, or is damaged
CellState readState(const Cell& cell, ByteReader& archive);

}  // namespace dovetail::rve
