// Biaxial compression of single cells of 400 discs at constant side pressure.
#include <algorithm>

#include "biaxial_solid.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/rve/drive.hpp"
#include "figure.hpp"

namespace dovetail::benchmark {

namespace {

constexpr double pressure = 1e5;

struct Curve {
  double voidRatio = 0.0, peak = 0.0, late = 0.0;  // Pa
};

Curve compressed(std::uint64_t seed) {
  rve::Rve cell = sand(seed);
  Curve curve{.voidRatio = 1.0 / rve::solidFraction(cell) - 1.0};
  const rve::Drive how = rve::biaxial(cell.shape, 1, pressure);
  int looks = 0;
  for (const rve::DrivenState& state : rve::drive(cell, how, rve::equalStrains(0.1, 200))) {
    const double axial = -state.stress(1, 1);
    curve.peak = std::max(curve.peak, axial);
    if (state.strain < 0.05) continue;
    curve.late += axial;
    ++looks;
  }
  curve.late /= looks;
  return curve;
}

}  // namespace

FigureRows lz19Cell(bool) {
  std::vector<Curve> curves(8);
  parallelTasks(curves.size(), [&](std::size_t k) { curves[k] = compressed(k + 1); });
  const auto row = [&](const std::string& what, double unit, double Curve::*value, double printed, double allowed,
                       const std::string& note = {}) {
    std::vector<double> values;
    for (const Curve& curve : curves) values.push_back(unit * (curve.*value));
    return rowOf(what, values, printed, allowed, note);
  };
  return {row("void ratio", 1.0, &Curve::voidRatio, 0.177, 0.005),
          row("peak, kPa", 1e-3, &Curve::peak, 280.0, 20.0, "largest of 200 looks, peaks scatter by packing"),
          row("mean from 5 to 10 % of strain, kPa", 1e-3, &Curve::late, 220.0, 20.0)};
}

}  // namespace dovetail::benchmark
