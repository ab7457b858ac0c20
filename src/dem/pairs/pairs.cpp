#include "dovetail/dem/pairs/pairs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/pairs/pair_collide.hpp"

namespace dovetail::dem {

namespace {

using Pairs = std::vector<std::array<int, 2>>;

std::size_t chunkSize(std::size_t particles) { return std::clamp<std::size_t>(particles / 32, 1024, 4096); }

std::uint8_t materialOf(const Particles& particles, int i) {
  const auto k = static_cast<std::size_t>(i);
  return k < particles.material.size() ? particles.material[k] : std::uint8_t{0};
}

/// Memories of pairs that are in both lists; both are sorted. Takes the new list's place in `list`.
void keepMemory(const Particles& particles, const Pairs& old, PairList& list) {
  if (list.memory.empty()) return;
  const std::size_t components = list.memory.size() / std::max<std::size_t>(old.size(), 1);
  std::vector<double> memory(components * list.size());
  const auto remembered = [&](std::size_t c, std::size_t o) { return list.memory[c * old.size() + o]; };
  std::size_t p = 0;
  for (std::size_t o = 0; o < old.size(); ++o) {
    while (p < list.size() && list.pairs[p] < old[o]) ++p;
    if (p < list.size() && list.pairs[p] == old[o]) {
      for (std::size_t c = 0; c < components; ++c) memory[c * list.size() + p] = remembered(c, o);
      continue;
    }
    bool anything = false;
    for (std::size_t c = 0; c < components; ++c) anything = anything || remembered(c, o) != 0.0;
    if (!anything) continue;
    for (std::size_t c = 0; c < components; ++c) list.ended.push_back(remembered(c, o));
    list.endedMaterials.push_back({materialOf(particles, old[o][0]), materialOf(particles, old[o][1])});
  }
  list.memory = std::move(memory);
}

void findImages(const Particles& particles, PairList& list) {
  list.images.clear();
  if (!list.periodicity.any()) return;
  for (std::size_t p = 0; p < list.size(); ++p) {
    const auto [i, j] = list.pairs[p];
    const Vec3 d = particles.x[static_cast<std::size_t>(i)] - particles.x[static_cast<std::size_t>(j)];
    Vec3 shift;
    for (int k = 0; k < 3; ++k)
      if (list.periodicity.axes[static_cast<std::size_t>(k)])
        shift[k] = -list.periodicity.length(k) * std::round(d[k] / list.periodicity.length(k));
    if (squaredNorm(shift) > 0.0) list.images.push_back({p, shift});
  }
}

void countCrossings(const PairList& list, std::size_t particles, PairChunks& chunks) {
  const std::size_t count = (particles + chunks.size - 1) / chunks.size;
  chunks.begin.assign(count + 1, list.size());
  chunks.crosses.assign(count + 1, 0);
  chunks.arrives.assign(count + 1, 0);
  std::size_t p = 0;
  for (std::size_t c = 0; c < count; ++c) {
    chunks.begin[c] = p;
    chunks.crosses[c + 1] = chunks.crosses[c];
    for (const auto end = (c + 1) * chunks.size; p < list.size() && static_cast<std::size_t>(list.pairs[p][0]) < end;
         ++p)
      if (const auto j = static_cast<std::size_t>(list.pairs[p][1]); j >= end) {
        ++chunks.crosses[c + 1];
        ++chunks.arrives[j / chunks.size + 1];
      }
  }
  for (std::size_t c = 0; c < count; ++c) chunks.arrives[c + 1] += chunks.arrives[c];
}

void makeChunks(std::size_t particles, PairList& list) {
  PairChunks& chunks = list.chunks;
  chunks.size = chunkSize(particles);
  countCrossings(list, particles, chunks);
  const std::size_t crossings = chunks.crosses.back();
  chunks.force.resize(crossings);
  chunks.torque.clear();
  chunks.images.assign(1, 0);
  for (std::size_t c = 0; c < chunks.count(); ++c) {
    std::size_t k = chunks.images.back();
    while (k < list.images.size() && list.images[k].pair < chunks.begin[c + 1]) ++k;
    chunks.images.push_back(k);
  }
  chunks.arriving.resize(crossings);
  std::vector<std::size_t> next(chunks.arrives.begin(), chunks.arrives.end() - 1);
  int crossing = 0;
  for (std::size_t c = 0; c + 1 < chunks.begin.size(); ++c)
    for (std::size_t p = chunks.begin[c]; p < chunks.begin[c + 1]; ++p)
      if (const auto j = static_cast<std::size_t>(list.pairs[p][1]); j >= (c + 1) * chunks.size)
        chunks.arriving[next[j / chunks.size]++] = {crossing++, list.pairs[p][1]};
}

/// Largest displacement, m; NaN if a position is not finite.
double largestTravel(const Particles& particles, const std::vector<Vec3>& from) {
  double squared = 0.0;
  for (std::size_t i = 0; i < particles.size() && !std::isnan(squared); ++i) {
    const double d2 = squaredNorm(particles.x[i] - from[i]);
    if (!(d2 <= squared)) squared = d2;
  }
  return std::sqrt(squared);
}

bool fits(const Particles& particles, const PairList& list) {
  return list.builds > 0 && list.positionAtBuild.size() == particles.size();
}

}  // namespace

Vec3 PairList::shift(std::size_t pair) const {
  const auto found = std::lower_bound(images.begin(), images.end(), pair,
                                      [](const PairImage& image, std::size_t p) { return image.pair < p; });
  return found != images.end() && found->pair == pair ? found->shift : Vec3{};
}

namespace {

/// Puts `pairs` in the place of the list's, and makes anew what hangs on them.
void take(const Particles& particles, Pairs&& pairs, PairList& list) {
  const Pairs old = std::exchange(list.pairs, std::move(pairs));
  keepMemory(particles, old, list);
  findImages(particles, list);
  makeChunks(particles.size(), list);
  list.scale.clear();
  ++list.revision;
}

Pairs closerThan(double gap, const Particles& particles, const PairList& list) {
  Pairs close;
  close.reserve(list.pairs.size() + list.pairs.size() / 16);
  for (const auto& pair : list.candidates) {
    const auto i = static_cast<std::size_t>(pair[0]), j = static_cast<std::size_t>(pair[1]);
    Vec3 d = particles.x[i] - particles.x[j];
    if (list.periodicity.any()) d = list.periodicity.minimumImage(d);
    const double reach = particles.radius[i] + particles.radius[j] + gap;
    if (squaredNorm(d) <= reach * reach) close.push_back(pair);
  }
  return close;
}

/// A pruning should last a few tens of steps: longer lists cost at every step, picking costs now.
void adaptInnerSkin(PairList& list) {
  constexpr double smallest = 0.05, largest = 0.8, first = 0.25;  // of the skin
  if (list.innerSkin <= 0.0)
    list.innerSkin = first * list.skin;
  else if (list.updatesSincePruning < 15)
    list.innerSkin *= 1.5;
  else if (list.updatesSincePruning > 60)
    list.innerSkin *= 0.75;
  list.innerSkin = std::clamp(list.innerSkin, smallest * list.skin, largest * list.skin);
}

void prune(const Particles& particles, PairList& list) {
  adaptInnerSkin(list);
  list.innerTravel = 0.0;
  list.positionAtPruning = particles.x;
  list.updatesSincePruning = 0;
  take(particles, closerThan(list.innerSkin, particles, list), list);
}

}  // namespace

void findPairs(const Particles& particles, double skin, PairList& list) {
  list.skin = requireNonNegative(skin, "skin of the pair list");
  requireFinite(particles.x, "particle", "position", "search for pairs");
  geometry::HierarchicalGrid grid(list.periodicity);  // not kept: it takes as much memory as the list
  grid.build(particles.x, particles.radius, skin);
  list.positionAtBuild = particles.x;
  list.travel = 0.0;
  ++list.builds;
  Pairs found;
  grid.pairs(found);
  list.candidates.clear();
  list.positionAtPruning.clear();
  list.innerSkin = found.size() < PairList::pruneFrom || skin == 0.0 ? skin
                   : list.innerSkin < skin                           ? list.innerSkin
                                                                     : 0.0;
  if (list.innerSkin == skin) return take(particles, std::move(found), list);
  list.candidates = std::move(found);
  prune(particles, list);
}

// Comparisons are written so that a NaN asks for a new list, which then names the culprit.
bool updatePairs(const Particles& particles, PairList& list) {
  return updatePairs(particles, list, std::numeric_limits<double>::infinity());
}

bool updatePairs(const Particles& particles, PairList& list, double step) {
  if (!fits(particles, list)) {
    findPairs(particles, list.skin, list);
    return true;
  }
  const bool pruned = list.innerSkin < list.skin;
  list.travel += step;
  list.innerTravel += step;
  ++list.updatesSincePruning;
  if (!(list.travel <= 0.5 * list.skin)) {
    list.travel = largestTravel(particles, list.positionAtBuild);
    if (!(list.travel <= 0.5 * list.skin)) {
      findPairs(particles, list.skin, list);
      return true;
    }
  }
  if (!pruned || list.innerTravel <= 0.5 * list.innerSkin) return false;
  list.innerTravel = largestTravel(particles, list.positionAtPruning);
  if (list.innerTravel <= 0.5 * list.innerSkin) return false;
  prune(particles, list);
  return true;
}

void restoreChunks(const Particles& particles, PairList& list) {
  if (list.builds > 0) makeChunks(particles.size(), list);
}

void wrapPositions(Particles& particles, const geometry::Periodicity& periodicity) {
  for (int k = 0; k < 3; ++k) {
    if (!periodicity.axes[static_cast<std::size_t>(k)]) continue;
    const double length = periodicity.length(k), lower = periodicity.box.lower[k];
    for (Vec3& x : particles.x) x[k] -= length * std::floor((x[k] - lower) / length);
  }
}

void renumber(PairList& list, std::span<const int> newNumber) {
  const Pairs old = std::move(list.pairs);
  const std::size_t components = old.empty() ? 0 : list.memory.size() / old.size();
  struct Entry {
    std::array<int, 2> pair;
    std::size_t from;
    bool swapped;
  };
  std::vector<Entry> entries;
  entries.reserve(old.size());
  for (std::size_t p = 0; p < old.size(); ++p) {
    const int i = newNumber[static_cast<std::size_t>(old[p][0])], j = newNumber[static_cast<std::size_t>(old[p][1])];
    if (i >= 0 && j >= 0) {
      entries.push_back({{std::min(i, j), std::max(i, j)}, p, i > j});
      continue;
    }
    // Whose material it was is not known any more: booked as of material 0.
    for (std::size_t c = 0; c < components; ++c) list.ended.push_back(list.memory[c * old.size() + p]);
    if (components > 0) list.endedMaterials.push_back({0, 0});
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.pair < b.pair; });
  const std::vector<double> memory = std::move(list.memory);
  list.memory.assign(components * entries.size(), 0.0);
  list.pairs.clear();
  for (const Entry& e : entries) {
    for (std::size_t c = 0; c < components; ++c) {
      const bool turns = e.swapped && (list.turns >> c & 1u) != 0;
      list.memory[c * entries.size() + list.pairs.size()] = (turns ? -1.0 : 1.0) * memory[c * old.size() + e.from];
    }
    list.pairs.push_back(e.pair);
  }
}

}  // namespace dovetail::dem
