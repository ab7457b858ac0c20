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

bool isBrick(CellShape shape) { return shape != CellShape::tet4 && shape != CellShape::tet10; }

/// How far ξ lies outside the parent cell; ≤ 0 inside.
double outside(CellShape shape, const Vec3& xi) {
  if (!isBrick(shape)) return std::max({-xi.x, -xi.y, -xi.z, xi.x + xi.y + xi.z - 1.0});
  return std::max({std::abs(xi.x), std::abs(xi.y), std::abs(xi.z)}) - 1.0;
}

/// Whether X is near enough to the element to look for it there; edges may be curved.
bool mayHold(std::span<const Vec3> nodes, const Vec3& X) {
  for (int c = 0; c < 3; ++c) {
    const auto [lower, upper] = std::ranges::minmax(nodes, {}, [c](const Vec3& node) { return node[c]; });
    const double margin = 0.25 * (upper[c] - lower[c]);
    if (X[c] < lower[c] - margin || X[c] > upper[c] + margin) return false;
  }
  return true;
}

/// Solves X(ξ) = X in an element by Newton's method; not finite if it has no answer.
Vec3 parentPlace(CellShape shape, std::span<const Vec3> nodes, const Vec3& X) {
  std::array<double, detail::maxCellNodes> N;
  std::array<Vec3, detail::maxCellNodes> gradient;
  Vec3 xi = detail::centreRule(shape).point[0];
  for (int iteration = 0; iteration < 30 && isFinite(xi); ++iteration) {
    shapeFunctions(shape, xi, std::span(N).first(nodes.size()), std::span(gradient).first(nodes.size()));
    Vec3 gap = X;
    detail::Jacobian J{};
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      gap -= N[a] * nodes[a];
      for (int j = 0; j < 3; ++j) J[static_cast<std::size_t>(j)] += gradient[a][j] * nodes[a];
    }
    const double det = detail::determinant(J);
    const Vec3 step = {dot(gap, cross(J[1], J[2])) / det, dot(J[0], cross(gap, J[2])) / det,
                       dot(J[0], cross(J[1], gap)) / det};
    xi += step;
    if (norm(step) < 1e-14) break;
  }
  return xi;
}

/// 1, ξ, η, ζ and, for bricks, their products; 1 alone where there are too few points for them.
std::vector<double> basisAt(CellShape shape, const Vec3& xi, std::size_t points) {
  if (isBrick(shape) && points >= 8)
    return {1.0, xi.x, xi.y, xi.z, xi.x * xi.y, xi.y * xi.z, xi.z * xi.x, xi.x * xi.y * xi.z};
  if (!isBrick(shape) && points >= 4) return {1.0, xi.x, xi.y, xi.z};
  return {1.0};
}

/// P Fᵀ / det F.
Eigen::Matrix3d cauchy(const double* F, const double* P) {
  using Tensor = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;
  return Tensor(P) * Tensor(F).transpose() / Tensor(F).determinant();
}

}  // namespace

MaterialPoint::MaterialPoint(const SolidMesh& mesh, const Vec3& X) {
  constexpr double inside = 1e-9;  // round-off of ξ on the boundary
  int number = 0;
  for (const CellGroup& group : mesh.groups) {
    const auto n = static_cast<std::size_t>(nodesOf(group.shape));
    for (std::size_t e = 0; e < group.size(); ++e, ++number) {
      const std::span<const int> nodes = std::span(group.node).subspan(n * e, n);
      X_.clear();
      for (const int node : nodes) X_.push_back(mesh.X[static_cast<std::size_t>(node)]);
      if (!mayHold(X_, X)) continue;
      xi_ = parentPlace(group.shape, X_, X);
      if (!isFinite(xi_) || outside(group.shape, xi_) > inside) continue;
      element_ = number;
      shape_ = group.shape;
      node_.assign(nodes.begin(), nodes.end());
      N_.resize(n);
      std::vector<Vec3> gradient(n);
      shapeFunctions(shape_, xi_, N_, gradient);
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
  const std::vector<double> here = basisAt(shape_, xi_, points.size());
  const auto count = static_cast<Eigen::Index>(points.size()), columns = static_cast<Eigen::Index>(here.size());
  Eigen::MatrixXd places(count, columns), stresses(count, 9);
  for (Eigen::Index k = 0; k < count; ++k) {
    const std::size_t q = points[static_cast<std::size_t>(k)];
    const std::vector<double> basis = basisAt(shape_, parentPlace(shape_, X_, sample.X[q]), points.size());
    places.row(k) = Eigen::Map<const Eigen::RowVectorXd>(basis.data(), columns);
    const Eigen::Matrix3d sigma = cauchy(&sample.F[9 * q], &sample.P[9 * q]);
    for (int i = 0; i < 9; ++i) stresses(k, i) = sigma(i / 3, i % 3);
  }
  const Eigen::RowVectorXd fit =
      Eigen::Map<const Eigen::RowVectorXd>(here.data(), columns) * places.colPivHouseholderQr().solve(stresses);
  std::array<double, 9> result;
  for (int i = 0; i < 9; ++i) result[static_cast<std::size_t>(i)] = fit[i];
  return result;
}

}  // namespace dovetail::fem
