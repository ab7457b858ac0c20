// Straining of a periodic cell with its contents.
#pragma once

#include "dovetail/dem/model/model.hpp"

namespace dovetail::dem {

/// Strains a periodic cell along its axes: the box about its lower corner, and the particles with it, x ← (1 + ε) x.
/// Contacts feel the motion as any other, but dashpots, as it is slow: tangential springs stretch and slide. Velocities
/// stay, no time passes, and forces are those of the state before until findForces or relax is called. What the
/// boundary does is booked as external work, what slides as friction; the ledger closes to second order in ε.
/// @param strain  ε per axis, > 0 stretches
/// @throws InputError unless forces have been found, every axis along which it strains repeats, ε is finite and > −1,
/// and the model has particles and contacts only
void strainCell(Model& m, const Vec3& strain);

}  // namespace dovetail::dem
