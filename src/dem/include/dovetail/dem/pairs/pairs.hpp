// Particle–particle contacts: which pairs are near, and what they remember.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "dovetail/dem/particles/particles.hpp"
#include "dovetail/geometry/hierarchical_grid.hpp"

namespace dovetail::dem {

/// Particles are worked on in chunks of successive numbers, one thread each. A pair belongs to the chunk of its first
/// particle; what it does to a particle of another chunk (it `crosses`) is kept and added afterwards in a fixed order.
/// Chunks depend on the number of particles only, so results do not depend on the number of threads; sorted particles
/// make them blocks of space.
struct PairChunks {
  std::size_t size = 0;              ///< particles per chunk
  std::vector<std::size_t> begin;    ///< chunk c holds pairs begin[c] … begin[c + 1] − 1
  std::vector<std::size_t> crosses;  ///< its crossing pairs are crosses[c] … crosses[c + 1] − 1 of those below
  RawVector<Vec3> force, torque;     ///< on the second particle of each crossing pair, N, N m
  std::vector<std::size_t> arrives;  ///< chunk c receives arriving[arrives[c]] … arriving[arrives[c + 1] − 1]
  RawVector<std::array<int, 2>> arriving;  ///< crossing pair, particle
  std::vector<int> largest;                ///< number of a particle in the pairs of the chunk
  std::vector<std::size_t> images;         ///< chunk c has images[c] … images[c + 1] − 1 of PairList::images
  std::vector<std::size_t> candidates;     ///< and candidates[c] … candidates[c + 1] − 1 of PairList::candidates
  std::size_t count() const { return begin.empty() ? 0 : begin.size() - 1; }
};

/// A pair that meets through a periodic image.
struct PairImage {
  std::size_t pair;
  std::array<std::int8_t, 3> periods;  ///< to be added to x_i − x_j, in periods along the axes
};

/// A pair that has left the list while it remembered something, or was loaded.
struct EndedPair {
  std::array<std::uint8_t, 2> materials;
  double factor;
  double overlap;  ///< m, of a pair that went with a particle; −∞ of others, which do not touch
  double effectiveMass, effectiveRadius;
};

using Pairs = geometry::SpherePairs;

/// Pairs closer than the sum of their radii + skin when the list was made.
///
/// Two lists stand behind each other (Páll & Hess, Comput. Phys. Commun. 184, 2013, call it pruning): `candidates` come
/// from the grid and last while nobody has moved more than skin/2; of those, `pairs` are closer than the sum of their
/// radii + innerSkin, and are picked anew when somebody has moved more than innerSkin/2. The inner skin adapts
/// itself: the longer the candidates last, the thinner it is, and the fewer pairs that do not touch are listed. Lists
/// of less than pruneFrom pairs are not pruned: innerSkin = skin.
struct PairList {
  /// m; 0 = a search at every step. Not set: defaultSkin mean diameters, from the first search on.
  std::optional<double> skin;
  static constexpr double defaultSkin = 0.15;
  double reach = 0.0;         ///< m: of the law beyond touch, see ContactLaws::reach; adds to the skins
  Pairs pairs;                ///< i < j, sorted
  std::int64_t builds = 0;    ///< how often the grid was asked
  std::int64_t revision = 0;  ///< how often `pairs` has changed

  static constexpr std::size_t pruneFrom = 4096;
  double innerSkin = 0.0;               ///< m
  Pairs candidates;                     ///< i < j, sorted; empty unless pruned
  std::vector<Vec3> positionAtPruning;  ///< empty unless pruned
  double innerTravel = 0.0;             ///< bound on how far any particle has moved since the last pruning, m
  std::int64_t updatesSincePruning = 0;

  /// Axes along which space repeats; set before the list is made. Each search moves particles into the box, so that
  /// they leave it by no more than the skin.
  geometry::Periodicity periodicity;
  std::vector<PairImage> images;  ///< of the pairs that meet across a period, ascending

  /// Per pair: factor on its force and energies, such as the particles' share of an overlap, 0 = muted; empty = 1. Kept
  /// while a pair stays in the list; a newcomer has 1 until somebody sets it, which is due when `revision` has changed.
  RawVector<double> scale;
  /// What the contacts remember, by component: number c of pair p is memory[c * pairs.size() + p]. A tangential spring
  /// takes three numbers, its stretch, m. Empty unless the law remembers something.
  RawVector<double> memory;
  unsigned turns = 0;  ///< of the law that last used the memory: see laws.hpp
  /// Pairs that left the list, and their memories one after the other; the next collide books them as lost.
  std::vector<EndedPair> endedPairs;
  std::vector<double> ended;

  std::int64_t particleRevision = -1;  ///< Particles::revision when the list was made
  std::int64_t wraps = 0;              ///< Particles::wraps then
  std::vector<Vec3> positionAtBuild;
  double travel = 0.0;  ///< bound on how far any particle has moved since then, m; only kept by the second updatePairs
  PairChunks chunks;

  std::size_t size() const { return pairs.size(); }
  /// Whether the list was made for the particles as they are numbered now.
  bool fits(const Particles& particles) const;
  /// Vector to be added to x_i − x_j of a pair, m; zero without periodic axes. O(log n).
  Vec3 shift(std::size_t pair) const;
  Vec3 shift(const PairImage& image) const {
    Vec3 d;
    for (int k = 0; k < 3; ++k)
      if (const int n = image.periods[static_cast<std::size_t>(k)]; n != 0) d[k] = n * periodicity.length(k);
    return d;
  }
};

/// Moves particles into the periodic box and makes the list anew; memories and factors of pairs that stay are kept.
/// @param skin as PairList::skin, which it becomes
/// @throws InputError if skin is not finite and ≥ 0, or if a periodic box is too small for two particles and the skin;
///         NumericalError naming a particle whose position is not finite
void findPairs(Particles& particles, std::optional<double> skin, PairList& list);

/// Makes the list anew if some particle has moved more than skin/2 since it was made, or if particles have been
/// numbered or wrapped anew. Returns whether `pairs` has changed.
bool updatePairs(Particles& particles, PairList& list);
/// The same without looking at every particle at every step, and with pruning.
/// @param step bound on how far any particle has moved since the last call, m, as kickAndDrift, startStep and turnStep
/// return it
bool updatePairs(Particles& particles, PairList& list, double step);

/// Moves positions by whole periods into the periodic box. Pair lists made before are made anew at their next update,
/// and keep their memories.
void wrapPositions(Particles& particles, const geometry::Periodicity& periodicity);

/// Gives the pairs the new numbers of their particles, memories and factors included, and sorts them. Pairs of
/// particles that go (new number < 0) leave: what they remember, and their elastic energy, is booked as lost by the
/// next collide.
/// @param newNumber one per particle of the list
/// @param before    the particles as they are numbered until now, those that go included
void renumber(PairList& list, std::span<const int> newNumber, const Particles& before);

/// For lists that stay as they are, of laws that bond them: makes anew what hangs on the particles' numbers and number,
/// after renumber, and after particles have been added, which get no pairs. Images are the nearest ones.
void keepPairs(const Particles& particles, PairList& list);

/// Makes the chunks of a list whose other parts have been read from a file.
void restoreChunks(const Particles& particles, PairList& list);

/// Sorts the particles along a space-filling curve, so that near in number means near in space, and makes the list anew
/// if there is one. Returns old number → new number, for whatever else refers to particles.
std::vector<int> sortParticles(Particles& particles, PairList& list);

namespace detail {

/// Picks the pairs from the candidates.
void prunePairs(const Particles& particles, PairList& list);
/// Takes the pairs from a grid that holds the particles with this skin, and remembers where they are.
void takeFound(const Particles& particles, const geometry::HierarchicalGrid& grid, double skin, PairList& list);
/// The skin that is set, or the default, which is set then.
double skinOf(const Particles& particles, PairList& list);
void makeChunks(std::size_t particles, PairList& list);

}  // namespace detail

}  // namespace dovetail::dem
