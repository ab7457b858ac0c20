// Particles that enter and leave while a run goes on.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "dovetail/dem/bodies/clumps.hpp"
#include "dovetail/dem/particles/particles.hpp"
#include "dovetail/dem/setup/sizes.hpp"
#include "dovetail/dem/walls/primitive_wall.hpp"
#include "dovetail/dem/walls/wall.hpp"
#include "dovetail/geometry/box.hpp"

namespace dovetail::dem {

/// Obstacles of inserted particles, beside other particles.
struct Surroundings {
  geometry::Periodicity space{};                  ///< as that of the pair list
  std::vector<const PrimitiveWall*> walls{};      ///< newcomers lie on their particles' side
  std::vector<const TriangulatedWall*> meshes{};  ///< newcomers touch no facet; of one-sided ones they lie outside
  /// Likewise, of what is put in its place when room is looked for.
  std::vector<std::function<const TriangulatedWall&()>> placed{};
};

/// Inserted particles, their region and rate: one of the two rates is > 0, or particles that leave are replaced. They
/// enter from `from` until `until`, and until one of the totals has entered.
struct InsertionOptions {
  geometry::Box region;  ///< m; whole spheres lie in it, but along a periodic axis that it spans all places are free
  Sizes sizes;           ///< of spheres
  Density density{0.0};
  /// Not empty: clumps enter in place of spheres, each shape as often, turned at random.
  std::vector<ClumpShape> shapes{};
  Vec3 velocity{};               ///< m/s
  Vec3 spin{};                   ///< rad/s
  int material = 0;              ///< row of a LawTable
  double numberPerSecond = 0.0;  ///< spheres or clumps, 1/s
  double massPerSecond = 0.0;    ///< kg/s
  bool replacesLeavers = false;  ///< particles that leave are inserted again, in place of a rate
  double from = 0.0;             ///< s, time of the model: see InsertionTerm
  double until = std::numeric_limits<double>::infinity();  ///< s
  std::int64_t totalNumber = std::numeric_limits<std::int64_t>::max();
  /// kg; the last one is left out if that comes closer.
  double totalMass = std::numeric_limits<double>::infinity();
  double interval = 0.0;  ///< s, least time between searches for free places. 0: as soon as a particle is due
  int tries = 50;         ///< places tried for each newcomer before it is refused
  std::uint64_t seed = 1;
};

/// An insertion: its settings and its state.
struct Insertion {
  InsertionOptions settings;
  RandomStream random;
  double nextRadius = 0.0;    ///< m, of the next sphere
  int nextShape = 0;          ///< of the next clump
  double due = 0.0;           ///< newcomers, or kg, that should have entered and have not been tried yet
  double waited = 0.0;        ///< s since the last search for free places
  std::int64_t inserted = 0;  ///< spheres or clumps
  std::int64_t refused = 0;   ///< those that found no free place; they are dropped, not tried again
  double insertedMass = 0.0;  ///< kg
  double refusedMass = 0.0;   ///< kg
};

/// Whether all that is to enter has entered.
bool isComplete(const Insertion& insertion);

/// @throws InputError if sizes, density, times, totals, interval or material are not valid, velocity or spin is not
///   finite, not exactly one of rates and replacement is given, tries < 1, or the region does not hold the largest
///   sphere or the widest clump
Insertion makeInsertion(const InsertionOptions& settings);

/// Inserts what is due after another dt seconds, at random places in the region where it touches no particle, no image
/// of one, and no wall; nothing once the insertion is complete. Appended particles leave the others' numbers as they
/// are. Returns how many entered.
/// @throws InputError if dt is not finite and ≥ 0, spin is wanted of particles that do not spin, or clumps are due
int insertParticles(Insertion& insertion, Particles& particles, const Surroundings& surroundings, double dt);
/// The same with clumps, if shapes are given; else spheres.
int insertParticles(Insertion& insertion, Particles& particles, Bodies& bodies, Clumps& clumps,
                    const Surroundings& surroundings, double dt);

/// Particles whose centres lie in the closed box, or outside it; ascending.
std::vector<int> particlesInside(const Particles& particles, const geometry::Box& box);
std::vector<int> particlesOutside(const Particles& particles, const geometry::Box& box);

/// Takes bodies out with all their members. Returns what removeParticles does; bodies behind those removed move up.
/// @throws InputError on a body that does not exist; nothing is removed then
std::vector<int> removeClumps(Particles& particles, Bodies& bodies, Clumps& clumps, std::span<const int> list);

}  // namespace dovetail::dem
