// Cells of the hierarchical grid: ranges, keys and their lookup.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace dovetail::geometry::detail {

/// Lookups reach further by this fraction of a cell, so that round-off in a cell index cannot hide a neighbour.
inline constexpr double reachMargin = 1e-9;

/// Cells along one axis of a level.
struct AxisCells {
  struct Part {
    int first = 0, last = -1;
    bool operator==(const Part&) const = default;
  };
  std::array<Part, 2> parts{};  // the second one is empty (last < first) unless the cells go around the border

  int count() const { return parts[0].last - parts[0].first + 1 + parts[1].last - parts[1].first + 1; }
  bool contains(int cell) const {
    return (cell >= parts[0].first && cell <= parts[0].last) || (cell >= parts[1].first && cell <= parts[1].last);
  }
  bool operator==(const AxisCells&) const = default;
};

/// Index of the cell that holds a coordinate; what lies outside belongs to the outermost cells.
template <class Level>
int cellOf(const Level& level, std::size_t axis, double coordinate) {
  const double cell = (coordinate - level.origin[axis]) * level.perCell[axis];
  return static_cast<int>(std::clamp(cell, 0.0, static_cast<double>(level.count[axis] - 1)));
}

inline std::uint64_t keyAt(const std::array<int, 3>& count, int x, int y, int z) {
  const auto wide = [](int i) { return static_cast<std::uint64_t>(i); };
  return (wide(z) * wide(count[1]) + wide(y)) * wide(count[0]) + wide(x);
}

/// Calls visit(first key, last key) for each row of the given cells along x.
template <class Visit>
void forEachRow(const std::array<int, 3>& count, const std::array<AxisCells, 3>& cells, Visit&& visit) {
  for (const auto& slab : cells[2].parts)
    for (int z = slab.first; z <= slab.last; ++z)
      for (const auto& strip : cells[1].parts)
        for (int y = strip.first; y <= strip.last; ++y) {
          const auto row = keyAt(count, 0, y, z);
          for (const auto& part : cells[0].parts)
            if (part.first <= part.last)
              visit(row + static_cast<std::uint64_t>(part.first), row + static_cast<std::uint64_t>(part.last));
        }
}

}  // namespace dovetail::geometry::detail
