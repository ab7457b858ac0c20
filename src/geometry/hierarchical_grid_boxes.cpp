#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/geometry/hierarchical_grid.hpp"
#include "grid_cells.hpp"

namespace dovetail::geometry {

/// Cells that hold the centres of spheres meeting [lower, upper], whose length is not limited.
HierarchicalGrid::AxisCells HierarchicalGrid::cellsMeeting(const Level& level, int axis, double lower,
                                                           double upper) const {
  const auto k = static_cast<std::size_t>(axis);
  const double reach = level.largest + detail::reachMargin * level.size;
  if (!periodicity_.axes[k]) {
    const double last = level.count[k] - 1;
    return splitCells(level, k,
                      static_cast<int>(std::clamp((lower - reach - level.origin[k]) * level.perCell[k], 0.0, last)),
                      static_cast<int>(std::clamp((upper + reach - level.origin[k]) * level.perCell[k], 0.0, last)));
  }
  const double length = periodicity_.length(axis), half = 0.5 * (upper - lower) + reach;
  if (!(half < 0.5 * length)) return splitCells(level, k, 0, level.count[k] - 1);
  double centre = 0.5 * (lower + upper);
  centre -= length * std::floor((centre - periodicity_.box.lower[axis]) / length);
  return cellsAround(level, k, centre, half);
}

bool HierarchicalGrid::meets(std::size_t s, const Box& box) const {
  const auto& sphere = sphere_[s];
  for (int k = 0; k < 3; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    if (periodicity_.axes[axis]) {
      const double length = periodicity_.length(k), reach = 0.5 * (box.upper[k] - box.lower[k]) + sphere[3];
      const double d = sphere[axis] - 0.5 * (box.lower[k] + box.upper[k]);
      if (reach < 0.5 * length && std::abs(d - length * std::round(d / length)) > reach) return false;
    } else if (sphere[axis] - sphere[3] > box.upper[k] || sphere[axis] + sphere[3] < box.lower[k]) {
      return false;
    }
  }
  return true;
}

void HierarchicalGrid::searchLevel(const Level& level, const Box& box, BoxSink sink, void* context) const {
  std::array<AxisCells, 3> cells;
  for (int k = 0; k < 3; ++k) cells[static_cast<std::size_t>(k)] = cellsMeeting(level, k, box.lower[k], box.upper[k]);
  const auto test = [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s)
      if (meets(s, box)) sink(context, id_[s]);
  };
  // A box with more rows of cells than there are spheres: going through the spheres is cheaper.
  const double rows = static_cast<double>(cells[1].count()) * cells[2].count();
  if (rows > static_cast<double>(level.end - level.begin)) return test(level.begin, level.end);
  detail::forEachRow(level.count, cells,
                     [&](Key first, Key last) { test(firstFrom(level, first), firstFrom(level, last + 1)); });
}

void HierarchicalGrid::searchBox(const Box& box, BoxSink sink, void* context) const {
  for (int k = 0; k < 3; ++k)
    if (!(box.lower[k] <= box.upper[k]))
      throw InputError("a box runs from above to below its lower corner, or is not a number", "box query",
                       "give lower ≤ upper along every axis");
  for (const Level& level : levels_) searchLevel(level, box, sink, context);
}

std::vector<int> HierarchicalGrid::query(const Box& box) const {
  std::vector<int> ids;
  query(box, [&ids](int i) { ids.push_back(i); });
  std::sort(ids.begin(), ids.end());
  return ids;
}

}  // namespace dovetail::geometry
