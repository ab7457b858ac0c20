// Which bonds end at which particle.
#pragma once

#include "dovetail/dem/bonds/bonds.hpp"

namespace dovetail::dem::detail {

/// Makes the ends anew if bonds or particles are not as many as they were.
/// @throws InputError as check(bonds, particles)
void updateEnds(const Particles& particles, Bonds& bonds);

/// Takes a bond out; the last one takes its number.
void removeBond(Bonds& bonds, std::size_t bond);

/// Whether a bond joins these two.
bool joined(const Bonds& bonds, int i, int j);

/// Adds the bonds' forces and torques to the particles, to each in the order of its bonds.
void gatherForces(const Bonds& bonds, Particles& particles);

}  // namespace dovetail::dem::detail
