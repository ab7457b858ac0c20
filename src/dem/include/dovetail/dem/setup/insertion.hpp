// Particles that enter and leave while a run goes on.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "dovetail/dem/bodies/clumps.hpp"
#include "dovetail/dem/particles/particles.hpp"
#include "dovetail/dem/setup/sizes.hpp"
#include "dovetail/geometry/box.hpp"

namespace dovetail::dem {

/// What enters, where and how fast. One of the two rates is > 0, the other 0.
struct InsertionSettings {
  geometry::Box region;  ///< whole spheres lie in it; keep it clear of walls, which are not looked at
  Sizes sizes;
  Density density{0.0};
  Vec3 velocity;                 ///< m/s
  double numberPerSecond = 0.0;  ///< 1/s
  double massPerSecond = 0.0;    ///< kg/s
  int tries = 50;                ///< places tried for each particle before it is refused
  std::uint64_t seed = 1;
};

/// An insertion under way: what it was asked for, and what has come of it.
struct Insertion {
  InsertionSettings settings;
  RandomStream random;
  double nextRadius;          ///< m
  double due = 0.0;           ///< particles, or kg, that should have entered and have not been tried yet
  std::int64_t inserted = 0;  ///< particles
  std::int64_t refused = 0;   ///< particles that found no free place; they are dropped, not tried again
  double insertedMass = 0.0;  ///< kg
  double refusedMass = 0.0;   ///< kg
};

/// @throws InputError if sizes or density are not valid, the velocity is not finite, not exactly one of the rates is >
/// 0,
///   tries < 1, or the region does not hold the largest sphere
Insertion makeInsertion(const InsertionSettings& settings);

/// Lets in what is due after another dt seconds, at places drawn at random in the region where it overlaps with nobody.
/// Appended particles keep the numbers of the others. Returns how many entered.
/// @throws InputError if dt is not finite and ≥ 0
int insertParticles(Insertion& insertion, Particles& particles, double dt);

/// Particles whose centres lie in the closed box, or outside it; ascending.
std::vector<int> particlesInside(const Particles& particles, const geometry::Box& box);
std::vector<int> particlesOutside(const Particles& particles, const geometry::Box& box);

/// Takes particles out of all arrays; the others keep their order, and their id from now on. Returns old → new number,
/// −1 for those that are gone, for whatever else refers to particles (renumber).
/// @param list numbers in any order; twice does not matter
/// @throws InputError on a number that does not exist; nothing is removed then
std::vector<int> removeParticles(Particles& particles, std::span<const int> list);

/// Gives clumps the new numbers of their members.
/// @throws InputError naming the body of which a member is gone; nothing is changed then
void renumber(Clumps& clumps, std::span<const int> newNumber);

/// Takes bodies out with all their members. Returns what removeParticles does; bodies behind those removed move up.
/// @throws InputError on a body that does not exist; nothing is removed then
std::vector<int> removeClumps(Particles& particles, Bodies& bodies, Clumps& clumps, std::span<const int> list);

}  // namespace dovetail::dem
