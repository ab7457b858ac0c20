// Who works on which pairs.
#include <algorithm>
#include <cmath>

#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/pairs/pairs.hpp"

namespace dovetail::dem {

Vec3 PairList::shift(std::size_t pair) const {
  const auto found = std::lower_bound(images.begin(), images.end(), pair,
                                      [](const PairImage& image, std::size_t p) { return image.pair < p; });
  return found != images.end() && found->pair == pair ? shift(*found) : Vec3{};
}

namespace detail {

namespace {

using Pairs = std::vector<std::array<int, 2>>;

/// The images among the pairs [begin, end).
std::vector<PairImage> imagesAmong(const Particles& particles, const PairList& list, std::size_t begin,
                                   std::size_t end) {
  std::vector<PairImage> images;
  for (std::size_t p = begin; p < end; ++p) {
    const auto [i, j] = list.pairs[p];
    const Vec3 d = particles.x[static_cast<std::size_t>(i)] - particles.x[static_cast<std::size_t>(j)];
    PairImage image{p, {}};
    bool any = false;
    for (std::size_t k = 0; k < 3; ++k) {
      if (!list.periodicity.axes[k]) continue;
      const double periods = std::round(d[static_cast<int>(k)] / list.periodicity.length(static_cast<int>(k)));
      image.periods[k] = static_cast<std::int8_t>(-periods);
      any = any || periods != 0.0;
    }
    if (any) images.push_back(image);
  }
  return images;
}

void findImages(const Particles& particles, PairList& list) {
  PairChunks& chunks = list.chunks;
  list.images.clear();
  chunks.images.assign(chunks.count() + 1, 0);
  if (!list.periodicity.any()) return;
  std::vector<std::vector<PairImage>> found(chunks.count());
  parallelFor(chunks.count(), 1, [&](std::size_t c, std::size_t) {
    found[c] = imagesAmong(particles, list, chunks.begin[c], chunks.begin[c + 1]);
  });
  for (std::size_t c = 0; c < chunks.count(); ++c) {
    list.images.insert(list.images.end(), found[c].begin(), found[c].end());
    chunks.images[c + 1] = list.images.size();
  }
}

/// Second particles of a chunk's crossing pairs.
std::vector<int> crossersOf(const PairList& list, std::size_t chunk) {
  std::vector<int> crossers;
  const auto end = static_cast<int>((chunk + 1) * list.chunks.size);
  for (std::size_t p = list.chunks.begin[chunk]; p < list.chunks.begin[chunk + 1]; ++p)
    if (const int j = list.pairs[p][1]; j >= end) crossers.push_back(j);
  return crossers;
}

}  // namespace

/// A thread should have several chunks, and a chunk few neighbours beyond its border.
std::size_t chunkSize(std::size_t particles) { return std::clamp<std::size_t>(particles / 128, 256, 4096); }

void findRanges(std::size_t particles, const Pairs& sorted, std::vector<std::size_t>& begin) {
  const std::size_t size = chunkSize(particles), count = (particles + size - 1) / size;
  begin.assign(count + 1, sorted.size());
  parallelFor(count, 64, [&](std::size_t first, std::size_t last) {
    for (std::size_t c = first; c < last; ++c) {
      const std::array<int, 2> from{static_cast<int>(c * size), -1};
      begin[c] = static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), from) - sorted.begin());
    }
  });
}

void makeChunks(std::size_t particles, PairList& list) {
  PairChunks& chunks = list.chunks;
  chunks.size = chunkSize(particles);
  findRanges(particles, list.pairs, chunks.begin);
  std::vector<std::vector<int>> crossers(chunks.count());
  parallelFor(chunks.count(), 1, [&](std::size_t c, std::size_t) { crossers[c] = crossersOf(list, c); });
  chunks.crosses.assign(chunks.count() + 1, 0);
  chunks.arrives.assign(chunks.count() + 1, 0);
  for (std::size_t c = 0; c < chunks.count(); ++c) {
    chunks.crosses[c + 1] = chunks.crosses[c] + crossers[c].size();
    for (const int j : crossers[c]) ++chunks.arrives[static_cast<std::size_t>(j) / chunks.size + 1];
  }
  for (std::size_t c = 0; c < chunks.count(); ++c) chunks.arrives[c + 1] += chunks.arrives[c];
  chunks.force.resize(chunks.crosses.back());
  chunks.torque.clear();
  chunks.arriving.resize(chunks.crosses.back());
  std::vector<std::size_t> next(chunks.arrives.begin(), chunks.arrives.end() - 1);
  int crossing = 0;
  for (const std::vector<int>& of : crossers)
    for (const int j : of) chunks.arriving[next[static_cast<std::size_t>(j) / chunks.size]++] = {crossing++, j};
}

void takePairs(const Particles& particles, Pairs&& pairs, PairList& list) {
  list.pairs.swap(pairs);
  makeChunks(particles.size(), list);
  keepMemory(particles, pairs, list);
  findImages(particles, list);
  ++list.revision;
}

}  // namespace detail

void keepPairs(const Particles& particles, PairList& list) {
  list.candidates = {};
  list.positionAtPruning = {};
  list.positionAtBuild = particles.x;
  list.particleRevision = particles.revision;
  list.wraps = particles.wraps;
  detail::makeChunks(particles.size(), list);
  detail::findImages(particles, list);
  ++list.revision;
}

void restoreChunks(const Particles& particles, PairList& list) {
  if (list.builds == 0) return;
  detail::makeChunks(particles.size(), list);
  detail::findRanges(particles.size(), list.candidates, list.chunks.candidates);
  PairChunks& chunks = list.chunks;
  chunks.images.assign(chunks.count() + 1, 0);
  std::size_t k = 0;
  for (std::size_t c = 0; c < chunks.count(); ++c) {
    while (k < list.images.size() && list.images[k].pair < chunks.begin[c + 1]) ++k;
    chunks.images[c + 1] = k;
  }
}

}  // namespace dovetail::dem
