// What happens between moves and forces: the list of pairs is renewed, particles escape, are sorted, come and go.
#pragma once

#include <string>

#include "dovetail/dem/model/model.hpp"

namespace dovetail::dem {

/// "t = 0.5 s, step 100"
std::string when(const Model& m);
/// m; 0 without particles
double smallestRadius(const Particles& particles);
/// m/s; infinite if one is not finite
double largestSpeed(const Particles& particles);
/// @throws NumericalError naming what is not finite or has moved farther than its radius
void requireShortMoves(const Particles& particles, double dt, const std::string& when);

/// Renews the list of pairs where moves ask for it; then looks for who has escaped, and sorts now and then.
void renewPairs(Model& m);
/// Kinetic energy of one particle, and m g·x, J.
double kineticEnergyOf(const Particles& particles, std::size_t i);
double gravityOf(const Particles& particles, std::size_t i, const Vec3& gravity);

}  // namespace dovetail::dem
