#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

#include "dovetail/core/distribute.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/geometry/hierarchical_grid.hpp"
#include "grid_cells.hpp"

namespace dovetail::geometry {

namespace {

using Pair = std::array<int, 2>;

/// Particles whose pairs one thread sorts, as a power of two: so many bits of their numbers.
int bitsPerRange(std::size_t particles) {
  return static_cast<int>(std::bit_width(std::max<std::size_t>(1024, particles / 512) - 1));
}

void sortSecond(Pair* first, Pair* last) {
  constexpr std::ptrdiff_t few = 24;
  if (last - first > few) return std::sort(first, last, [](const Pair& a, const Pair& b) { return a[1] < b[1]; });
  for (Pair* next = first + 1; next < last; ++next) {
    const Pair pair = *next;
    Pair* place = next;
    for (; place > first && place[-1][1] > pair[1]; --place) *place = place[-1];
    *place = pair;
  }
}

/// Sorts pairs of particles `first` … first + rows − 1 by i, then j.
void sortPairs(std::span<Pair> pairs, std::size_t first, std::size_t rows) {
  const RawVector<Pair> unsorted(pairs.begin(), pairs.end());
  std::vector<std::uint32_t> next(rows + 1, 0);
  for (const Pair& pair : unsorted) ++next[static_cast<std::size_t>(pair[0]) - first + 1];
  for (std::size_t i = 1; i <= rows; ++i) next[i] += next[i - 1];
  for (const Pair& pair : unsorted) pairs[next[static_cast<std::size_t>(pair[0]) - first]++] = pair;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < rows; begin = next[i++])
    if (next[i] - begin > 1) sortSecond(pairs.data() + begin, pairs.data() + next[i]);
}

/// A sphere's partners, behind those of the spheres before.
void append(void* context, int i, const int* partners, std::size_t count) {
  auto& pairs = *static_cast<SpherePairs*>(context);
  const std::size_t size = pairs.size();
  pairs.resize(size + count);
  Pair* const to = pairs.data() + size;
  for (std::size_t k = 0; k < count; ++k) to[k] = {std::min(i, partners[k]), std::max(i, partners[k])};
}

}  // namespace

struct HierarchicalGrid::Lookup {
  struct Run {
    std::size_t begin, end;  // spheres in sorted order
  };
  static constexpr std::size_t capacity = 4 * 4 * 2;  // at most three rows of three, each in at most two parts

  std::array<AxisCells, 3> cells{};  // what runs answers
  std::array<Run, capacity> runs{};
  std::size_t count = 0, spheres = 0;
};

/// First sphere of the level, in sorted order, whose key is not below the given one.
std::size_t HierarchicalGrid::firstFrom(const Level& level, Key key) const {
  const int* const start = index_.data() + level.index + (key >> level.shift);
  if (level.shift == 0) return static_cast<std::size_t>(*start);
  return static_cast<std::size_t>(std::lower_bound(key_.data() + start[0], key_.data() + start[1], key) - key_.data());
}

struct HierarchicalGrid::Search {
  std::vector<Lookup> lookups;  // per level
  std::vector<int> hits;
  PairSink sink;
  void* context;
};

/// Cells first … last along an axis, cut off at the ends of the level, or wrapped around where the axis is periodic.
HierarchicalGrid::AxisCells HierarchicalGrid::splitCells(const Level& level, std::size_t k, int first, int last) const {
  const int n = level.count[k];
  AxisCells cells;
  if (!periodicity_.axes[k] || last - first + 1 >= n) {
    cells.parts[0] =
        periodicity_.axes[k] ? AxisCells::Part{0, n - 1} : AxisCells::Part{std::max(first, 0), std::min(last, n - 1)};
  } else if (first < 0 || last >= n) {
    cells.parts[0] = {0, last < n ? last : last - n};
    cells.parts[1] = {first < 0 ? first + n : first, n - 1};
  } else {
    cells.parts[0] = {first, last};
  }
  return cells;
}

/// Cells that a sphere's partners can lie in; the centre is wrapped and the reach at most one cell.
HierarchicalGrid::AxisCells HierarchicalGrid::cellsAround(const Level& level, std::size_t k, double centre,
                                                          double reach) const {
  const double n = level.count[k], from = (centre - reach - level.origin[k]) * level.perCell[k],
               to = (centre + reach - level.origin[k]) * level.perCell[k];
  if (!periodicity_.axes[k])
    return splitCells(level, k, static_cast<int>(std::clamp(from, 0.0, n - 1.0)),
                      static_cast<int>(std::clamp(to, 0.0, n - 1.0)));
  return splitCells(level, k, static_cast<int>(from + n) - level.count[k], static_cast<int>(to + n) - level.count[k]);
}

/// Lists the spheres in the given cells, as far as they are sorted from `from` on, as runs, row by row.
void HierarchicalGrid::collectRuns(const Level& level, const std::array<AxisCells, 3>& cells, std::size_t from,
                                   Lookup& lookup) const {
  lookup.count = lookup.spheres = 0;
  detail::forEachRow(level.count, cells, [&](Key first, Key last) {
    const std::size_t begin = std::max(from, firstFrom(level, first)), end = firstFrom(level, last + 1);
    if (begin >= end) return;
    lookup.runs[lookup.count++] = {begin, end};
    lookup.spheres += end - begin;
  });
}

void HierarchicalGrid::lookUpOwnLevel(const Level& level, std::size_t s, Lookup& lookup) const {
  std::array<AxisCells, 3> cells;
  for (std::size_t k = 0; k < 3; ++k) {
    const int cell = detail::cellOf(level, k, sphere_[s][k]);
    cells[k] = splitCells(level, k, cell - 1, cell + 1);
  }
  collectRuns(level, cells, s + 1, lookup);  // spheres sorted before s have found s themselves
}

void HierarchicalGrid::lookUpCoarserLevel(const Level& level, std::size_t s, Lookup& lookup) const {
  const double reach = sphere_[s][3] + level.largest + detail::reachMargin * level.size;
  std::array<AxisCells, 3> cells;
  for (std::size_t k = 0; k < 3; ++k) cells[k] = cellsAround(level, k, sphere_[s][k], reach);
  if (cells == lookup.cells) return;
  lookup.cells = cells;
  collectRuns(level, cells, level.begin, lookup);
}

/// Hands the partners of sphere s among the runs, as far as they are sorted after s, to the sink.
template <bool periodic>
void HierarchicalGrid::testRuns(std::size_t s, const Lookup& lookup, Search& search) const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::array<double, 3> length{infinity, infinity, infinity};
  if constexpr (periodic)
    for (int k = 0; k < 3; ++k)
      if (periodicity_.axes[static_cast<std::size_t>(k)]) length[static_cast<std::size_t>(k)] = periodicity_.length(k);
  if (search.hits.size() < lookup.spheres) search.hits.resize(2 * lookup.spheres);
  int* const hits = search.hits.data();
  std::size_t count = 0;
  const auto here = sphere_[s];
  for (std::size_t r = 0; r < lookup.count; ++r)
    for (std::size_t t = std::max(lookup.runs[r].begin, s + 1); t < lookup.runs[r].end; ++t) {
      const auto& there = sphere_[t];
      Vec3 d{std::abs(here[0] - there[0]), std::abs(here[1] - there[1]), std::abs(here[2] - there[2])};
      if constexpr (periodic)
        d = {std::min(d.x, length[0] - d.x), std::min(d.y, length[1] - d.y), std::min(d.z, length[2] - d.z)};
      const double reach = here[3] + there[3];
      hits[count] = static_cast<int>(t);
      count += squaredNorm(d) <= reach * reach ? 1 : 0;  // no branch: the outcome is hard to predict
    }
  for (std::size_t k = 0; k < count; ++k) hits[k] = id_[static_cast<std::size_t>(hits[k])];
  if (count > 0) search.sink(search.context, id_[s], hits, count);
}

template <bool periodic>
void HierarchicalGrid::searchSpheres(std::size_t begin, std::size_t end, Search& search) const {
  std::size_t own = 0;
  for (std::size_t s = begin; s < end; ++s) {
    while (s >= levels_[own].end) ++own;
    if (s == begin || s == levels_[own].begin || key_[s] != key_[s - 1])
      lookUpOwnLevel(levels_[own], s, search.lookups[own]);
    testRuns<periodic>(s, search.lookups[own], search);
    for (std::size_t coarser = own + 1; coarser < levels_.size(); ++coarser) {
      lookUpCoarserLevel(levels_[coarser], s, search.lookups[coarser]);
      testRuns<periodic>(s, search.lookups[coarser], search);
    }
  }
}

void HierarchicalGrid::searchPairs(std::size_t begin, std::size_t end, PairSink sink, void* context) const {
  Search search{std::vector<Lookup>(levels_.size()), {}, sink, context};
  if (periodicity_.any())
    searchSpheres<true>(begin, end, search);
  else
    searchSpheres<false>(begin, end, search);
}

SpherePairs HierarchicalGrid::pairs() const {
  constexpr std::size_t spheresPerTask = 4096;
  const std::size_t tasks = (size() + spheresPerTask - 1) / spheresPerTask;
  const int bits = bitsPerRange(size());
  const auto rangeOf = [bits](const Pair& pair) { return static_cast<std::size_t>(pair[0]) >> bits; };
  std::vector<SpherePairs> found(tasks);
  const auto search = [&](std::size_t task, auto&& sink) {
    const std::size_t begin = task * spheresPerTask, end = std::min(size(), begin + spheresPerTask);
    found[task].reserve(4 * (end - begin));
    searchPairs(begin, end, append, &found[task]);
    for (const Pair& pair : found[task]) sink(rangeOf(pair));
  };
  auto parts = distribute<Pair>(tasks, (size() >> bits) + 1, search, [&](std::size_t task, auto&& sink) {
    for (const Pair& pair : found[task]) sink(rangeOf(pair), pair);
    found[task] = {};
  });
  parallelFor(parts.count(), 1,
              [&](std::size_t range, std::size_t) { sortPairs(parts[range], range << bits, std::size_t{1} << bits); });
  return std::move(parts.items);
}

}  // namespace dovetail::geometry
