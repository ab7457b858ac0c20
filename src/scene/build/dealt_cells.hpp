// Cells of grains that were pressed on by the weight above them.
#pragma once

#include "dovetail/hierarchical/cell_field.hpp"
#include "parts.hpp"

namespace dovetail::scene {

/// What a grain of a cell takes in memory, bytes.
inline constexpr double bytesOfGrain = 1000.0;

struct DealtCells {
  std::vector<rve::Rve> cells;
  hierarchical::Deal deal;  ///< their numbers
};

/// At every depth d that a point has, below the highest corner of the solid, the cells pressed on from their pressure p
/// to p + ρ g d, all round and under their own friction; points of one depth get them in turn. ρ is the mean density of
/// all. @throws InputError if nothing weighs, or the memory is not enough; as rve::compress
DealtCells pressedByDepth(const std::vector<rve::Rve>& cells, const CellPlaces& places);

}  // namespace dovetail::scene
