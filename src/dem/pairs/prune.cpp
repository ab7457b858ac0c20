// Which candidates become pairs.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "dovetail/core/large_pages.hpp"
#include "dovetail/core/parallel.hpp"
#include "list_update.hpp"

namespace dovetail::dem::detail {

namespace {

constexpr std::size_t particleChunk = 4096;
enum Mark : std::uint8_t { close = 1, repeats = 2 };

void copyPositions(const Particles& particles, std::vector<Vec3>& to) {
  to.resize(particles.size());
  parallelFor(particles.size(), particleChunk, [&](std::size_t begin, std::size_t end) {
    std::copy(particles.x.begin() + static_cast<std::ptrdiff_t>(begin),
              particles.x.begin() + static_cast<std::ptrdiff_t>(end), to.begin() + static_cast<std::ptrdiff_t>(begin));
  });
}

Vec3 between(const Particles& particles, const Pair& pair) {
  return particles.x[static_cast<std::size_t>(pair[0])] - particles.x[static_cast<std::size_t>(pair[1])];
}

/// Marks candidates that are closer than the sum of their radii + gap; returns how many.
template <bool periodic>
std::size_t markClose(const Particles& particles, const PairParts& list, std::size_t begin, std::size_t end, double gap,
                      std::uint8_t* marks) {
  std::size_t count = 0;
  for (std::size_t c = begin; c < end; ++c) {
    const Pair pair = list.candidates[c];
    Vec3 d = between(particles, pair);
    std::uint8_t mark = 0;
    if constexpr (periodic)
      if (const Repeats found = repeatsOf(list.periodicity, d); found.any) {
        mark = repeats;
        for (std::size_t k = 0; k < 3; ++k)
          if (found.periods[k] != 0)
            d[static_cast<int>(k)] += found.periods[k] * list.periodicity.length(static_cast<int>(k));
      }
    const double reach =
        particles.radius[static_cast<std::size_t>(pair[0])] + particles.radius[static_cast<std::size_t>(pair[1])] + gap;
    const bool near = squaredNorm(d) <= reach * reach;
    marks[c] = near ? mark | close : 0;
    count += near ? 1 : 0;
  }
  return count;
}

struct Marked {
  RawVector<std::uint8_t> marks;   ///< per candidate
  std::vector<std::size_t> begin;  ///< of the pairs of each chunk
};

Marked markCandidates(const Particles& particles, const PairParts& list, double gap) {
  const auto& from = list.chunks.candidates;
  const std::size_t chunks = from.size() - 1;
  Marked marked{RawVector<std::uint8_t>(list.candidates.size()), std::vector<std::size_t>(chunks + 1, 0)};
  const auto mark = list.periodicity.any() ? markClose<true> : markClose<false>;
  parallelFor(chunks, 1, [&](std::size_t c, std::size_t) {
    marked.begin[c + 1] = mark(particles, list, from[c], from[c + 1], gap, marked.marks.data());
  });
  for (std::size_t c = 0; c < chunks; ++c) marked.begin[c + 1] += marked.begin[c];
  return marked;
}

PairImage imageOf(const Particles& particles, const PairParts& list, std::size_t p) {
  return {p, repeatsOf(list.periodicity, between(particles, list.pairs[p])).periods};
}

/// The marked candidates of a chunk become its pairs.
void fillChunk(const Particles& particles, const Marked& marked, std::size_t chunk, PairParts& list,
               std::vector<PairImage>& images) {
  std::size_t p = list.chunks.begin[chunk];
  const std::size_t end = list.chunks.begin[chunk + 1];
  for (std::size_t c = list.chunks.candidates[chunk]; p < end; ++c) {
    const std::uint8_t mark = marked.marks[c];
    list.pairs[p] = list.candidates[c];
    if (mark == (close | repeats)) images.push_back(imageOf(particles, list, p));
    p += mark & close;
  }
}

void findImages(const Particles& particles, const PairParts& list, std::size_t chunk, std::vector<PairImage>& images) {
  if (!list.periodicity.any()) return;
  for (std::size_t p = list.chunks.begin[chunk]; p < list.chunks.begin[chunk + 1]; ++p)
    if (repeatsOf(list.periodicity, between(particles, list.pairs[p])).any)
      images.push_back(imageOf(particles, list, p));
}

/// Fills the chunks of a list that has room for its pairs, and gives them what the old pairs had.
/// @param fill fill(chunk, images) writes the chunk's pairs and lists those that meet across a period
template <class Fill>
void updateChunks(const Particles& particles, const Pairs& old, PairParts& list, Fill&& fill) {
  const std::size_t chunks = list.chunks.count();
  const Belongings from(list, old.size());
  from.makeRoom(list.size(), list);
  std::vector<EndedPairs> ended(chunks);
  Links links(chunks);
  parallelFor(chunks, 1, [&](std::size_t c, std::size_t) {
    fill(c, links.images[c]);
    links.findCrossers(list, c);
    if (!from.empty()) carryChunk(particles, old, from, c, list, ended[c]);
  });
  append(ended, list.ended);
  links.join(list);
  ++list.revision;
}

/// Takes all that was found.
void takeAll(const Particles& particles, Pairs&& pairs, PairParts& list) {
  list.pairs.swap(pairs);
  list.chunks.size = chunkSize(particles.size());
  findRanges(particles.size(), list.pairs, list.chunks.begin);
  updateChunks(particles, pairs, list, [&](std::size_t c, auto& images) { findImages(particles, list, c, images); });
}

/// A thin inner skin lists few pairs that do not touch, but lasts shortly. With n prunings in the life of L steps that
/// the candidates have, the prunings cost as n/L and the pairs within the skin as 1/n: least for n ~ √L, where the
/// factor says that a pruning costs about 1.4 times as much as a step spends on the pairs of the whole skin.
void adaptInnerSkin(PairParts& list) {
  constexpr double factor = 0.7, fewest = 2.0, most = 20.0, first = 4.0;
  constexpr double slack = 1.1;  // so that the candidates are used up before the last pruning is
  double prunings = first;
  if (list.innerSkin > 0.0) {
    if (list.updatesSincePruning == 0) return;
    const double life = static_cast<double>(list.updatesSincePruning) * 0.5 * *list.skin / list.innerTravel;
    prunings = std::clamp(std::round(std::sqrt(factor * life)), fewest, most);
  }
  list.innerSkin = slack * *list.skin / prunings;
}

}  // namespace

void prunePairs(const Particles& particles, PairParts& list) {
  adaptInnerSkin(list);
  list.innerTravel = 0.0;
  copyPositions(particles, list.positionAtPruning);
  list.updatesSincePruning = 0;
  Marked marked = markCandidates(particles, list, list.innerSkin + list.reach);
  list.chunks.size = chunkSize(particles.size());
  list.chunks.begin.swap(marked.begin);
  const Pairs old = std::exchange(list.pairs, Pairs(list.chunks.begin.back()));
  updateChunks(particles, old, list,
               [&](std::size_t c, auto& images) { fillChunk(particles, marked, c, list, images); });
}

/// Arrays that each step goes through.
void preferLargePagesFor(const Particles& particles, const PairParts& list) {
  forEachArray(particles, [](const auto& array) { preferLargePages(array); });
  preferLargePages(list.pairs);
  preferLargePages(list.memory);
  preferLargePages(list.motion);
  preferLargePages(list.factors);
}

void takeFound(const Particles& particles, const geometry::HierarchicalGrid& grid, double skin, PairParts& list) {
  copyPositions(particles, list.positionAtBuild);
  list.particleRevision = particles.revision;
  list.wraps = particles.wraps;
  list.outdated = false;
  list.travel = 0.0;
  ++list.builds;
  list.candidates = {};
  Pairs found = grid.pairs();
  const bool prunes = found.size() >= PairList::pruneFrom && skin > 0.0;
  if (!prunes) {
    list.positionAtPruning = {};
    list.innerSkin = skin;
    takeAll(particles, std::move(found), list);
    return preferLargePagesFor(particles, list);
  }
  if (!(list.innerSkin < skin)) list.innerSkin = 0.0;
  list.candidates = std::move(found);
  findRanges(particles.size(), list.candidates, list.chunks.candidates);
  prunePairs(particles, list);
  preferLargePagesFor(particles, list);
}

}  // namespace dovetail::dem::detail

namespace dovetail::dem {

void keepPairs(const Particles& particles, PairList& of) {
  detail::PairParts& list = detail::partsOf(of);
  list.travel = std::numeric_limits<double>::infinity();  // nobody looks: whoever updates it must search
  if (of.fits(particles)) return;
  list.candidates = {};
  list.positionAtPruning = {};
  list.positionAtBuild = particles.x;
  list.particleRevision = particles.revision;
  list.wraps = particles.wraps;
  list.outdated = false;
  list.chunks.size = detail::chunkSize(particles.size());
  detail::findRanges(particles.size(), list.pairs, list.chunks.begin);
  detail::Links links(list.chunks.count());
  parallelFor(list.chunks.count(), 1, [&](std::size_t c, std::size_t) {
    links.findCrossers(list, c);
    detail::findImages(particles, list, c, links.images[c]);
  });
  links.join(list);
  ++list.revision;
}

}  // namespace dovetail::dem
