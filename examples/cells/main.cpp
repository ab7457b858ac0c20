// A column of sand in a solver of our own: bars in a row, each with a cell of grains that cannot widen for its law.
#include <Eigen/LU>
#include <cstdio>

#include "dovetail/hierarchical/cell_field.hpp"
#include "dovetail/rve/operators.hpp"
#include "dovetail/rve/packing.hpp"

using namespace dovetail;

constexpr int bars = 4, steps = 5;
constexpr double length = 0.25, shortening = 2e-4;  // m, of a bar, and of the column in a step

rve::Rve sand(std::uint64_t seed) {
  rve::Rve cell = rve::randomCell({.count = 150, .seed = seed}, {.modulus = 6e8, .tangential = 0.8, .friction = 0.5});
  rve::compress(cell, {.pressure = {1e5, 1e5, 0.0}, .friction = 0.2, .rest = {.tolerance = 1e-6}});
  return cell;
}

int main() {
  const hierarchical::QuasiStaticCells manner{.unbalanced = 1e-6};
  std::vector<rve::Rve> cells;
  for (std::uint64_t seed = 1; seed <= bars; ++seed) cells.push_back(sand(seed));
  Eigen::VectorXd u = Eigen::VectorXd::Zero(bars + 1), P(bars), stiffness(bars);
  for (int step = 1; step <= steps; ++step) {
    u[bars] = -shortening * step;
    int iterations = 0;
    for (;; ++iterations) {
      if (iterations == 20) return 1;
      std::vector<rve::Rve> moved = cells;  // every iteration starts from the last equilibrium
      for (int e = 0; e < bars; ++e) {
        rve::Rve& cell = moved[static_cast<std::size_t>(e)];
        Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
        F(1, 1) += (u[e + 1] - u[e]) / length;
        hierarchical::relax(cell, F, manner);
        P[e] = rve::nominalStress(cell)(1, 1);                    // Pa, on a column of 1 m²
        stiffness[e] = rve::elasticTangent(cell)(4, 4) / length;  // ∂P₂₂/∂F₂₂ in row and column 3·1 + 1
      }
      const Eigen::VectorXd force = P.tail(bars - 1) - P.head(bars - 1);  // on the nodes between the bars
      if (force.norm() <= 1e-5 * P.norm()) {
        cells = std::move(moved);
        break;
      }
      Eigen::MatrixXd K = Eigen::MatrixXd::Zero(bars - 1, bars - 1);
      for (int n = 0; n < bars - 1; ++n) {
        K(n, n) = stiffness[n] + stiffness[n + 1];
        if (n > 0) K(n, n - 1) = K(n - 1, n) = -stiffness[n];
      }
      u.segment(1, bars - 1) += K.lu().solve(force);
    }
    std::printf("shortened by %.2f %%: %.1f kPa after %d iterations\n", -100.0 * u[bars] / (bars * length),
                -1e-3 * P.mean(), iterations);
  }
  return -P.mean() > 1.15e5 ? 0 : 1;  // it has a stiffness
}
