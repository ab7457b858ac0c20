// Checks that every term must pass: forces from energies, tangents from forces, at random states.
#pragma once

#include <gtest/gtest.h>

#include "dovetail/fem/model/model.hpp"
#include "dovetail/linalg/block_matrix.hpp"
#include "helpers.hpp"

namespace dovetail::fem {

inline constexpr std::array spatialCellShapes = {ElementShape::hex8, ElementShape::hex20, ElementShape::hex27,
                                                 ElementShape::tet4, ElementShape::tet10};

inline std::vector<Vec3> forcesOf(Term& term, const Nodes& nodes, const Instant& now) {
  std::vector<Vec3> f(nodes.u.size());
  term.addForces(nodes, now, f);
  return f;
}

inline double largest(std::span<const Vec3> field) {
  double most = 0.0;
  for (const Vec3& value : field) most = std::max(most, norm(value));
  return most;
}

inline double productOf(std::span<const Vec3> a, std::span<const Vec3> b) {
  double sum = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n) sum += dot(a[n], b[n]);
  return sum;
}

/// (g(x + h d) − g(x − h d)) / 2h of the field x.
template <class Function>
auto centralDifference(std::vector<Vec3>& x, const std::vector<Vec3>& d, double h, Function&& g) {
  const std::vector<Vec3> kept = x;
  for (std::size_t n = 0; n < x.size(); ++n) x[n] = kept[n] + h * d[n];
  auto plus = g();
  for (std::size_t n = 0; n < x.size(); ++n) x[n] = kept[n] - h * d[n];
  const auto minus = g();
  x = kept;
  if constexpr (std::is_same_v<std::decay_t<decltype(plus)>, double>) {
    return (plus - minus) / (2.0 * h);
  } else {
    for (std::size_t n = 0; n < plus.size(); ++n) plus[n] = (plus[n] - minus[n]) / (2.0 * h);
    return plus;
  }
}

/// f · d = −∂energy/∂u · d for random d, relative to |f||d|.
inline void expectForceFromEnergy(Term& term, Nodes& nodes, const Instant& now, double tolerance, double h = 1e-5) {
  ASSERT_TRUE(term.hasEnergy());
  const std::vector<Vec3> f = forcesOf(term, nodes, now);
  std::vector<Vec3> d(nodes.u.size());
  for (unsigned seed = 31; seed < 34; ++seed) {
    setRandom(d, 1.0, seed);
    const double slope = centralDifference(nodes.u, d, h, [&] { return term.energy(nodes, now); });
    EXPECT_NEAR(productOf(f, d), -slope, tolerance * (1.0 + std::sqrt(productOf(f, f) * productOf(d, d))));
  }
}

inline linalg::BlockMatrix matrixFor(const Term& term, const Nodes& nodes) {
  linalg::MatrixPattern pattern(nodes.u.size());
  term.addPattern(pattern);
  return linalg::BlockMatrix(std::move(pattern));
}

inline void expectProduct(const linalg::BlockMatrix& K, const std::vector<Vec3>& d, const std::vector<Vec3>& slope,
                          double tolerance) {
  std::vector<Vec3> Kd(d.size());
  K.multiply(d, Kd);
  const double scale = std::max(largest(Kd), 1e-300);
  for (std::size_t n = 0; n < d.size(); ++n) EXPECT_LT(norm(Kd[n] + slope[n]), tolerance * scale) << "node " << n;
}

/// K d = −∂f/∂u d and C d = −∂f/∂v d for random d, relative to the largest entry.
inline void expectTangents(Term& term, Nodes& nodes, const Instant& now, double tolerance, double h = 1e-5) {
  linalg::BlockMatrix K = matrixFor(term, nodes), C = matrixFor(term, nodes);
  K.setZero();
  C.setZero();
  term.addTangent(nodes, now, K);
  term.addDamping(nodes, now, C);
  const auto force = [&] { return forcesOf(term, nodes, now); };
  std::vector<Vec3> d(nodes.u.size());
  for (unsigned seed = 41; seed < 44; ++seed) {
    setRandom(d, 1.0, seed);
    expectProduct(K, d, centralDifference(nodes.u, d, h, force), tolerance);
    expectProduct(C, d, centralDifference(nodes.v, d, h, force), tolerance);
  }
}

/// Force and moment about the origin of nodal forces at the deformed positions.
inline std::pair<Vec3, Vec3> resultant(const Nodes& nodes, std::span<const Vec3> f) {
  Vec3 force, moment;
  for (std::size_t n = 0; n < f.size(); ++n) {
    force += f[n];
    moment += cross(nodes.X[n] + nodes.u[n], f[n]);
  }
  return {force, moment};
}

}  // namespace dovetail::fem
