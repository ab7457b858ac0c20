// Cells that repeat, put side by side.
#pragma once

#include <cmath>

#include "dovetail/rve/rve.hpp"

namespace dovetail::benchmark {

/// The grains of nx × ny copies of a disc cell with upright periods, column by column. Springs are not among them.
inline rve::Grains tiles(const rve::Rve& cell, int nx, int ny) {
  const double width = cell.state.lattice.period[0].x, height = cell.state.lattice.period[1].y;
  const auto inTile = [](double x, double period) { return x - std::floor(x / period) * period; };
  rve::Grains grains{.density = cell.density};
  for (int column = 0; column < nx; ++column)
    for (int row = 0; row < ny; ++row)
      for (std::size_t i = 0; i < cell.size(); ++i) {
        grains.centre.push_back({inTile(cell.state.x[0][i], width) + column * width,
                                 inTile(cell.state.x[1][i], height) + row * height, 0.0});
        grains.radius.push_back(cell.radius[i]);
      }
  return grains;
}

}  // namespace dovetail::benchmark
