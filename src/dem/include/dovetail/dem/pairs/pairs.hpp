// Particle–particle contacts: which pairs are near, and what they remember.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "dovetail/dem/particles/particles.hpp"
#include "dovetail/geometry/hierarchical_grid.hpp"

namespace dovetail::dem {

/// Particles are worked on in chunks of successive numbers, one thread each. A pair belongs to the chunk of its first
/// particle; what it does to a particle of another chunk (it `crosses`) is kept and added afterwards in a fixed order.
/// Chunks depend on the number of particles only, so results do not depend on the number of threads.
struct PairChunks {
  std::size_t size = 0;              ///< particles per chunk
  std::vector<std::size_t> begin;    ///< chunk c holds pairs begin[c] … begin[c + 1] − 1
  std::vector<std::size_t> crosses;  ///< its crossing pairs are crosses[c] … crosses[c + 1] − 1 of those below
  std::vector<Vec3> force, torque;   ///< on the second particle of each crossing pair, N, N m
  std::vector<std::size_t> arrives;  ///< chunk c receives arriving[arrives[c]] … arriving[arrives[c + 1] − 1]
  std::vector<std::array<int, 2>> arriving;  ///< crossing pair, particle
  std::vector<std::size_t> images;           ///< chunk c has images[c] … images[c + 1] − 1 of PairList::images
  std::size_t count() const { return begin.empty() ? 0 : begin.size() - 1; }
};

/// A pair that meets through a periodic image.
struct PairImage {
  std::size_t pair;
  Vec3 shift;  ///< to be added to x_i − x_j, m
};

/// Pairs closer than the sum of their radii + skin when the list was made.
///
/// Two lists stand behind each other (Páll & Hess, Comput. Phys. Commun. 184, 2013, call it pruning): `candidates` come
/// from the grid and last while nobody has moved more than skin/2; of those, `pairs` are closer than the sum of their
/// radii + innerSkin, and are picked anew when somebody has moved more than innerSkin/2. The inner skin adapts
/// itself such that picking is rare. Lists of less than pruneFrom pairs are not pruned: innerSkin = skin.
struct PairList {
  double skin = 0.0;                      ///< m
  std::vector<std::array<int, 2>> pairs;  ///< i < j, sorted
  std::int64_t builds = 0;                ///< how often the grid was asked
  std::int64_t revision = 0;              ///< how often `pairs` has changed

  static constexpr std::size_t pruneFrom = 4096;
  double innerSkin = 0.0;                      ///< m
  std::vector<std::array<int, 2>> candidates;  ///< i < j, sorted; empty unless pruned
  std::vector<Vec3> positionAtPruning;         ///< empty unless pruned
  double innerTravel = 0.0;                    ///< bound on how far any particle has moved since the last pruning, m
  std::int64_t updatesSincePruning = 0;

  /// Axes along which space repeats; set before the list is made. Positions need not lie in the box.
  geometry::Periodicity periodicity;
  std::vector<PairImage> images;  ///< of the pairs that meet across a period, ascending

  /// Per pair: factor on its force and energies, such as the particles' share of an overlap; empty = 1. A new list has
  /// none; whoever set it sets it again when `revision` has changed.
  std::vector<double> scale;
  /// What the contacts remember, by component: number c of pair p is memory[c * pairs.size() + p]. A tangential spring
  /// takes three numbers, its stretch, m. Empty unless the law remembers something.
  std::vector<double> memory;
  unsigned turns = 0;  ///< of the law that last used the memory: see laws.hpp
  /// Memories (one after the other) of pairs that left the list while they remembered something; the next collide books
  /// them as lost.
  std::vector<double> ended;
  std::vector<std::array<std::uint8_t, 2>> endedMaterials;  ///< of the particles, per memory in `ended`

  std::vector<Vec3> positionAtBuild;
  double travel = 0.0;  ///< bound on how far any particle has moved since then, m; only kept by the second updatePairs
  PairChunks chunks;

  std::size_t size() const { return pairs.size(); }
  /// Vector to be added to x_i − x_j of a pair, m; zero without periodic axes. O(log n).
  Vec3 shift(std::size_t pair) const;
};

/// Makes the list anew; memories of pairs that stay are kept.
/// @throws InputError if skin is not finite and ≥ 0, or if a periodic box is too small for two particles and the skin;
///         NumericalError naming a particle whose position is not finite
void findPairs(const Particles& particles, double skin, PairList& list);

/// Makes the list anew if some particle has moved more than skin/2 since it was made, or their number changed.
/// Returns whether `pairs` has changed.
bool updatePairs(const Particles& particles, PairList& list);
/// The same without looking at every particle at every step, and with pruning.
/// @param step bound on how far any particle has moved since the last call, m, as kickAndDrift, startStep and turnStep
/// return it
bool updatePairs(const Particles& particles, PairList& list, double step);

/// Moves positions by whole periods into the periodic box. Lists made before are made anew at their next update.
void wrapPositions(Particles& particles, const geometry::Periodicity& periodicity);

/// Gives the pairs the new numbers of their particles, memories included, and sorts them; pairs of particles that are
/// gone (new number < 0) leave, and what they remember is booked as lost by the next collide. For particles that have
/// been sorted, removed or added since the list was made.
/// @param newNumber one per particle of the list
void renumber(PairList& list, std::span<const int> newNumber);

/// Makes the chunks of a list whose other parts have been read from a file.
void restoreChunks(const Particles& particles, PairList& list);

/// Sorts the particles such that near in number means near in space, which makes large scenes faster, and the list with
/// them. Returns old number → new number, for whatever else refers to particles.
std::vector<int> sortParticles(Particles& particles, PairList& list);

}  // namespace dovetail::dem
