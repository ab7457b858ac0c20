// Cells of grains for files of other kinds than scenes.
#pragma once

#include <vector>

#include "dovetail/rve/rve.hpp"
#include "dovetail/scene/cells.hpp"
#include "dovetail/scene/fields.hpp"

namespace dovetail::scene {

/// Keys of cells.
void describe(Fields& f, Cells& v);

/// Cells as described, prepared, each a task of its own; or as a file has them.
/// @throws InputError for settings that are not valid and files that are none; NumericalError as rve::compress
std::vector<rve::Rve> makeCells(const Cells& cells);

}  // namespace dovetail::scene
