// Biaxial compression of single cells of 400 discs at constant side pressure.
#include <algorithm>
#include <cmath>

#include "biaxial_solid.hpp"
#include "dovetail/core/parallel.hpp"
#include "figure.hpp"
#include "servo.hpp"

namespace dovetail::benchmark {

namespace {

constexpr double pressure = 1e5, inertialNumber = 1e-3;

struct Curve {
  double voidRatio = 0.0, peak = 0.0, late = 0.0, side = 0.0;  // Pa, means over 100 steps
};

Curve compressed(std::uint64_t seed) {
  rve::Rve cell = sand(seed);
  Curve curve{.voidRatio = 1.0 / rve::solidFraction(cell) - 1.0};
  const double rate = inertialNumber * std::sqrt(pressure / cell.density) / rve::meanDiameter(cell);
  double strain = 0.0, smooth = pressure;
  std::int64_t looks = 0;
  while (strain < 0.1) {
    const double dt = 0.8 * cell.state.criticalStep;
    Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
    // What leaves the side some per cent too high.
    G(0, 0) += givingWay(cell, 0, pressure, 4.0 * rate * dt);
    G(1, 1) -= rate * dt;
    rve::step(cell, dt, G, 0.1);
    strain += rate * dt;
    const Eigen::Matrix3d now = rve::stress(cell).cauchy;
    smooth += 0.01 * (-now(1, 1) - smooth);
    curve.peak = std::max(curve.peak, smooth);
    if (strain < 0.05) continue;
    curve.late -= now(1, 1);
    curve.side -= now(0, 0);
    ++looks;
  }
  curve.late /= static_cast<double>(looks);
  curve.side /= static_cast<double>(looks);
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
  return {row("void ratio", 1.0, &Curve::voidRatio, 0.175, 0.005, "printed: 0.177"),
          row("peak, kPa", 1e-3, &Curve::peak, 290.0, 20.0, "printed: 280; its side pressure is not above 100"),
          row("mean from 5 to 10 % of strain, kPa", 1e-3, &Curve::late, 225.0, 20.0, "printed: 220"),
          row("side pressure there, kPa", 1e-3, &Curve::side, std::nan(""), 0.0)};
}

}  // namespace dovetail::benchmark
