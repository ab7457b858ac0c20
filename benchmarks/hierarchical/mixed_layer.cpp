// An infinite layer under vertical pressure, sheared far: bottom held, sides periodic, the top under traction; with and
// without bonds.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "dovetail/core/parallel.hpp"
#include "figure.hpp"
#include "liu_packings.hpp"

namespace dovetail::benchmark {

namespace {

constexpr double stiffness = 1e8, pressure = 1.05e6;  // N/m (Liu, thesis TU Eindhoven 2018, Table 2.6)
constexpr double inertialNumber = 1e-3, damping = 0.7, shear = 0.6, width = 0.005;

struct Curve {
  double peak = 0.0, where = 0.0, early = 0.0, critical = 0.0;
  int bonds = 0, pressed = 0;
  double bending = 0.0;  ///< fraction of the stored energy that bonds hold by bending, at the peak
  int lost = 0;  ///< windows in which σ₂₂ was off by more than a twentieth: grains of the frame had been pushed in
};

/// A step of simple shear by dγ; the height gives way to the pressure that is wanted.
void go(rve::Rve& cell, double dt, double dGamma, double most, double wanted) {
  const double r = 0.5 * rve::meanDiameter(cell);
  const double k = rve::normalStiffness(cell.springs, r, r) / norm(cell.state.lattice.period[2]);
  const double excess = -rve::stress(cell).cauchy(1, 1) - wanted;
  Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
  G(0, 1) += dGamma;
  G(1, 1) += std::clamp(excess / (10.0 * k), -most, most);
  rve::step(cell, dt, G, damping);
}

double bendingFraction(const rve::Rve& cell) {
  double energy = 0.0;
  for (const rve::Bond& bond : cell.state.contacts.bond)
    energy += 0.5 * bond.fraction * cell.bonds.bending * bond.turn * bond.turn;
  return energy / rve::storedEnergy(cell);
}

/// Means of (σ₁₂/σ₂₂, σ₂₂) over 0.005 of F₁₂ each, and the bending fraction at their ends.
struct Window {
  double ratio = 0.0, normal = 0.0, bending = 0.0;
};

std::vector<Window> windows(rve::Rve& cell, double rate) {
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
    all.push_back({std::abs(sigma12 / sigma22), -sigma22 / count, bendingFraction(cell)});
  }
  return all;
}

bool isPressed(const Window& window) { return std::abs(window.normal / pressure - 1.0) <= 0.05; }

/// Of the windows between two shears in which the layer is pressed.
double meanRatio(const std::vector<Window>& all, double from, double to) {
  double sum = 0.0;
  int count = 0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const double at = width * (static_cast<double>(k) + 0.5);
    if (at > from && at < to && isPressed(all[k])) sum += all[k].ratio, ++count;
  }
  return sum / count;
}

Curve sheared(rve::Rve cell) {
  Curve curve;
  curve.bonds = rve::balance(cell).bonds;
  const double rate = inertialNumber * std::sqrt(pressure / cell.density) / rve::meanDiameter(cell);
  constexpr int pressing = 4000;
  for (int k = 1; k <= pressing; ++k)
    go(cell, 0.8 * cell.state.criticalStep, 0.0, 1e-5, pressure * std::min(1.0, 2.0 * k / pressing));
  curve.pressed = rve::balance(cell).bonds;
  const std::vector<Window> all = windows(cell, rate);
  curve.lost = static_cast<int>(all.size() - static_cast<std::size_t>(std::ranges::count_if(all, isPressed)));
  const auto peak = std::ranges::max_element(
      all.begin(), all.begin() + 40, {}, [](const Window& window) { return isPressed(window) ? window.ratio : 0.0; });
  curve.peak = peak->ratio;
  curve.bending = peak->bending;
  curve.where = width * (0.5 + static_cast<double>(peak - all.begin()));
  curve.early = meanRatio(all, 0.15, 0.2);
  curve.critical = meanRatio(all, 0.4, 0.6);
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
  using enum rve::Condition;
  // With the top prescribed along x grain by grain (Liu 2018, eq. 2.43) it loses the grains, and the pressure, past
  // 0.2.
  const rve::Conditions layer{.bottom = displacement, .right = periodic, .top = traction, .left = periodic};
  const rve::Springs springs{.stiffness = stiffness, .tangential = 0.4, .friction = 0.6};
  const std::vector<double> factors = quick ? std::vector{1.0, 18.0} : std::vector{1.0, 3.0, 6.0, 10.0, 18.0};
  std::vector<Curve> plain(quick ? 3 : 5);
  std::vector<std::vector<Curve>> bonded(factors.size(), std::vector<Curve>(plain.size()));
  parallelTasks(plain.size(), [&](std::size_t k) {
    const rve::Rve cell = rve::framed(densePacking({400, 0.8e-3, 1.2e-3, 1e4, springs}, 1 + 1000 * k), layer);
    plain[k] = sheared(cell);
    for (std::size_t f = 0; f < factors.size(); ++f) bonded[f][k] = shearedWithBonds(cell, factors[f]);
  });
  const auto over = [](const std::vector<Curve>& curves, const auto& value) {
    std::vector<double> values;
    for (const Curve& curve : curves)
      if (const double one = value(curve); !std::isnan(one)) values.push_back(one);
    return values;
  };
  int lost = 0;
  for (const Curve& curve : plain) lost += curve.lost;
  FigureRows rows{rowOf("σ₁₂/σ₂₂, F₁₂ = 0.4 to 0.6", over(plain, [](const Curve& c) { return c.critical; }), 0.28, 0.03,
                        "of packings that keep their pressure; it was not held in " + std::to_string(lost) + " of " +
                            std::to_string(120 * plain.size()) + " windows"),
                  rowOf("σ₁₂/σ₂₂, F₁₂ = 0.15 to 0.2", over(plain, [](const Curve& c) { return c.early; }), std::nan(""),
                        0.0, "printed as the critical state, which is not reached there"),
                  rowOf("peak of σ₁₂/σ₂₂", over(plain, [](const Curve& c) { return c.peak; }), std::nan(""), 0.0),
                  rowOf("F₁₂ at the peak", over(plain, [](const Curve& c) { return c.where; }), std::nan(""), 0.0,
                        "printed: 0.06; a flat peak, several windows of 0.005 are within 2 % of it")};
  for (std::size_t f = 0; f < factors.size(); ++f) {
    const std::string name = ", strengths " + std::to_string(std::lround(factors[f])) + " times those printed";
    std::vector<double> ratio;
    for (std::size_t k = 0; k < plain.size(); ++k) ratio.push_back(bonded[f][k].peak / plain[k].peak);
    rows.push_back(rowOf("peak, bonded over not" + name, ratio, std::nan(""), 0.0,
                         "printed: 1.5, which the printed strengths cannot give"));
    rows.push_back(rowOf("bonds left when pressed, %" + name,
                         over(bonded[f], [](const Curve& c) { return 100.0 * c.pressed / c.bonds; }), std::nan(""),
                         0.0));
    rows.push_back(rowOf("bending of bonds, % of the stored energy at the peak" + name,
                         over(bonded[f], [](const Curve& c) { return 100.0 * c.bending; }), std::nan(""), 0.0,
                         "printed: about 10"));
  }
  return rows;
}

}  // namespace dovetail::benchmark
