// What a step of a cell costs: discs and spheres with friction under shear, alone and with 512 cells in turn.
#include <chrono>
#include <cstdio>
#include <vector>

#include "dovetail/rve/equilibrium.hpp"
#include "dovetail/rve/packing.hpp"

using namespace dovetail;

namespace {

/// Seconds that `steps` steps of a path at I ≈ 1e-3 take, of each cell in turn.
double shear(std::vector<rve::Cell>& cells, int steps) {
  const auto begin = std::chrono::steady_clock::now();
  Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
  G(0, 0) += 1e-6;
  G(1, 1) -= 1e-6;
  for (rve::Cell& cell : cells)
    for (int k = 0; k < steps; ++k) rve::step(cell, 0.8 * cell.state.criticalStep, G, 0.7);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void report(const char* name, const rve::Cell& cell, int copies) {
  std::vector<rve::Cell> alone{cell}, many(static_cast<std::size_t>(copies), cell);
  const double grains = static_cast<double>(cell.size());
  shear(alone, 100);
  const double one = shear(alone, 4000) / (4000.0 * grains);
  const double all = shear(many, 10) / (10.0 * copies * grains);
  std::printf("%-28s %6zu grains, %5d contacts, %6zu listed: %5.1f ns a grain and step alone, %5.1f in %d cells\n",
              name, cell.size(), rve::balance(cell).contacts, cell.state.contacts.size(), 1e9 * one, 1e9 * all, copies);
}

}  // namespace

int main() {
  rve::Cell discs = rve::randomCell({.count = 400}, {.modulus = 6e8, .tangential = 0.8, .friction = 0.5463});
  rve::compress(discs, {.friction = 0.3});
  report("discs with friction", discs, 512);
  rve::Cell spheres = rve::randomCell(
      {.shape = rve::Shape::sphere, .count = 1000, .sizes = dem::UniformSizes{4e-3, 6e-3}, .solidFraction = 0.5},
      {.modulus = 6e8, .tangential = 0.8, .friction = 0.5});
  rve::compress(spheres, {.pressure = {1e6, 1e6, 1e6}, .friction = 0.3});
  report("spheres with friction", spheres, 32);
  rve::CellState kept;
  const auto begin = std::chrono::steady_clock::now();
  for (int k = 0; k < 1000; ++k) {
    rve::save(discs, kept);
    rve::restore(discs, kept);
  }
  std::printf("putting 400 discs aside and taking them back: %.1f µs\n",
              1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
}
