// Which candidates become pairs.
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "dovetail/core/large_pages.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/pairs/pairs.hpp"

namespace dovetail::dem::detail {

namespace {

using Pair = std::array<int, 2>;
using Pairs = std::vector<Pair>;
constexpr std::size_t grain = 4096;

void copyPositions(const Particles& particles, std::vector<Vec3>& to) {
  to.resize(particles.size());
  parallelFor(particles.size(), grain, [&](std::size_t begin, std::size_t end) {
    std::copy(particles.x.begin() + static_cast<std::ptrdiff_t>(begin),
              particles.x.begin() + static_cast<std::ptrdiff_t>(end), to.begin() + static_cast<std::ptrdiff_t>(begin));
  });
}

/// Candidates of a chunk that are close; returns how many.
std::size_t pick(const Particles& particles, const PairList& list, std::size_t chunk, double gap, Pair* close) {
  const bool periodic = list.periodicity.any();
  std::size_t count = 0;
  for (std::size_t c = list.chunks.candidates[chunk]; c < list.chunks.candidates[chunk + 1]; ++c) {
    const Pair pair = list.candidates[c];
    const auto i = static_cast<std::size_t>(pair[0]), j = static_cast<std::size_t>(pair[1]);
    Vec3 d = particles.x[i] - particles.x[j];
    if (periodic) d = list.periodicity.minimumImage(d);
    const double reach = particles.radius[i] + particles.radius[j] + gap;
    close[count] = pair;
    count += squaredNorm(d) <= reach * reach ? 1 : 0;
  }
  return count;
}

Pairs closerThan(double gap, const Particles& particles, const PairList& list) {
  const auto& begin = list.chunks.candidates;
  const std::size_t chunks = begin.size() - 1;
  const auto close = std::make_unique_for_overwrite<Pair[]>(list.candidates.size() + 1);
  std::vector<std::size_t> place(chunks + 1, 0);
  parallelFor(chunks, 1, [&](std::size_t c, std::size_t) {
    place[c + 1] = pick(particles, list, c, gap, close.get() + begin[c]);
  });
  for (std::size_t c = 0; c < chunks; ++c) place[c + 1] += place[c];
  Pairs pairs(place.back());
  parallelFor(chunks, 1, [&](std::size_t c, std::size_t) {
    std::copy_n(close.get() + begin[c], place[c + 1] - place[c], pairs.data() + place[c]);
  });
  return pairs;
}

/// A pruning should last a few tens of steps: longer lists cost at every step, picking costs now.
void adaptInnerSkin(PairList& list) {
  constexpr double smallest = 0.05, largest = 0.8, first = 0.25;  // of the skin
  if (list.innerSkin <= 0.0)
    list.innerSkin = first * *list.skin;
  else if (list.updatesSincePruning < 15)
    list.innerSkin *= 1.5;
  else if (list.updatesSincePruning > 60)
    list.innerSkin *= 0.75;
  list.innerSkin = std::clamp(list.innerSkin, smallest * *list.skin, largest * *list.skin);
}

}  // namespace

void prunePairs(const Particles& particles, PairList& list) {
  adaptInnerSkin(list);
  list.innerTravel = 0.0;
  copyPositions(particles, list.positionAtPruning);
  list.updatesSincePruning = 0;
  takePairs(particles, closerThan(list.innerSkin + list.reach, particles, list), list);
}

/// Arrays that each step goes through.
void preferLargePagesFor(const Particles& particles, const PairList& list) {
  forEachArray(particles, [](const auto& array) { preferLargePages(array); });
  preferLargePages(list.pairs);
  preferLargePages(list.memory);
  preferLargePages(list.scale);
}

void takeFound(const Particles& particles, const geometry::HierarchicalGrid& grid, double skin, PairList& list) {
  copyPositions(particles, list.positionAtBuild);
  list.particleRevision = particles.revision;
  list.wraps = particles.wraps;
  list.travel = 0.0;
  ++list.builds;
  Pairs found = std::move(list.candidates);
  found.clear();
  grid.pairs(found);
  const bool prunes = found.size() >= PairList::pruneFrom && skin > 0.0;
  if (!prunes) {
    list.candidates = {};
    list.positionAtPruning = {};
    list.innerSkin = skin;
    takePairs(particles, std::move(found), list);
    return preferLargePagesFor(particles, list);
  }
  if (!(list.innerSkin < skin)) list.innerSkin = 0.0;
  list.candidates = std::move(found);
  findRanges(particles.size(), list.candidates, list.chunks.candidates);
  prunePairs(particles, list);
  preferLargePagesFor(particles, list);
}

}  // namespace dovetail::dem::detail
