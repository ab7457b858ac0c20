// Biaxial compression of 1 × 1 to 4 × 8 quad4 of cells of 228 discs, with discs that turn and with discs that do not,
// beside 2 and 8 such cells of which every grain is there.
#include <algorithm>
#include <random>

#include "biaxial_solid.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/rve/packing.hpp"
#include "figure.hpp"
#include "servo.hpp"
#include "tiles.hpp"

namespace dovetail::benchmark {

namespace {

// Liu 2018, Table 3.3, with the pressure that 0.015 k_n stands for.
constexpr double stiffness = 1e4, thickness = 1e-3, pressure = 0.015 * stiffness / thickness;  // N/m, m, Pa
constexpr double rate = 1.0;                                                                   // 1/s

/// 228 discs, largest radius 1.5 times the least, under the pressure; made with as much friction as gives the solid
/// fraction that is printed, 0.846, within 0.01.
rve::Rve packing(std::uint64_t seed, bool turns) {
  rve::Springs springs{.stiffness = stiffness, .tangential = 0.2, .friction = 0.4};
  rve::Rve cell = rve::randomCell({.count = 228,
                                   .sizes = dem::UniformSizes{0.3e-3, 0.45e-3},
                                   .thickness = thickness,
                                   .density = 2000.0,
                                   .seed = seed},
                                  springs);
  rve::compress(cell, {.pressure = {pressure, pressure, 0.0}, .friction = 0.1, .rest = {.tolerance = 1e-6}});
  rve::setSprings(cell, springs);
  if (!turns)
    for (double& inertia : cell.inertia) inertia *= 1e12;
  return cell;
}

/// Stress ratio of nx × ny copies of a cell that repeat, every grain followed, by strains of 0.05 %.
std::vector<double> allGrains(const rve::Rve& cell, int nx, int ny, double strain) {
  geometry::Lattice lattice = cell.state.lattice;
  lattice.period[0] = nx * lattice.period[0];
  lattice.period[1] = ny * lattice.period[1];
  rve::Rve all = rve::makeRve(tiles(cell, nx, ny), lattice, cell.springs);
  // Copies would stay copies but for this, which moves grains by a hundredth of their overlaps.
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> speed(-0.01, 0.01);
  for (std::size_t k = 0; k < 2; ++k)
    for (double& v : all.state.v[k]) v = speed(random);
  constexpr double between = 5e-4;
  std::vector<double> ratios;
  double height = 1.0, sum = 0.0;
  for (int count = 0; height > 1.0 - strain;) {
    const double dt = 0.8 * all.state.criticalStep, less = rate * dt;
    Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
    G(0, 0) += givingWay(all, 0, pressure, 4.0 * less);
    G(1, 1) -= less / height;
    height -= less;
    rve::step(all, dt, G, 0.1);
    const Eigen::Matrix3d now = rve::stress(all).cauchy;
    sum += (now(1, 1) - now(0, 0)) / (now(1, 1) + now(0, 0));
    ++count;
    if (1.0 - height < between * static_cast<double>(ratios.size() + 1)) continue;
    ratios.push_back(sum / count);
    sum = 0.0;
    count = 0;
  }
  return ratios;
}

/// Root mean square of the difference up to a strain of 5 %, in % of the largest of all grains.
double misfit(const Course& course, const std::vector<double>& all) {
  double sum = 0.0;
  const std::size_t n = std::min(all.size(), course.looks.size());
  for (std::size_t k = 0; k < n; ++k) sum += std::pow(course.looks[k].stressRatio - all[k], 2);
  return 100.0 * std::sqrt(sum / static_cast<double>(n)) / *std::ranges::max_element(all);
}

}  // namespace

FigureRows biaxial(bool quick) {
  FigureRows rows;
  const std::size_t packings = quick ? 3 : 5;
  std::vector<std::vector<double>> two(packings), eight(packings);
  parallelTasks(packings, [&](std::size_t s) {
    two[s] = allGrains(packing(s + 1, true), 1, 2, 0.05);
    eight[s] = allGrains(packing(s + 1, true), 2, 4, 0.05);
  });
  const auto add = [&](std::array<int, 2> elements, bool turns, double printed) {
    std::vector<double> peaks, strains, late, fromTwo, fromEight;
    for (std::size_t s = 0; s < packings; ++s) {
      const Course course =
          pressTogether({.elements = elements, .size = {0.01, 0.02, thickness}, .pressure = pressure, .wall = false},
                        {packing(s + 1, turns)}, rate, 100.0, 0.1);
      const Look& peak = course.peak(&Look::stressRatio);
      peaks.push_back(peak.stressRatio);
      strains.push_back(100.0 * peak.strain);
      late.push_back(course.mean(&Look::stressRatio, 0.065, 0.08));
      fromTwo.push_back(misfit(course, two[s]));
      fromEight.push_back(misfit(course, eight[s]));
    }
    const std::string mesh = std::to_string(elements[0]) + " × " + std::to_string(elements[1]) +
                             (turns ? ", discs turn" : ", turns blocked");
    rows.push_back(
        rowOf("largest stress ratio, " + mesh, peaks, printed, 0.03,
              turns ? "solid fraction 0.854, printed 0.846" : "all discs are held; printed: those inside the frame"));
    rows.push_back(rowOf("strain there, %, " + mesh, strains, std::nan(""), 0.0));
    rows.push_back(rowOf("stress ratio from 6.5 to 8 %, " + mesh, late, std::nan(""), 0.0));
    if (!turns) return;
    rows.push_back(rowOf("misfit up to 5 %, in % of the peak, to 456 discs, " + mesh, fromTwo, 0.0, 5.0));
    rows.push_back(rowOf("misfit up to 5 %, in % of the peak, to 1824 discs, " + mesh, fromEight, 0.0, 5.0));
  };
  add({1, 1}, true, 0.39);
  add({1, 1}, false, 0.48);
  add({2, 4}, true, 0.39);
  if (!quick) add({2, 4}, false, 0.48), add({4, 8}, true, 0.39);
  return rows;
}

}  // namespace dovetail::benchmark
