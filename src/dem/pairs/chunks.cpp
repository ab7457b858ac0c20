// Who works on which pairs.
#include <algorithm>

#include "dovetail/core/distribute.hpp"
#include "list_update.hpp"

namespace dovetail::dem::detail {

/// A thread should have several chunks, and a chunk few neighbours beyond its border.
std::size_t chunkSize(std::size_t particles) { return std::clamp<std::size_t>(particles / 64, 256, 4096); }

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

void Links::findCrossers(const ListedPairs& list, std::size_t chunk) {
  const auto end = static_cast<int>((chunk + 1) * list.chunks.size);
  int number = 0;
  for (std::size_t p = list.chunks.begin[chunk]; p < list.chunks.begin[chunk + 1]; ++p) {
    const int j = list.pairs[p][1];
    number = std::max(number, j);
    if (j >= end) crossers[chunk].push_back(j);
  }
  largest[chunk] = number;
}

namespace {

void joinImages(const std::vector<std::vector<PairImage>>& images, ListedPairs& list) {
  PairChunks& chunks = list.chunks;
  chunks.images.assign(chunks.count() + 1, 0);
  for (std::size_t c = 0; c < chunks.count(); ++c) chunks.images[c + 1] = chunks.images[c] + images[c].size();
  list.images.resize(chunks.images.back());
  parallelFor(chunks.count(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c)
      std::copy(images[c].begin(), images[c].end(),
                list.images.begin() + static_cast<std::ptrdiff_t>(chunks.images[c]));
  });
}

/// Not twice as much as is needed, as vectors would take when they grow by a little.
void makeRoom(RawVector<Vec3>& values, std::size_t count) {
  if (count > values.capacity()) {
    values = {};
    values.reserve(count + count / 32);
  }
  values.resize(count);
}

void joinCrossers(const std::vector<std::vector<int>>& crossers, PairChunks& chunks) {
  const std::size_t count = chunks.count();
  chunks.crosses.assign(count + 1, 0);
  for (std::size_t c = 0; c < count; ++c) chunks.crosses[c + 1] = chunks.crosses[c] + crossers[c].size();
  auto arriving = distribute<Pair>(count, count, [&](std::size_t c, auto&& sink) {
    auto crossing = static_cast<int>(chunks.crosses[c]);
    for (const int j : crossers[c]) sink(static_cast<std::size_t>(j) / chunks.size, Pair{crossing++, j});
  });
  chunks.arrives = std::move(arriving.begin);
  chunks.arriving = std::move(arriving.items);
  makeRoom(chunks.force, chunks.crosses.back());
  if (!chunks.torque.empty()) makeRoom(chunks.torque, chunks.crosses.back());
}

}  // namespace

void Links::join(ListedPairs& list) {
  joinImages(images, list);
  joinCrossers(crossers, list.chunks);
  list.chunks.largest.swap(largest);
}

void makeChunks(std::size_t particles, ListedPairs& list) {
  list.chunks.size = chunkSize(particles);
  findRanges(particles, list.pairs, list.chunks.begin);
  Links links(list.chunks.count());
  for (const PairImage& image : list.images)
    links.images[static_cast<std::size_t>(list.pairs[image.pair][0]) / list.chunks.size].push_back(image);
  parallelFor(list.chunks.count(), 1, [&](std::size_t c, std::size_t) { links.findCrossers(list, c); });
  links.join(list);
}

}  // namespace dovetail::dem::detail
