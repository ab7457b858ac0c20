// An infinite layer under vertical pressure, sheared: bottom held, sides periodic, top with traction; with and without
// bonds.
#include <string>

#include "dovetail/rve/operators.hpp"
#include "figure.hpp"
#include "liu_packings.hpp"

namespace dovetail::benchmark {

namespace {

constexpr double stiffness = 1e8, pressure = 1.05e6;  // N/m (Liu, thesis TU Eindhoven 2018, Table 2.6)
constexpr double step = 5e-4;                         // of F₁₂

/// One step of F₁₂, with the F₂₂ that the missing pressure asks for.
void go(rve::Cell& cell, double shear, double modulus, double wanted) {
  Eigen::Matrix3d F = cell.state.F;
  F(0, 1) = shear;
  const double missing = -wanted - rve::stressOfReactions(cell)(1, 1);
  F(1, 1) += std::clamp(missing / modulus, -2e-3, 2e-3);
  rve::followPath(cell, F, {.inertialNumber = 3e-3, .rest = {.unbalanced = 1e-2, .steps = 3000}});
}

struct Curve {
  double peak = 0.0, where = 0.0, residual = 0.0, worst = 0.0;  ///< worst: |P₂₂/P₂₂* − 1|
  int bonds = 0, left = 0;
};

/// σ₁₂/σ₂₂ over F₁₂ to 0.2, running means over 0.005.
Curve sheared(rve::Cell cell) {
  Curve curve;
  curve.bonds = rve::balance(cell).bonds;
  const double modulus = rve::uniformStrain(cell)(4, 4);
  for (int k = 1; k <= 60; ++k) go(cell, 0.0, modulus, pressure * std::min(1.0, k / 30.0));
  std::vector<double> ratios;
  constexpr int steps = 400, window = 10;
  for (int k = 1; k <= steps; ++k) {
    go(cell, step * k, modulus, pressure);
    const Eigen::Matrix3d sigma = cauchyOf(cell);
    ratios.push_back(std::abs(sigma(0, 1) / sigma(1, 1)));
    curve.worst = std::max(curve.worst, std::abs(rve::stressOfReactions(cell)(1, 1) / -pressure - 1.0));
  }
  for (int k = window; k <= steps; ++k) {
    const double mean = std::accumulate(ratios.begin() + k - window, ratios.begin() + k, 0.0) / window;
    if (mean > curve.peak) {
      curve.peak = mean;
      curve.where = step * (k - 0.5 * window);
    }
  }
  curve.residual = std::accumulate(ratios.end() - 100, ratios.end(), 0.0) / 100.0;
  curve.left = rve::balance(cell).bonds;
  return curve;
}

rve::BondLaw bonds() {
  return {.normal = stiffness,
          .shear = 0.4 * stiffness,
          .bending = 20.0,
          .tensileStrength = 300.0,
          .shearStrength = 60.0,
          .bendingStrength = 0.2};
}

}  // namespace

FigureRows mixedLayer(bool quick) {
  const rve::Conditions layer{rve::Condition::displacement, rve::Condition::periodic, rve::Condition::traction,
                              rve::Condition::periodic};
  std::vector<double> residual, where, bondedWhere, peak, ratio;
  double worst = 0.0;
  std::string broken;
  std::uint64_t seed = 1;
  for (int k = 0; k < (quick ? 2 : 5); ++k, ++seed) {
    rve::Cell cell = rve::framed(
        densePacking({400, 0.8e-3, 1.2e-3, 1e4, {.stiffness = stiffness, .tangential = 0.4, .friction = 0.6}}, seed),
        layer);
    const Curve plain = sheared(cell);
    rve::bond(cell, bonds());
    const Curve bonded = sheared(cell);
    residual.push_back(plain.residual);
    where.push_back(plain.where);
    peak.push_back(plain.peak);
    bondedWhere.push_back(bonded.where);
    ratio.push_back(bonded.peak / plain.peak);
    worst = std::max({worst, plain.worst, bonded.worst});
    broken = std::to_string(bonded.left) + " of " + std::to_string(bonded.bonds) + " bonds are left in the last";
  }
  FigureRows rows;
  const auto add = [&rows](const char* what, const std::vector<double>& values, double printed, double allowed,
                           const std::string& note) {
    rows.push_back({what, meanOf(values).mean, meanOf(values).scatter, printed, allowed, note});
  };
  add("σ₁₂/σ₂₂, F₁₂ = 0.15 to 0.2", residual, 0.28, 0.03,
      "P₂₂ off by at most " + std::to_string(worst).substr(0, 5) + " of that wanted");
  add("peak of σ₁₂/σ₂₂", peak, std::nan(""), 0.0, "");
  add("F₁₂ at the peak", where, 0.06, 0.02, "tolerance of reading a flat peak");
  add("F₁₂ at the peak, bonded", bondedWhere, 0.07, 0.02, "tolerance of reading a flat peak");
  add("peak, bonded over not", ratio, 1.5, 0.15, broken);
  return rows;
}

}  // namespace dovetail::benchmark
