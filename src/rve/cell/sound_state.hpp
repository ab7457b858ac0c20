// Whether what was read may be a state of a cell.
#pragma once

#include <string>

#include "dovetail/rve/rve.hpp"

namespace dovetail::rve {

/// @throws InputError naming what is wrong: a size that is not the cell's, a number that is not finite or that no cell
/// has, at which grain or contact
void requireSound(const Rve& cell, const CellState& state, const std::string& where);

/// The same for periods, of which reductions and images are made.
void requireSound(const geometry::Lattice& lattice, Shape shape, const std::string& where);

}  // namespace dovetail::rve
