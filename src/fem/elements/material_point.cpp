#include "dovetail/fem/elements/material_point.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "../mesh/cell_jacobian.hpp"
#include "../mesh/shapes.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::fem {

namespace {

/// How far ξ lies outside the parent cell; ≤ 0 inside.
double outside(CellShape shape, const Vec3& xi) {
  if (shape == CellShape::tet4 || shape == CellShape::tet10)
    return std::max({-xi.x, -xi.y, -xi.z, xi.x + xi.y + xi.z - 1.0});
  return std::max({std::abs(xi.x), std::abs(xi.y), std::abs(xi.z)}) - 1.0;
}

/// Whether X is near enough to the element to look for it there; edges may be curved.
bool mayHold(const SolidMesh& mesh, std::span<const int> nodes, const Vec3& X) {
  for (int c = 0; c < 3; ++c) {
    double lower = INFINITY, upper = -INFINITY;
    for (const int n : nodes) {
      lower = std::min(lower, mesh.X[static_cast<std::size_t>(n)][c]);
      upper = std::max(upper, mesh.X[static_cast<std::size_t>(n)][c]);
    }
    const double margin = 0.25 * (upper - lower);
    if (X[c] < lower - margin || X[c] > upper + margin) return false;
  }
  return true;
}

/// Solves X(ξ) = X by Newton's method; leaves the shape functions in N. @return how far outside the cell ξ is
double locate(const SolidMesh& mesh, CellShape shape, std::span<const int> nodes, const Vec3& X, std::span<double> N) {
  std::vector<Vec3> gradient(nodes.size());
  Vec3 xi = detail::centreRule(shape).point[0];
  for (int iteration = 0; iteration < 30; ++iteration) {
    detail::shapeFunctions(shape, xi, N, gradient);
    Vec3 gap = X;
    for (std::size_t a = 0; a < nodes.size(); ++a) gap -= N[a] * mesh.X[static_cast<std::size_t>(nodes[a])];
    const detail::Jacobian J = detail::jacobianAt(mesh.X, nodes, gradient);
    const double det = detail::determinant(J);
    const Vec3 step = {dot(gap, cross(J[1], J[2])) / det, dot(J[0], cross(gap, J[2])) / det,
                       dot(J[0], cross(J[1], gap)) / det};
    xi += step;
    if (!isFinite(xi)) return INFINITY;
    if (norm(step) < 1e-14) break;
  }
  detail::shapeFunctions(shape, xi, N, gradient);
  return outside(shape, xi);
}

/// P Fᵀ / det F.
Eigen::Matrix3d cauchy(const double* F, const double* P) {
  using Tensor = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;
  return Tensor(P) * Tensor(F).transpose() / Tensor(F).determinant();
}

}  // namespace

MaterialPoint::MaterialPoint(const SolidMesh& mesh, const Vec3& X) : X_(X) {
  constexpr double inside = 1e-9;  // round-off of ξ on the boundary
  int number = 0;
  for (const CellGroup& group : mesh.groups) {
    const auto n = static_cast<std::size_t>(nodesOf(group.shape));
    std::vector<double> N(n);
    for (std::size_t e = 0; e < group.size(); ++e, ++number) {
      const std::span<const int> nodes = std::span(group.node).subspan(n * e, n);
      if (!mayHold(mesh, nodes, X) || !(locate(mesh, group.shape, nodes, X, N) <= inside)) continue;
      element_ = number;
      node_.assign(nodes.begin(), nodes.end());
      N_ = N;
      return;
    }
  }
  throw InputError("no element is at " + formatNumber(X.x) + ", " + formatNumber(X.y) + ", " + formatNumber(X.z) + " m",
                   "MaterialPoint", "give a reference position in the mesh");
}

Vec3 MaterialPoint::valueOf(std::span<const Vec3> field) const {
  Vec3 sum;
  for (std::size_t a = 0; a < node_.size(); ++a) sum += N_[a] * field[static_cast<std::size_t>(node_[a])];
  return sum;
}

std::array<double, 9> MaterialPoint::stress(const Solid::Sample& sample) const {
  std::vector<std::size_t> points;
  for (std::size_t q = 0; q < sample.element.size(); ++q)
    if (sample.element[q] == element_) points.push_back(q);
  if (points.empty())
    throw InputError("the sample does not hold element " + std::to_string(element_), "MaterialPoint::stress",
                     "take that of the solid that the element belongs to");
  const auto count = static_cast<Eigen::Index>(points.size()), columns = Eigen::Index{count < 4 ? 1 : 4};
  const double size = std::cbrt(sample.volume[points[0]]);
  Eigen::MatrixXd places = Eigen::MatrixXd::Ones(count, columns), stresses(count, 9);
  for (Eigen::Index k = 0; k < count; ++k) {
    const std::size_t q = points[static_cast<std::size_t>(k)];
    for (int c = 0; c + 1 < columns; ++c) places(k, c + 1) = (sample.X[q][c] - X_[c]) / size;
    const Eigen::Matrix3d sigma = cauchy(&sample.F[9 * q], &sample.P[9 * q]);
    for (int i = 0; i < 9; ++i) stresses(k, i) = sigma(i / 3, i % 3);
  }
  const Eigen::MatrixXd fit = places.colPivHouseholderQr().solve(stresses);
  std::array<double, 9> result;
  for (int i = 0; i < 9; ++i) result[static_cast<std::size_t>(i)] = fit(0, i);
  return result;
}

}  // namespace dovetail::fem
