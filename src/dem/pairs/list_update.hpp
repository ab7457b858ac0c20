// How a list is made anew, chunk by chunk.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "dovetail/dem/pairs/pairs.hpp"

namespace dovetail::dem::detail {

using Pair = std::array<int, 2>;

/// Particles per chunk.
std::size_t chunkSize(std::size_t particles);
/// Ranges of sorted pairs that belong to the chunks.
void findRanges(std::size_t particles, const Pairs& sorted, std::vector<std::size_t>& begin);

/// How often space repeats between the particles of a pair.
struct Repeats {
  bool any = false;
  std::array<std::int8_t, 3> periods{};  ///< to be added to d
};
inline Repeats repeatsOf(const geometry::Periodicity& periodicity, const Vec3& d) {
  Repeats repeats;
  for (int k = 0; k < 3; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    if (!periodicity.axes[axis] || std::abs(d[k]) < 0.5 * periodicity.length(k)) continue;
    repeats.periods[axis] = static_cast<std::int8_t>(-std::round(d[k] / periodicity.length(k)));
    repeats.any = repeats.any || repeats.periods[axis] != 0;
  }
  return repeats;
}

/// What belonged to the pairs of a list, taken out of it.
struct Belongings {
  RawVector<double> memory, factors, motion;
  std::size_t pairs, components, motions;  ///< numbers of the memory, and of the motion, of a pair

  Belongings(PairBelongings& of, std::size_t count);
  bool empty() const { return memory.empty() && factors.empty() && motion.empty(); }
  double factor(std::size_t p) const { return factors.empty() ? 1.0 : factors[p]; }
  double remembered(std::size_t c, std::size_t p) const { return memory[c * pairs + p]; }
  bool remembersAnything(std::size_t p) const;
  /// Of so many pairs.
  void makeRoom(std::size_t count, PairParts& list) const;
  /// To as many successive pairs of a list that has room for them.
  void hand(std::size_t o, std::size_t p, std::size_t count, PairParts& list) const;
  void end(const EndedPair& pair, std::size_t p, EndedPairs& ended) const;
};

/// Hands what the old pairs remember to those of the new ones that are the same, one chunk of the list after the
/// other; collects what leaves.
void carryChunk(const Particles& particles, const Pairs& old, const Belongings& from, std::size_t chunk,
                PairParts& list, EndedPairs& ended);
void append(const std::vector<EndedPairs>& parts, EndedPairs& all);

/// What a chunk's pairs have to do with others, found chunk by chunk.
struct Links {
  std::vector<std::vector<int>> crossers;  ///< second particles of the crossing pairs
  std::vector<std::vector<PairImage>> images;
  std::vector<int> largest;  ///< numbers of particles

  explicit Links(std::size_t chunks) : crossers(chunks), images(chunks), largest(chunks) {}
  void findCrossers(const ListedPairs& list, std::size_t chunk);
  /// Makes PairChunks' tables of them.
  void join(ListedPairs& list);
};

/// Makes the chunks of a list whose pairs and images are there.
void makeChunks(std::size_t particles, ListedPairs& list);

/// Picks the pairs from the candidates.
void prunePairs(const Particles& particles, PairParts& list);
/// Takes the pairs from a grid that holds the particles with this skin, and remembers where they are.
void takeFound(const Particles& particles, const geometry::HierarchicalGrid& grid, double skin, PairParts& list);

}  // namespace dovetail::dem::detail
