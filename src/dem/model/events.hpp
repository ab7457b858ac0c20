// What happens between moves and forces: the list of pairs is updated, particles escape, are sorted, come and go.
#pragma once

#include <string>
#include <vector>

#include "dovetail/dem/model/model.hpp"

namespace dovetail::dem {

/// "t = 0.5 s, step 100"
std::string when(const Model& m);
/// m; 0 without particles
double smallestRadius(const Particles& particles);
/// m/s; infinite if a velocity, position, spin or radius is not finite
double largestSpeed(const Particles& particles);
/// Whether the forces are those of the particles, laws and terms that are there now.
bool hasForces(const Model& m);
/// Sets the factors of pairs anew: weights, and what terms mute.
void setFactors(Model& m);
/// @throws InputError if there are none
void requireLaws(const Model& m);
/// @throws InputError if it is not finite
void requireFiniteGravity(const Model& m);
/// @throws NumericalError naming what is not finite, and of which particle, or who has moved farther than its radius
void requireShortMoves(const Particles& particles, double dt, const std::string& when);

/// How far beyond touch pairs are to be listed, m; 0 for lists that are kept.
double reachOfPairs(const Model& m);
/// Updates the neighbour list where moves ask for it; then looks for who has escaped, and sorts now and then.
void updatePairs(Model& m);
/// Means of velocities and spins before and after the kick that the forces of the step under way make, to second order
/// of those whose path is given: with these the forces do their work in it. After all forces are known.
struct MeanMotion {
  std::vector<Vec3> v, omega;  ///< m/s, rad/s, per particle; omega is empty where particles do not spin, or nobody asks
};
MeanMotion meanMotion(const Model& m, const Step& step, bool withSpins = true);

/// Adds a particle to what was exchanged; its energy, J. Where velocities lag, what its forces will have given counts.
double bookParticle(const Model& m, std::size_t i, Exchanged& exchanged);
/// What springs lost as they slid, yielded and broke in a step.
void bookLosses(Model& m, const ContactWork& work, double dt);
/// m g·x, J.
double gravityOf(const Particles& particles, std::size_t i, const Vec3& gravity);

}  // namespace dovetail::dem
