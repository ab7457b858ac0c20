// Explicit FEM × DEM between rough plates under a side pressure that follows, to 10 % of strain: 512 cells of 400
// discs.
#include <algorithm>
#include <chrono>

#include "biaxial_solid.hpp"
#include "dovetail/core/parallel.hpp"
#include "figure.hpp"

namespace dovetail::benchmark {

namespace {

constexpr double rate = 0.05, damping = 5.0;  // 1/s

Course pressed(std::array<int, 2> elements, const rve::Rve& cell, double pace, double strain) {
  return pressTogether({.elements = elements, .rough = true, .wall = false}, {cell}, pace, damping, strain);
}

/// Seconds by the clock to 0.5 % of strain.
double clocked(const rve::Rve& cell, int threadCount) {
  const int before = threads();
  setThreads(threadCount);
  const auto start = std::chrono::steady_clock::now();
  pressed({8, 16}, cell, rate, 0.005);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  setThreads(before);
  return took.count();
}

}  // namespace

FigureRows explicitBiaxial(bool) {
  const double none = std::nan("");
  std::vector<double> peaks, strains, lates, slowPeaks;
  Course course;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const rve::Rve cell = sand(seed);
    course = pressed({8, 16}, cell, rate, 0.1);
    const Look& peak = course.peak(&Look::plate);
    peaks.push_back(1e-3 * peak.plate);
    strains.push_back(100.0 * peak.strain);
    lates.push_back(1e-3 * course.mean(&Look::plate, 0.079, 0.081));
  }
  const rve::Rve cell = sand(1);
  const double slow = pressed({8, 16}, cell, 0.5 * rate, 0.025).peak(&Look::plate).plate;
  const double speedUp = threads() > 1 ? clocked(cell, 1) / clocked(cell, 2) : none;
  const std::string other = "beforehand: 800 cells, one packing; peaks of single cells scatter by 20 kPa";
  return {rowOf("peak, kPa", peaks, 292.0, 20.0, other),
          rowOf("strain at the peak, %", strains, 1.65, 0.3, other),
          rowOf("at 8 % of strain, kPa", lates, 247.0, 20.0, other),
          {"half the rate moves the peak by, %", 100.0 * (1e-3 * slow / peaks.front() - 1.0), 0.0, 0.0, 2.0},
          {"kinetic energy over work at the peak", course.peak(&Look::plate).kineticFraction, 0.0, 0.0, 1e-2},
          {"the same at 10 %", course.looks.back().kineticFraction, 0.0, 0.0, 1e-3},
          {"residual of the ledger over work", course.residual, 0.0, none},
          {"steps of the solid", static_cast<double>(course.steps), 0.0, none},
          {"seconds of the processor over two", 0.5 * course.seconds, 0.0, 0.0, 60.0, "to 10 %"},
          {"two threads, times faster, at most 2", std::min(speedUp, 2.0), 0.0, 2.0, 0.1,
           "by the clock, to 0.5 % of strain"}};
}

}  // namespace dovetail::benchmark
