// Cells that several tests start from.
#pragma once

#include <Eigen/Core>
#include <random>
#include <vector>

#include "dovetail/rve/equilibrium.hpp"
#include "dovetail/rve/packing.hpp"
#include "dovetail/rve/rve.hpp"

namespace dovetail::rve {

inline Springs ordinarySprings() { return {.modulus = 6e8, .tangential = 0.8, .friction = 0.5}; }

/// Random discs at rest under 100 kPa, prepared without friction: dense, no tangential spring stretched.
inline Rve pressedDiscs(int count, std::uint64_t seed = 1) {
  Rve cell = randomCell({.count = count, .seed = seed}, ordinarySprings());
  compress(cell, {.pressure = {1e5, 1e5, 1e5}, .friction = 0.0, .rest = {.tolerance = 1e-6}});
  polish(cell);
  return cell;
}

inline Rve pressedSpheres(int count, std::uint64_t seed = 1) {
  Rve cell = randomCell({.shape = Shape::sphere,
                         .count = count,
                         .sizes = dem::UniformSizes{4e-3, 6e-3},
                         .solidFraction = 0.55,
                         .seed = seed},
                        ordinarySprings());
  compress(cell, {.pressure = {1e6, 1e6, 1e6}, .friction = 0.0, .rest = {.tolerance = 1e-6}});
  polish(cell);
  return cell;
}

/// n × n discs of radius 1.02 mm, 2 mm apart, k_n = 1e4 N/m, 1 m thick (Liu 2018, Table 2.4).
inline Rve squareArray(int n, double radius = 1.02e-3) {
  Grains grains;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) grains.centre.push_back({2e-3 * i, 2e-3 * j, 0.0});
  grains.radius.assign(grains.centre.size(), radius);
  const double side = 2e-3 * n;
  return makeRve(grains, {{Vec3{side, 0, 0}, Vec3{0, side, 0}, Vec3{0, 0, 1}}, {true, true, false}},
                 {.stiffness = 1e4, .tangential = 0.2, .friction = 0.4});
}

inline Components randomMotion(const Components& like, double size, std::mt19937& random) {
  std::uniform_real_distribution<double> u(-size, size);
  Components w = like;
  for (auto& component : w)
    for (double& value : component) value = u(random);
  return w;
}

inline Components scaled(Components w, double factor) {
  for (auto& component : w)
    for (double& value : component) value *= factor;
  return w;
}

inline Eigen::Matrix3d plane(double a, double b, double c, double d) {
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F.topLeftCorner<2, 2>() << a, b, c, d;
  return F;
}

inline Eigen::Matrix3d turned(double angle) {
  return plane(std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle));
}

inline double scalarProduct(const Components& a, const Components& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < a[k].size(); ++i) sum += a[k][i] * b[k][i];
  return sum;
}

/// A layer on a held bottom that repeats sideways.
inline Conditions layerUnder(SideCondition top, bool cornersHeld = false) {
  const Condition D = Condition::displacement, P = Condition::periodic;
  return {.bottom = D, .right = P, .top = top, .left = P, .cornersHeld = cornersHeld};
}

/// Every condition all round, layers under traction, under traction across alone (Liu 2018, eq. 2.43), and others that
/// differ by component.
inline std::vector<Conditions> kindsOfFrames() {
  const Condition D = Condition::displacement, P = Condition::periodic, T = Condition::traction;
  return {everywhere(D),      everywhere(P),      everywhere(T),     layerUnder(T), layerUnder({D, T}, true),
          layerUnder({D, T}), everywhere({P, T}), everywhere({T, D})};
}

}  // namespace dovetail::rve
