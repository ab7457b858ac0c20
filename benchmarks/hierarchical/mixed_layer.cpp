// An infinite layer under vertical pressure, sheared: bottom held, sides periodic, top with traction; with and without
// bonds.
#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

#include "dovetail/core/parallel.hpp"
#include "figure.hpp"
#include "liu_packings.hpp"
#include "servo.hpp"

namespace dovetail::benchmark {

namespace {

constexpr double stiffness = 1e8, pressure = 1.05e6;  // N/m (Liu, thesis TU Eindhoven 2018, Table 2.6)
constexpr double inertialNumber = 1e-3, damping = 0.7, shear = 0.2;

struct Curve {
  double peak = 0.0, where = 0.0, residual = 0.0;
  int bonds = 0, left = 0;
  int lost = 0;  ///< windows in which σ₂₂ was off by more than a twentieth: grains of the frame had been pushed in
};

/// A step of simple shear by dγ at the pressure that is wanted.
void go(rve::Rve& cell, double dt, double dGamma, double most, double wanted) {
  Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
  G(0, 1) += dGamma;
  G(1, 1) += givingWay(cell, 1, wanted, most);
  rve::step(cell, dt, G, damping);
}

/// Means of (σ₁₂/σ₂₂, σ₂₂) over 0.005 of F₁₂ each.
struct Window {
  double ratio = 0.0, normal = 0.0;
};

std::vector<Window> windows(rve::Rve& cell, double rate) {
  constexpr double width = 0.005;
  std::vector<Window> all;
  double gamma = 0.0;
  while (gamma < shear) {
    double sigma12 = 0.0, sigma22 = 0.0;
    int count = 0;
    for (const double end = gamma + width; gamma < end; ++count) {
      const double dt = 0.8 * cell.state.criticalStep;
      go(cell, dt, rate * dt, 4.0 * rate * dt, pressure);
      gamma += rate * dt;
      const Eigen::Matrix3d now = rve::stress(cell).cauchy;
      sigma12 += now(0, 1);
      sigma22 += now(1, 1);
    }
    all.push_back({std::abs(sigma12 / sigma22), -sigma22 / count});
  }
  return all;
}

Curve sheared(rve::Rve cell) {
  Curve curve;
  curve.bonds = rve::balance(cell).bonds;
  const double rate = inertialNumber * std::sqrt(pressure / cell.density) / rve::meanDiameter(cell);
  constexpr int pressing = 4000;
  for (int k = 1; k <= pressing; ++k)
    go(cell, 0.8 * cell.state.criticalStep, 0.0, 1e-5, pressure * std::min(1.0, 2.0 * k / pressing));
  const std::vector<Window> all = windows(cell, rate);
  const auto pressed = [](const Window& window) { return std::abs(window.normal / pressure - 1.0) <= 0.05; };
  curve.lost = static_cast<int>(all.size() - static_cast<std::size_t>(std::ranges::count_if(all, pressed)));
  const auto peak =
      std::ranges::max_element(all, {}, [&](const Window& window) { return pressed(window) ? window.ratio : 0.0; });
  curve.peak = peak->ratio;
  curve.where = 0.005 * (0.5 + static_cast<double>(peak - all.begin()));
  for (auto window = all.end() - 10; window != all.end(); ++window) curve.residual += 0.1 * window->ratio;
  curve.left = rve::balance(cell).bonds;
  return curve;
}

/// Strengths as printed, times a factor.
rve::BondLaw bonds(double factor) {
  return {.normal = stiffness,
          .shear = 0.4 * stiffness,
          .bending = 20.0,
          .tensileStrength = factor * 300.0,
          .shearStrength = factor * 60.0,
          .bendingStrength = factor * 0.2};
}

Curve shearedWithBonds(rve::Rve cell, double factor) {
  rve::bond(cell, bonds(factor));
  return sheared(std::move(cell));
}

}  // namespace

FigureRows mixedLayer(bool quick) {
  const rve::Conditions layer{rve::Condition::displacement, rve::Condition::periodic, rve::Condition::traction,
                              rve::Condition::periodic};
  const rve::Springs springs{.stiffness = stiffness, .tangential = 0.4, .friction = 0.6};
  std::vector<Curve> plain(quick ? 2 : 5), bonded(plain.size()), strong(plain.size());
  parallelTasks(plain.size(), [&](std::size_t k) {
    const rve::Rve cell = rve::framed(densePacking({400, 0.8e-3, 1.2e-3, 1e4, springs}, 1 + 1000 * k), layer);
    plain[k] = sheared(cell);
    bonded[k] = shearedWithBonds(cell, 1.0);
    strong[k] = shearedWithBonds(cell, 10.0);
  });
  std::vector<double> residual, peak, where, bondedWhere, ratio, strongRatio;
  int lost = 0, lostBonded = 0;
  for (std::size_t k = 0; k < plain.size(); ++k) {
    residual.push_back(plain[k].residual);
    peak.push_back(plain[k].peak);
    where.push_back(plain[k].where);
    bondedWhere.push_back(bonded[k].where);
    ratio.push_back(bonded[k].peak / plain[k].peak);
    strongRatio.push_back(strong[k].peak / plain[k].peak);
    lost += plain[k].lost;
    lostBonded += bonded[k].lost;
  }
  const std::string flat = "a flat peak: several windows of 0.005 are within 2 % of it";
  return {rowOf("σ₁₂/σ₂₂, F₁₂ = 0.15 to 0.2", residual, 0.28, 0.03,
                "σ₂₂ was not held in " + std::to_string(lost) + " of " + std::to_string(40 * plain.size()) +
                    " windows, with bonds in " + std::to_string(lostBonded)),
          rowOf("peak of σ₁₂/σ₂₂", peak, std::nan(""), 0.0),
          rowOf("F₁₂ at the peak", where, 0.06, 0.02, flat),
          rowOf("F₁₂ at the peak, bonded", bondedWhere, 0.07, 0.02, flat),
          rowOf("peak, bonded over not", ratio, 1.5, 0.15,
                std::to_string(bonded.back().left) + " of " + std::to_string(bonded.back().bonds) +
                    " bonds are left; mean contact forces are seven times the tensile strength"),
          rowOf("the same, strengths ten times those printed", strongRatio, std::nan(""), 0.0)};
}

}  // namespace dovetail::benchmark
