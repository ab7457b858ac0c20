#include "dovetail/geometry/hierarchical_grid.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <tuple>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "grid_cells.hpp"

namespace dovetail::geometry {

namespace {

/// Cells are larger than the largest reach by this share, so that spheres in reach of each other lie in the same or in
/// adjacent cells in spite of round-off (at most 3.5e-10 of a cell with 2^20 cells along an axis).
constexpr double cellMargin = 1e-8;
/// Longer axes keep 2^20 cells about the mean position; what lies beyond is held by the outermost cells.
constexpr int largestCount = 1 << 20;
/// Index entries per sphere at most; a dense packing of one size has one to two cells per sphere.
constexpr std::size_t bucketsPerSphere = 4;
/// Radii within a level differ by at most this factor. More levels mean more look-ups, fewer mean more spheres per
/// cell; 3 was fastest, or nearly so, for 1 : 10 and 1 : 100 packings with equal volume or equal number per size.
constexpr double classWidth = 3.0;
constexpr std::size_t sizeClasses = 32;

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

std::string particle(std::size_t i) { return "particle " + std::to_string(i); }

}  // namespace

HierarchicalGrid::HierarchicalGrid(const Periodicity& periodicity) : periodicity_(periodicity) {
  for (int k = 0; k < 3; ++k)
    if (periodicity.axes[static_cast<std::size_t>(k)] &&
        !(periodicity.length(k) > 0.0 && std::isfinite(periodicity.length(k))))
      throw InputError("a periodic axis has length " + formatNumber(periodicity.length(k)), "axis " + std::to_string(k),
                       "give a finite upper bound above the lower one");
}

void HierarchicalGrid::checkSpheres(std::span<const Vec3> x, std::span<const double> radius, double skin) const {
  if (x.size() != radius.size())
    throw InputError(std::to_string(x.size()) + " positions but " + std::to_string(radius.size()) + " radii",
                     "hierarchical grid", "give one radius per position");
  if (x.size() > static_cast<std::size_t>(std::numeric_limits<int>::max() / 8))
    throw InputError("too many particles: " + std::to_string(x.size()), "hierarchical grid",
                     "give at most " + std::to_string(std::numeric_limits<int>::max() / 8));
  requireNonNegative(skin, "skin");
  double largest = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!isFinite(x[i])) throw InputError("a position is not finite", particle(i), "give finite coordinates");
    if (!(radius[i] > 0.0) || !std::isfinite(radius[i]))
      throw InputError("a radius is " + formatNumber(radius[i]), particle(i), "give a finite radius greater than zero");
    largest = std::max(largest, radius[i]);
  }
  for (int k = 0; k < 3; ++k)
    if (periodicity_.axes[static_cast<std::size_t>(k)] && periodicity_.length(k) < 4.0 * (largest + 0.5 * skin))
      throw InputError("the periodic length " + formatNumber(periodicity_.length(k)) +
                           " is below twice the largest diameter (skin included) of " +
                           formatNumber(2.0 * largest + skin),
                       "axis " + std::to_string(k), "take a longer box, smaller particles or a thinner skin");
}

Vec3 HierarchicalGrid::wrapped(Vec3 x) const {
  for (int k = 0; k < 3; ++k)
    if (periodicity_.axes[static_cast<std::size_t>(k)])
      x[k] -= periodicity_.length(k) * std::floor((x[k] - periodicity_.box.lower[k]) / periodicity_.length(k));
  return x;
}

void HierarchicalGrid::build(std::span<const Vec3> x, std::span<const double> radius, double skin) {
  checkSpheres(x, radius, skin);
  skin_ = skin;
  levels_.clear();
  index_.clear();
  id_.resize(x.size());
  key_.resize(x.size());
  sphere_.resize(x.size());
  if (!x.empty()) makeLevels(x, radius);
  unsorted_ = {};  // as large as the list of spheres, and of no use until the next build
}

void HierarchicalGrid::makeLevels(std::span<const Vec3> x, std::span<const double> radius) {
  const double half = 0.5 * skin_;
  const auto bounds = classBounds(*std::max_element(radius.begin(), radius.end()) + half);
  std::array<std::size_t, sizeClasses> members{}, next{};
  for (double r : radius) ++members[classOf(r + half, bounds)];
  for (std::size_t c = sizeClasses - 1; c > 0; --c) next[c - 1] = next[c] + members[c];
  for (std::size_t i = 0; i < x.size(); ++i) id_[next[classOf(radius[i] + half, bounds)]++] = static_cast<int>(i);
  for (std::size_t c = sizeClasses; c-- > 0;) {
    if (members[c] == 0) continue;
    Level& level = levels_.emplace_back();
    level.begin = next[c] - members[c];
    level.end = next[c];
    for (std::size_t s = level.begin; s < level.end; ++s)
      level.largest = std::max(level.largest, radius[static_cast<std::size_t>(id_[s])] + half);
    layCells(level, x);
    sortLevel(level, x);
  }
  for (std::size_t s = 0; s < x.size(); ++s) {
    const auto i = static_cast<std::size_t>(id_[s]);
    const Vec3 p = wrapped(x[i]);
    sphere_[s] = {p.x, p.y, p.z, radius[i] + half};
  }
}

/// Chooses the cells of a level: as large as its largest sphere, over the bounding box of its members.
void HierarchicalGrid::layCells(Level& level, std::span<const Vec3> x) const {
  level.size = 2.0 * level.largest * (1.0 + cellMargin);
  Vec3 lower = x[static_cast<std::size_t>(id_[level.begin])], upper = lower, mean;
  const double share = 1.0 / static_cast<double>(level.end - level.begin);
  for (std::size_t s = level.begin; s < level.end; ++s) {
    const Vec3& p = x[static_cast<std::size_t>(id_[s])];
    lower = {std::min(lower.x, p.x), std::min(lower.y, p.y), std::min(lower.z, p.z)};
    upper = {std::max(upper.x, p.x), std::max(upper.y, p.y), std::max(upper.z, p.z)};
    mean += share * p;
  }
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

/// Sorts a level's spheres by key, equal keys by number: a counting sort into buckets of successive keys, whose starts
/// remain as the index, then a small sort within the buckets unless each holds a single key.
void HierarchicalGrid::sortLevel(Level& level, std::span<const Vec3> x) {
  const std::size_t members = level.end - level.begin;
  const Key lastKey = detail::keyAt(level.count, level.count[0] - 1, level.count[1] - 1, level.count[2] - 1);
  while (lastKey >> level.shift >= bucketsPerSphere * members + 64) ++level.shift;
  level.buckets = static_cast<std::size_t>(lastKey >> level.shift) + 1;
  level.index = index_.size();
  index_.resize(level.index + level.buckets + 2, 0);
  int* const start = index_.data() + level.index;
  unsorted_.resize(members);
  for (std::size_t s = 0; s < members; ++s) {
    const int id = id_[level.begin + s];
    const Vec3 p = wrapped(x[static_cast<std::size_t>(id)]);
    const Key key = detail::keyAt(level.count, detail::cellOf(level, 0, p.x), detail::cellOf(level, 1, p.y),
                                  detail::cellOf(level, 2, p.z));
    unsorted_[s] = {key, id};
    ++start[(key >> level.shift) + 2];
  }
  start[0] = start[1] = static_cast<int>(level.begin);
  for (std::size_t b = 2; b < level.buckets + 2; ++b) start[b] += start[b - 1];
  for (const auto& [key, id] : unsorted_) {
    const auto s = static_cast<std::size_t>(start[(key >> level.shift) + 1]++);
    key_[s] = key;
    id_[s] = id;
  }
  if (level.shift > 0) sortBuckets(level);
}

void HierarchicalGrid::sortBuckets(const Level& level) {
  for (std::size_t b = 0; b < level.buckets; ++b) {
    const auto begin = static_cast<std::size_t>(index_[level.index + b]);
    const auto end = static_cast<std::size_t>(index_[level.index + b + 1]);
    if (end - begin < 2) continue;
    unsorted_.clear();
    for (std::size_t s = begin; s < end; ++s) unsorted_.emplace_back(key_[s], id_[s]);
    std::sort(unsorted_.begin(), unsorted_.end());
    for (std::size_t s = begin; s < end; ++s) std::tie(key_[s], id_[s]) = unsorted_[s - begin];
  }
}

}  // namespace dovetail::geometry
