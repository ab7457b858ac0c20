// Biaxial compression of 1 × 1 to 4 × 8 quad4 of cells of 228 discs, with discs that turn and with discs that do not.
#include <algorithm>

#include "biaxial_solid.hpp"
#include "dovetail/rve/packing.hpp"
#include "figure.hpp"

namespace dovetail::benchmark {

namespace {

// Liu 2018, Table 3.3, with the pressure that 0.015 k_n stands for.
constexpr double stiffness = 1e4, thickness = 1e-3, pressure = 0.015 * stiffness / thickness;  // N/m, m, Pa

/// 228 discs, largest radius 1.5 times the least, under the pressure; made with as much friction as gives the solid
/// fraction that is printed, 0.846, within 0.01.
rve::Cell packing(std::uint64_t seed, bool turns) {
  rve::Springs springs{.stiffness = stiffness, .tangential = 0.2, .friction = 0.4};
  rve::Cell cell = rve::randomCell({.count = 228,
                                    .sizes = dem::UniformSizes{0.3e-3, 0.45e-3},
                                    .thickness = thickness,
                                    .density = 2000.0,
                                    .seed = seed},
                                   springs);
  rve::compress(cell, {.pressure = {pressure, pressure, 0.0}, .friction = 0.1, .rest = {.unbalanced = 1e-6}});
  // Springs against rolling that never slip, much stiffer than the others: all turn as one.
  springs.rolling = turns ? 0.0 : 20.0;
  springs.rollingLimit = turns ? 0.0 : 1e6;
  rve::setSprings(cell, springs);
  return cell;
}

}  // namespace

FigureRows biaxial(bool quick) {
  FigureRows rows;
  const std::uint64_t seeds = quick ? 3 : 5;
  const auto add = [&](std::array<int, 2> elements, bool turns, double printed) {
    std::vector<double> peaks, strains, late;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
      const Course course =
          pressTogether({.elements = elements, .size = {0.01, 0.02, thickness}, .pressure = pressure, .wall = false},
                        {packing(seed, turns)}, 1.0, 100.0, 0.1);
      const Look& peak = course.peak(&Look::stressRatio);
      peaks.push_back(peak.stressRatio);
      strains.push_back(100.0 * peak.strain);
      late.push_back(course.mean(&Look::stressRatio, 0.065, 0.08));
    }
    const std::string mesh = std::to_string(elements[0]) + " × " + std::to_string(elements[1]) +
                             (turns ? ", discs turn" : ", turns blocked");
    rows.push_back(rowOf("largest stress ratio, " + mesh, peaks, printed, 0.03,
                         turns ? "solid fraction 0.854, printed 0.846"
                               : "by springs against rolling: stronger than discs that are held"));
    rows.push_back(rowOf("strain there, %, " + mesh, strains, std::nan(""), 0.0));
    rows.push_back(rowOf("stress ratio from 6.5 to 8 %, " + mesh, late, std::nan(""), 0.0));
  };
  add({1, 1}, true, 0.39);
  add({1, 1}, false, 0.48);
  add({2, 4}, true, 0.39);
  if (!quick) add({2, 4}, false, 0.48), add({4, 8}, true, 0.39);
  return rows;
}

}  // namespace dovetail::benchmark
