#include <algorithm>
#include <array>
#include <cmath>

#include "dovetail/mpm/grid.hpp"

namespace dovetail::mpm {

namespace {

using Cell = std::array<double, 3>;  // its lowest corner over the spacing

Cell cellOf(const GridOptions& grid, const Vec3& x) {
  const Vec3 place = 1.0 / grid.spacing * (x - grid.origin);
  return {std::floor(place.x), std::floor(place.y), grid.plane ? 0.0 : std::floor(place.z)};
}

/// Whether the neighbour lies beyond a border, where the body goes on as a mirror image.
bool isBeyond(const GridOptions& grid, const Cell& cell) {
  return std::ranges::any_of(grid.borders, [&](const GridBorder& border) {
    const auto axis = static_cast<std::size_t>(border.axis);
    const double at = std::round((border.place - grid.origin[border.axis]) / grid.spacing);
    return border.above ? cell[axis] >= at : cell[axis] < at;
  });
}

}  // namespace

double pointsPerCell(const GridOptions& grid, std::span<const Vec3> x) {
  std::vector<Cell> cells;
  for (const Vec3& place : x) cells.push_back(cellOf(grid, place));
  std::ranges::sort(cells);
  const auto holds = [&](const Cell& cell) { return isBeyond(grid, cell) || std::ranges::binary_search(cells, cell); };
  const auto isWithin = [&](const Cell& cell) {
    for (std::size_t axis = 0; axis < (grid.plane ? 2 : 3); ++axis)
      for (const double step : {-1.0, 1.0}) {
        Cell neighbour = cell;
        neighbour[axis] += step;
        if (!holds(neighbour)) return false;
      }
    return true;
  };
  double points = 0.0, within = 0.0, pointsWithin = 0.0, all = 0.0;
  for (auto cell = cells.begin(); cell != cells.end();) {
    const auto next = std::upper_bound(cell, cells.end(), *cell);
    const auto count = static_cast<double>(next - cell);
    points += count, ++all;
    if (isWithin(*cell)) pointsWithin += count, ++within;
    cell = next;
  }
  return within > 0.0 ? pointsWithin / within : points / all;
}

}  // namespace dovetail::mpm
