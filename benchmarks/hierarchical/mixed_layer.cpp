// An infinite layer under vertical pressure, sheared: bottom held, sides periodic, top with traction; with and without
// bonds.
#include <algorithm>
#include <numeric>
#include <string>

#include "dovetail/core/parallel.hpp"
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
  const rve::Springs springs{.stiffness = stiffness, .tangential = 0.4, .friction = 0.6};
  std::vector<Curve> plain(quick ? 2 : 5), bonded(plain.size());
  parallelTasks(plain.size(), [&](std::size_t k) {
    rve::Cell cell = rve::framed(densePacking({400, 0.8e-3, 1.2e-3, 1e4, springs}, 1 + 1000 * k), layer);
    plain[k] = sheared(cell);
    rve::bond(cell, bonds());
    bonded[k] = sheared(cell);
  });
  std::vector<double> residual, peak, where, bondedWhere, ratio;
  double worst = 0.0;
  for (std::size_t k = 0; k < plain.size(); ++k) {
    residual.push_back(plain[k].residual);
    peak.push_back(plain[k].peak);
    where.push_back(plain[k].where);
    bondedWhere.push_back(bonded[k].where);
    ratio.push_back(bonded[k].peak / plain[k].peak);
    worst = std::max({worst, plain[k].worst, bonded[k].worst});
  }
  const std::string flat = "tolerance of reading a flat peak";
  return {rowOf("σ₁₂/σ₂₂, F₁₂ = 0.15 to 0.2", residual, 0.28, 0.03,
                "P₂₂ off by at most " + std::to_string(worst).substr(0, 5) + " of that wanted"),
          rowOf("peak of σ₁₂/σ₂₂", peak, std::nan(""), 0.0), rowOf("F₁₂ at the peak", where, 0.06, 0.02, flat),
          rowOf("F₁₂ at the peak, bonded", bondedWhere, 0.07, 0.02, flat),
          rowOf("peak, bonded over not", ratio, 1.5, 0.15,
                std::to_string(bonded.back().left) + " of " + std::to_string(bonded.back().bonds) +
                    " bonds are left in the last")};
}

}  // namespace dovetail::benchmark
