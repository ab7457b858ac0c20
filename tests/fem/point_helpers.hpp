// One point of a material: its answer, its derivatives by differences, random states.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <random>
#include <vector>

#include "dovetail/fem/laws/point_material.hpp"

namespace dovetail::fem {

using Matrix9 = Eigen::Matrix<double, 9, 9>;

struct PointResult {
  Eigen::Matrix3d P;
  Matrix9 tangent;
  double energy, dissipated;
  std::vector<double> history;
};

inline std::vector<double> freshHistory(const PointMaterial& material) {
  std::vector<double> history(material.historySize());
  material.startHistory(history);
  return history;
}

/// Four points at once, each with its history.
inline std::array<PointResult, 4> evaluateFour(const PointMaterial& material, const std::array<Eigen::Matrix3d, 4>& F,
                                               const std::array<std::vector<double>, 4>& history, double dt,
                                               bool rateAtEnd = false) {
  const std::size_t size = material.historySize();
  std::vector<double> f(36), P(36), tangent(324), energy(4), dissipated(4), old(4 * size), fresh(4 * size);
  for (std::size_t l = 0; l < 4; ++l) {
    for (std::size_t i = 0; i < 9; ++i) f[4 * i + l] = F[l](static_cast<int>(i / 3), static_cast<int>(i % 3));
    std::copy(history[l].begin(), history[l].end(), old.begin() + static_cast<std::ptrdiff_t>(l * size));
  }
  material.evaluate({1, f.data(), P.data(), tangent.data(), energy.data(), dissipated.data(), old.data(), fresh.data(),
                     dt, rateAtEnd});
  std::vector<double> stressAlone(36);
  material.evaluate(
      {1, f.data(), stressAlone.data(), nullptr, nullptr, nullptr, old.data(), fresh.data(), dt, rateAtEnd});
  std::array<PointResult, 4> results;
  for (std::size_t l = 0; l < 4; ++l) {
    PointResult& r = results[l];
    for (std::size_t i = 0; i < 9; ++i) {
      r.P(static_cast<int>(i / 3), static_cast<int>(i % 3)) = P[4 * i + l];
      for (std::size_t k = 0; k < 9; ++k)
        r.tangent(static_cast<int>(i), static_cast<int>(k)) = tangent[4 * (9 * i + k) + l];
      if (!std::isnan(P[4 * i + l])) {
        EXPECT_NEAR(stressAlone[4 * i + l], P[4 * i + l], 1e-12 * (1.0 + std::abs(P[4 * i + l])));
      }
    }
    r.energy = energy[l];
    r.dissipated = dissipated[l];
    r.history.assign(fresh.begin() + static_cast<std::ptrdiff_t>(l * size),
                     fresh.begin() + static_cast<std::ptrdiff_t>((l + 1) * size));
  }
  return results;
}

inline PointResult evaluate(const PointMaterial& material, const Eigen::Matrix3d& F, const std::vector<double>& history,
                            double dt = 0.0, bool rateAtEnd = false) {
  return evaluateFour(material, {F, F, F, F}, {history, history, history, history}, dt, rateAtEnd)[0];
}
inline PointResult evaluate(const PointMaterial& material, const Eigen::Matrix3d& F) {
  return evaluate(material, F, freshHistory(material));
}

/// ∂P/∂F by central differences, extrapolated from two widths.
inline Matrix9 differencedTangent(const PointMaterial& material, const Eigen::Matrix3d& F,
                                  const std::vector<double>& history, double dt = 0.0, double h = 1e-4,
                                  bool rateAtEnd = false) {
  Matrix9 result;
  for (int k = 0; k < 9; ++k) {
    const auto difference = [&](double width) -> Eigen::Matrix3d {
      Eigen::Matrix3d up = F, down = F;
      up(k / 3, k % 3) += width;
      down(k / 3, k % 3) -= width;
      return (evaluate(material, up, history, dt, rateAtEnd).P - evaluate(material, down, history, dt, rateAtEnd).P) /
             (2.0 * width);
    };
    const Eigen::Matrix3d best = (4.0 * difference(0.5 * h) - difference(h)) / 3.0;
    for (int r = 0; r < 9; ++r) result(r, k) = best(r / 3, r % 3);
  }
  return result;
}

inline Eigen::Matrix3d randomMatrix(std::mt19937& random, double amplitude) {
  std::uniform_real_distribution<double> value(-amplitude, amplitude);
  Eigen::Matrix3d m;
  for (int i = 0; i < 9; ++i) m(i / 3, i % 3) = value(random);
  return m;
}
inline Eigen::Matrix3d rotation(double angle, const Eigen::Vector3d& axis) {
  return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}
inline Eigen::Matrix3d randomRotation(std::mt19937& random) {
  const Eigen::Matrix3d m = randomMatrix(random, 1.0);
  return rotation(3.0 * m(0, 0), m.row(1).transpose());
}
/// Stretches between 1 − amplitude and 1 + amplitude, turned before and after.
inline Eigen::Matrix3d randomGradient(std::mt19937& random, double amplitude) {
  std::uniform_real_distribution<double> value(1.0 - amplitude, 1.0 + amplitude);
  const double a = value(random), b = value(random), c = value(random);
  return randomRotation(random) * Eigen::Vector3d(a, b, c).asDiagonal() * randomRotation(random);
}
inline Eigen::Matrix3d stretches(double a, double b, double c) { return Eigen::Vector3d(a, b, c).asDiagonal(); }

}  // namespace dovetail::fem
