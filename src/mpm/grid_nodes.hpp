// The nodes that points reach, found by sorted numbers of their places in a box.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "dovetail/mpm/grid.hpp"

namespace dovetail::mpm::detail {

using Index = std::array<int, 3>;

/// How far nodes and borders lie from the origin at most, in cells, so that numbers of nodes fit.
constexpr double mostCells = 1 << 30;

inline int axesOf(const GridOptions& grid) { return grid.plane ? 2 : 3; }
int nodeOf(const GridOptions& grid, const GridBorder& border);

/// Fills all of `rows` but weights and slopes. @param first  lowest of the nodes that each point reaches
/// @throws NumericalError for points that are too far from each other
void findNodes(const GridOptions& grid, const std::vector<Index>& first, const std::string& name, GridRows& rows);

}  // namespace dovetail::mpm::detail
