// The width of coarse-grained fields that a run asks for.
#pragma once

#include <iosfwd>

#include "dovetail/cg/fields.hpp"
#include "dovetail/scene/grid_fields.hpp"

namespace dovetail::scene {

/// The width for which density and velocity depend on it the least, m (cg::studyWidths): from ¾ mean diameter up to
/// eight, at 1000 points of the settings' box, or, without one, of the box around the grains less the largest width
/// along axes that do not repeat; then the largest is a quarter of the shortest such side at most. Tells the table.
/// @throws InputError if grains lie in so thin a layer that less than a factor of two is left
double advisedWidth(const cg::SnapshotView& grains, const geometry::Box& around, double meanDiameter,
                    const GridOptions& settings, std::ostream& log);

}  // namespace dovetail::scene
