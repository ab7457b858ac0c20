// The walls that bodies of a model carry. Their bodies move them and gather what contacts did to them, so it does not
// matter which of the two terms was added first.
#pragma once

#include <span>

#include "dovetail/dem/bodies/body_term.hpp"
#include "dovetail/dem/walls/mesh_wall.hpp"

namespace dovetail::dem {

/// @throws InputError if the model has no bodies at all
const Bodies& bodiesOf(const Model& m);
/// @throws InputError if the wall is on a body that does not exist, has members or does not fit the wall
void checkCarrier(const Model& m, const WallOnBody& carrier, std::size_t vertices);

/// Places them as their bodies lie. @param time s
void placeCarriedWalls(Model& m, const Bodies& bodies, double time);
/// What their contacts do to them, on to their bodies.
void gatherCarriedWalls(Model& m, Bodies& bodies);
/// Their bodies have been moved by whole periods from where they were.
void shiftCarriedWalls(Model& m, const Bodies& bodies, std::span<const Vec3> before);
/// Bodies are about to leave, and those behind them move up. @param gone one per body, 0 = stays
void renumberCarriedWalls(Model& m, std::span<const char> gone);
/// What their contacts ask of the step; a body gives way to all of its contacts at once.
void addCarriedDemand(const Model& m, const Bodies& bodies, ContactDemand& demand);

/// Per body: distance of the farthest vertex of its walls from its centre, m; 0 without walls.
std::vector<double> wallExtents(const Model& m, const Bodies& bodies);
/// Sets the entries of bodies whose walls are touched.
void markTouched(const Model& m, std::vector<char>& bodies);

}  // namespace dovetail::dem
