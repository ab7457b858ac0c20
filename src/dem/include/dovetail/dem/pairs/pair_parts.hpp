// What a list of pairs consists of: who may meet, which pairs there are, and what stays with them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "dovetail/core/vec3.hpp"
#include "dovetail/geometry/hierarchical_grid.hpp"

namespace dovetail::dem {

using Pairs = geometry::SpherePairs;

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

/// Such pairs, and what they remembered one after the other.
struct EndedPairs {
  std::vector<EndedPair> pairs;
  std::vector<double> memory;
};

namespace detail {

/// What users set: see PairList.
struct PairOptions {
  std::optional<double> skin;
  double reach = 0.0;
  geometry::Periodicity periodicity;
};

/// Who may meet, and until when.
struct PairSearch {
  std::int64_t particleRevision = -1;   ///< Particles::revision when the list was made
  std::int64_t wraps = 0;               ///< Particles::wraps then
  bool outdated = false;                ///< the settings have changed since then
  std::vector<Vec3> positionAtBuild;    ///< m
  double travel = 0.0;                  ///< bound on how far any particle has moved since then, m; ∞ in a kept list
  Pairs candidates;                     ///< i < j, sorted; empty unless pruned
  std::vector<Vec3> positionAtPruning;  ///< m; empty unless pruned
  double innerTravel = 0.0;             ///< as travel, since the last pruning, m
  double innerSkin = 0.0;               ///< m; the skin, unless pruned
  std::int64_t updatesSincePruning = 0;
  std::size_t particles() const { return positionAtBuild.size(); }  ///< for how many it was made
  bool pruned() const { return !positionAtPruning.empty(); }
};

/// Which pairs there are.
struct ListedPairs {
  Pairs pairs;                    ///< i < j, sorted
  std::vector<PairImage> images;  ///< of the pairs that meet across a period, ascending
  PairChunks chunks;
  std::int64_t builds = 0;    ///< how often the grid was asked
  std::int64_t revision = 0;  ///< how often `pairs` has changed
  std::size_t size() const { return pairs.size(); }
};

/// What stays with a pair while it is listed.
struct PairBelongings {
  RawVector<double> factors;  ///< one per pair; empty = 1
  RawVector<double> memory;   ///< number c of pair p is memory[c * pairs.size() + p]
  unsigned turns = 0;         ///< of the law that last used the memory: see laws.hpp
  unsigned memoryKind = 0;    ///< of the same law
  RawVector<double> motion;   ///< of velocities of the last step, by component as memory: see Recall
  bool motionTurns = false;   ///< they change their signs when the two particles change roles
  EndedPairs ended;           ///< whom nobody has booked yet
};

/// The whole, for the functions that make lists and go through them.
struct PairParts : PairOptions, PairSearch, ListedPairs, PairBelongings {};

/// Vector to be added to x_i − x_j, m.
inline Vec3 shiftOf(const geometry::Periodicity& periodicity, const PairImage& image) {
  Vec3 d;
  for (int k = 0; k < 3; ++k)
    if (const int n = image.periods[static_cast<std::size_t>(k)]; n != 0) d[k] = n * periodicity.length(k);
  return d;
}

}  // namespace detail

}  // namespace dovetail::dem
