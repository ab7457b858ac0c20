// What parts of a scene take from the states of other runs.
#pragma once

#include <string>
#include <vector>

#include "dovetail/scene/build.hpp"

namespace dovetail::scene {

/// Puts the motion of the solid of that name, and what its elements remember, into the model.
/// @throws InputError if the state has none, or of another mesh, material or formulation
void takeSolid(fem::Model& model, const Solid& solid, std::vector<std::string>& notes);

/// The wall of that name in the state: its primitives, in their order. @param grains  with the laws of the state
/// @throws InputError if it has none, or of another shape
std::vector<dem::PrimitiveWall> wallOfState(const Wall& wall, const dem::Model& grains);

/// Contacts of grains that are those of a state go on with the springs that they had there: with walls of the same
/// shape and place, and on solids that are of the same state, by the same couplings. Notes tell of the others.
void takeContacts(Built& built, const Scene& scene);

}  // namespace dovetail::scene
