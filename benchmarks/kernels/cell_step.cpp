// What a step of a cell costs: discs and both kinds of spheres with friction under shear, alone and with 512 cells in
// turn.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <numeric>
#include <vector>

#include "dovetail/rve/equilibrium.hpp"
#include "dovetail/rve/packing.hpp"

using namespace dovetail;

namespace {

/// Seconds a step of a path at I ≈ 1e-3 takes, of all cells in turn: of each the best of some bursts, as others use the
/// machine.
double stepTime(std::vector<rve::Rve>& cells, int bursts, int steps) {
  Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
  G(0, 0) += 1e-6;
  G(1, 1) -= 1e-6;
  std::vector<double> best(cells.size(), 1e300);
  for (int burst = 0; burst < bursts; ++burst)
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const auto begin = std::chrono::steady_clock::now();
      for (int k = 0; k < steps; ++k) rve::step(cells[c], 0.8 * cells[c].state.criticalStep, G, 0.7);
      const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      best[c] = std::min(best[c], seconds / steps);
    }
  return std::accumulate(best.begin(), best.end(), 0.0) / static_cast<double>(cells.size());
}

void report(const char* name, const rve::Rve& cell, int copies) {
  std::vector<rve::Rve> alone{cell}, many(static_cast<std::size_t>(copies), cell);
  const double grains = static_cast<double>(cell.size());
  const double one = stepTime(alone, 200, 20) / grains, all = stepTime(many, 5, 10) / grains;
  std::printf("%-28s %6zu grains, %5d contacts, %6zu listed: %5.1f ns a grain and step alone, %5.1f in %d cells\n",
              name, cell.size(), rve::balance(cell).contacts, cell.state.contacts.size(), 1e9 * one, 1e9 * all, copies);
}

}  // namespace

int main() {
  rve::Rve discs = rve::randomCell({.count = 400}, {.modulus = 6e8, .tangential = 0.8, .friction = 0.5463});
  rve::compress(discs, {.friction = 0.3});
  report("discs with friction", discs, 512);
  rve::Rve spheres = rve::randomCell(
      {.shape = rve::Shape::sphere, .count = 1000, .sizes = dem::UniformSizes{4e-3, 6e-3}, .solidFraction = 0.5},
      {.modulus = 6e8, .tangential = 0.8, .friction = 0.5});
  rve::compress(spheres, {.pressure = {1e6, 1e6, 1e6}, .friction = 0.3});
  report("spheres with friction", spheres, 512);
  rve::setSprings(spheres, rve::hertzMindlin(29e7, 0.15, 0.5));
  rve::compress(spheres, {.pressure = {1e6, 1e6, 1e6}, .friction = 0.3});
  report("Hertz and Mindlin's spheres", spheres, 512);
  rve::CellState kept;
  const auto begin = std::chrono::steady_clock::now();
  for (int k = 0; k < 1000; ++k) {
    rve::save(discs, kept);
    rve::restore(discs, kept);
  }
  std::printf("putting 400 discs aside and taking them back: %.1f µs\n",
              1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
}
