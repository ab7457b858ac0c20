#include "dovetail/geometry/hierarchical_grid.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <string>
#include <tuple>

#include "dovetail/core/distribute.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "grid_cells.hpp"

namespace dovetail::geometry {

namespace {

/// Cells are larger than the largest reach by this fraction, so that spheres in reach of each other lie in the same or
/// in adjacent cells in spite of round-off (at most 3.5e-10 of a cell with 2^20 cells along an axis).
constexpr double cellMargin = 1e-8;
/// Longer axes keep 2^20 cells about the mean position; what lies beyond is held by the outermost cells.
constexpr int largestCount = 1 << 20;
/// Index entries per sphere at most; a dense packing of one size has one to two cells per sphere.
constexpr std::size_t bucketsPerSphere = 4;
/// Radii within a level differ by at most this factor. More levels mean more look-ups, fewer mean more spheres per
/// cell; 3 was fastest, or nearly so, for 1 : 10 and 1 : 100 packings with equal volume or equal number per size.
constexpr double classWidth = 3.0;
constexpr std::size_t sizeClasses = 32;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Upper bounds of the classes of inflated radii, largest first; the last class holds all smaller ones too.
std::array<double, sizeClasses> classBounds(double largest) {
  std::array<double, sizeClasses> bounds{largest};
  for (std::size_t c = 1; c < sizeClasses; ++c) bounds[c] = bounds[c - 1] / classWidth;
  return bounds;
}

std::size_t classOf(double inflated, const std::array<double, sizeClasses>& bounds) {
  std::size_t c = 0;
  while (c + 1 < sizeClasses && inflated <= bounds[c + 1]) ++c;
  return c;
}

/// Spheres per task.
constexpr std::size_t chunkSize = 8192;

struct Bounds {
  double smallest = infinity, largest = 0.0;
  Bounds& operator+=(const Bounds& b) {
    smallest = std::min(smallest, b.smallest);
    largest = std::max(largest, b.largest);
    return *this;
  }
};

/// Extent and mean position, the latter as a sum.
struct Extent {
  Vec3 lower{infinity, infinity, infinity}, upper{-infinity, -infinity, -infinity}, sum;
  Extent& operator+=(const Extent& b) {
    lower = {std::min(lower.x, b.lower.x), std::min(lower.y, b.lower.y), std::min(lower.z, b.lower.z)};
    upper = {std::max(upper.x, b.upper.x), std::max(upper.y, b.upper.y), std::max(upper.z, b.upper.z)};
    sum += b.sum;
    return *this;
  }
};

std::string particle(std::size_t i) { return "particle " + std::to_string(i); }

void checkSphere(const Vec3& x, double radius, std::size_t i) {
  if (!isFinite(x)) throw InputError("a position is not finite", particle(i), "give finite coordinates");
  if (!(radius > 0.0) || !std::isfinite(radius))
    throw InputError("a radius is " + formatNumber(radius), particle(i), "give a finite radius greater than zero");
}

}  // namespace

HierarchicalGrid::HierarchicalGrid(const Periodicity& periodicity) : periodicity_(periodicity) {
  for (int k = 0; k < 3; ++k)
    if (periodicity.axes[static_cast<std::size_t>(k)] &&
        !(periodicity.length(k) > 0.0 && std::isfinite(periodicity.length(k))))
      throw InputError("a periodic axis has length " + formatNumber(periodicity.length(k)),
                       std::string("axis ") + "xyz"[k], "give a finite upper bound above the lower one");
}

HierarchicalGrid::Sizes HierarchicalGrid::checkSpheres(std::span<const Vec3> x, std::span<const double> radius,
                                                       double skin) const {
  if (x.size() != radius.size())
    throw InputError(std::to_string(x.size()) + " positions but " + std::to_string(radius.size()) + " radii",
                     "hierarchical grid", "give one radius per position");
  if (x.size() > static_cast<std::size_t>(std::numeric_limits<int>::max() / 8))
    throw InputError("too many particles: " + std::to_string(x.size()), "hierarchical grid",
                     "give at most " + std::to_string(std::numeric_limits<int>::max() / 8));
  requireNonNegative(skin, "skin");
  const auto [smallest, largest] = parallelSum(x.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    Bounds part;
    for (std::size_t i = begin; i < end; ++i) {
      checkSphere(x[i], radius[i], i);
      part += Bounds{radius[i], radius[i]};
    }
    return part;
  });
  for (int k = 0; k < 3; ++k)
    if (periodicity_.axes[static_cast<std::size_t>(k)] && periodicity_.length(k) < 4.0 * (largest + 0.5 * skin))
      throw InputError("the periodic length " + formatNumber(periodicity_.length(k)) +
                           " is below twice the largest diameter (skin included) of " +
                           formatNumber(2.0 * largest + skin),
                       std::string("axis ") + "xyz"[k], "take a longer box, smaller particles or a thinner skin");
  return {smallest, largest};
}

Vec3 HierarchicalGrid::wrapped(Vec3 x) const {
  for (int k = 0; k < 3; ++k)
    if (periodicity_.axes[static_cast<std::size_t>(k)])
      x[k] -= periodicity_.length(k) * std::floor((x[k] - periodicity_.box.lower[k]) / periodicity_.length(k));
  return x;
}

void HierarchicalGrid::build(std::span<const Vec3> x, std::span<const double> radius, double skin) {
  const Sizes sizes = checkSpheres(x, radius, skin);
  skin_ = skin;
  levels_.clear();
  index_.clear();
  id_.resize(x.size());
  key_.resize(x.size());
  sphere_.resize(x.size());
  if (!x.empty()) makeLevels(x, radius, sizes);
}

/// The finest class comes first.
void HierarchicalGrid::makeLevels(std::span<const Vec3> x, std::span<const double> radius, const Sizes& sizes) {
  const double half = 0.5 * skin_;
  const auto bounds = classBounds(sizes.largest + half);
  const std::size_t count = classOf(sizes.smallest + half, bounds) + 1;
  const auto classes =
      distribute<int>((x.size() + chunkSize - 1) / chunkSize, count, [&](std::size_t task, auto&& sink) {
        for (std::size_t i = task * chunkSize; i < std::min(x.size(), (task + 1) * chunkSize); ++i)
          sink(count == 1 ? 0 : count - 1 - classOf(radius[i] + half, bounds), static_cast<int>(i));
      });
  for (std::size_t c = 0; c < count; ++c) {
    const auto members = classes[c];
    if (members.empty()) continue;
    const auto largest = parallelSum(members.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
      Bounds part;
      for (std::size_t s = begin; s < end; ++s) part += Bounds{0.0, radius[static_cast<std::size_t>(members[s])]};
      return part;
    });
    addLevel(members, classes.begin[c], largest.largest + half, x);
  }
  parallelFor(x.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      const auto i = static_cast<std::size_t>(id_[s]);
      const Vec3 p = wrapped(x[i]);
      sphere_[s] = {p.x, p.y, p.z, radius[i] + half};
    }
  });
}

void HierarchicalGrid::addLevel(std::span<const int> members, std::size_t begin, double largest,
                                std::span<const Vec3> x) {
  Level& level = levels_.emplace_back();
  level.begin = begin;
  level.end = begin + members.size();
  level.largest = largest;
  layCells(level, members, x);
  sortLevel(level, members, x);
}

/// Chooses the cells of a level: as large as its largest sphere, over the bounding box of its members.
void HierarchicalGrid::layCells(Level& level, std::span<const int> members, std::span<const Vec3> x) const {
  level.size = 2.0 * level.largest * (1.0 + cellMargin);
  const Extent extent = parallelSum(members.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    Extent part;
    for (std::size_t s = begin; s < end; ++s) {
      const Vec3& p = x[static_cast<std::size_t>(members[s])];
      part += Extent{p, p, p};
    }
    return part;
  });
  const Vec3 &lower = extent.lower, &upper = extent.upper;
  const Vec3 mean = extent.sum / static_cast<double>(members.size());
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    double edge = level.size;
    if (periodicity_.axes[k]) {
      level.count[k] = static_cast<int>(std::min(std::floor(periodicity_.length(axis) / edge), double{largestCount}));
      level.origin[k] = periodicity_.box.lower[axis];
      edge = periodicity_.length(axis) / level.count[k];
    } else {
      const double cells = std::floor((upper[axis] - lower[axis]) / edge) + 1.0;
      level.count[k] = static_cast<int>(std::min(cells, double{largestCount}));
      level.origin[k] = cells <= largestCount ? lower[axis] : mean[axis] - 0.5 * largestCount * edge;
    }
    level.perCell[k] = 1.0 / edge;
  }
}

/// Sorts a level's spheres by key, equal keys by number, and makes the index of buckets of successive keys: first into
/// ranges of buckets, which threads then sort on their own.
void HierarchicalGrid::sortLevel(Level& level, std::span<const int> members, std::span<const Vec3> x) {
  const Key lastKey = detail::keyAt(level.count, level.count[0] - 1, level.count[1] - 1, level.count[2] - 1);
  while (lastKey >> level.shift >= bucketsPerSphere * members.size() + 64) ++level.shift;
  level.buckets = static_cast<std::size_t>(lastKey >> level.shift) + 1;
  level.index = index_.size();
  index_.resize(level.index + level.buckets + 2);
  std::fill(index_.end() - 2, index_.end(), static_cast<int>(level.end));
  const std::size_t tasks = (members.size() + chunkSize - 1) / chunkSize,
                    bits = static_cast<std::size_t>(std::bit_width(level.buckets / std::min<std::size_t>(tasks, 512)));
  const std::size_t perRange = std::size_t{1} << bits, ranges = (level.buckets + perRange - 1) >> bits;
  Key* const keys = key_.data() + level.begin;  // of the members as they come; sorted below
  const auto eachOf = [&](std::size_t task, auto&& act) {
    for (std::size_t s = task * chunkSize; s < std::min(members.size(), (task + 1) * chunkSize); ++s) act(s);
  };
  const auto rangeOf = [&](Key key) { return static_cast<std::size_t>(key >> level.shift) >> bits; };
  const auto findKeys = [&](std::size_t task, auto&& sink) {
    eachOf(task, [&](std::size_t s) {
      const Vec3 p = wrapped(x[static_cast<std::size_t>(members[s])]);
      keys[s] = detail::keyAt(level.count, detail::cellOf(level, 0, p.x), detail::cellOf(level, 1, p.y),
                              detail::cellOf(level, 2, p.z));
      sink(rangeOf(keys[s]));
    });
  };
  const auto sorted = distribute<Keyed>(tasks, ranges, findKeys, [&](std::size_t task, auto&& sink) {
    eachOf(task, [&](std::size_t s) { sink(rangeOf(keys[s]), Keyed{keys[s], members[s]}); });
  });
  parallelFor(ranges, 1, [&](std::size_t range, std::size_t) {
    sortRange(level, sorted[range], level.begin + sorted.begin[range], range * perRange,
              std::min(level.buckets, (range + 1) * perRange));
  });
}

/// A counting sort into the buckets [first, last), then a small sort within the buckets unless each holds a single key.
void HierarchicalGrid::sortRange(const Level& level, std::span<const Keyed> members, std::size_t begin,
                                 std::size_t first, std::size_t last) {
  std::vector<int> next(last - first + 1, 0);
  const auto bucketOf = [&](const Keyed& m) { return static_cast<std::size_t>(m.key >> level.shift) - first; };
  for (const Keyed& m : members) ++next[bucketOf(m) + 1];
  next[0] = static_cast<int>(begin);
  for (std::size_t b = 1; b < next.size(); ++b) next[b] += next[b - 1];
  std::copy(next.begin(), next.end() - 1, index_.begin() + static_cast<std::ptrdiff_t>(level.index + first));
  for (const Keyed& m : members) {
    const auto s = static_cast<std::size_t>(next[bucketOf(m)]++);
    key_[s] = m.key;
    id_[s] = m.id;
  }
  if (level.shift > 0) sortBuckets(level, first, last, begin + members.size());
}

void HierarchicalGrid::sortBuckets(const Level& level, std::size_t first, std::size_t last, std::size_t stop) {
  std::vector<std::pair<Key, int>> unsorted;
  for (std::size_t b = first; b < last; ++b) {
    const auto begin = static_cast<std::size_t>(index_[level.index + b]);
    const auto end = b + 1 < last ? static_cast<std::size_t>(index_[level.index + b + 1]) : stop;
    if (end - begin < 2) continue;
    unsorted.clear();
    for (std::size_t s = begin; s < end; ++s) unsorted.emplace_back(key_[s], id_[s]);
    std::sort(unsorted.begin(), unsorted.end());
    for (std::size_t s = begin; s < end; ++s) std::tie(key_[s], id_[s]) = unsorted[s - begin];
  }
}

void HierarchicalGrid::renumber(std::span<const int> newNumber) {
  parallelFor(id_.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) id_[s] = newNumber[static_cast<std::size_t>(id_[s])];
  });
}

}  // namespace dovetail::geometry
