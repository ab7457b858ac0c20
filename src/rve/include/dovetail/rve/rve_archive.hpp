// Cells and their states to bytes and files, and back.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "dovetail/core/archive.hpp"
#include "dovetail/rve/rve.hpp"

namespace dovetail::rve {

/// Writes a state of this cell, with a checksum of what the cell is. @throws InputError as restore
void writeState(const Rve& cell, const CellState& state, ByteWriter& archive);

/// Reads one back; a cell that gets it goes on with the same digits.
/// @throws InputError if it was written for other grains or springs, or naming the grain or contact of which a number
/// is
///   one that no cell has. Numbers that have changed to others that might be are for a checksum to find, as files of
///   states have (writeSamples, writeChecked)
CellState readState(const Rve& cell, ByteReader& archive);

/// Whole cells, in the bytes of writeSamples without the checksum. @param where  for messages
/// @throws InputError for framed cells
void writeCells(std::span<const Rve> cells, ByteWriter& archive, const std::string& where);
/// All that are left. @param where  for messages @throws InputError as readSamples
std::vector<Rve> readCells(ByteReader& archive, const std::string& where);

/// Writes cells to a file with a checksum, for programs that share them.
/// @throws InputError for framed cells (cut them after reading), or if the file cannot be written there
void writeSamples(const std::filesystem::path& path, std::span<const Rve> cells);

/// @throws InputError if the file cannot be read, is of another kind, or has changed since it was written; naming the
///   cell, and its grain or contact, of which a number is one that no cell has
std::vector<Rve> readSamples(const std::filesystem::path& path);

}  // namespace dovetail::rve
