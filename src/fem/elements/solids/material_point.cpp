#include "dovetail/fem/elements/material_point.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <utility>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "mesh/parent_coordinates.hpp"
#include "mesh/shapes.hpp"

namespace dovetail::fem {

namespace {

bool isBrick(ElementShape shape) { return !detail::isTet(shape); }

/// Parent coordinates of a point that lies in the element.
Vec3 parentPlace(ElementShape shape, std::span<const Vec3> nodes, const Vec3& X, int element) {
  const detail::ParentGuess guess = detail::guessParent(shape, nodes, X);
  if (guess.verdict == detail::Verdict::inside) return guess.xi;
  return detail::searchParent(shape, nodes, X, "element " + std::to_string(element)).value_or(guess.xi);
}

/// 1, ξ, η, ζ and, for bricks, their products; 1 alone where there are too few points for them.
std::vector<double> basisAt(ElementShape shape, const Vec3& xi, std::size_t points) {
  if (dimensionOf(shape) == 2 && points >= 4) return {1.0, xi.x, xi.y, xi.x * xi.y};
  if (dimensionOf(shape) == 3 && isBrick(shape) && points >= 8)
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

MaterialPoint::MaterialPoint(const SolidMesh& mesh, const Vec3& X) : MaterialPoint(mesh, ElementLocator(mesh), X) {}

MaterialPoint::MaterialPoint(const SolidMesh& mesh, const ElementLocator& locator, const Vec3& X) {
  std::optional<CellPlace> place = locator.find(X);
  if (!place)
    throw InputError(
        "no element is at " + formatNumber(X.x) + ", " + formatNumber(X.y) + ", " + formatNumber(X.z) + " m",
        "MaterialPoint", "give a reference position in the mesh");
  element_ = place->element;
  xi_ = place->xi;
  N_ = std::move(place->shape);
  auto e = static_cast<std::size_t>(element_);
  const auto group = std::ranges::find_if(mesh.groups, [&](const ElementGroup& g) {
    if (e < g.size()) return true;
    e -= g.size();
    return false;
  });
  shape_ = group->shape;
  const std::span<const int> nodes = std::span(group->node).subspan(N_.size() * e, N_.size());
  node_.assign(nodes.begin(), nodes.end());
  for (const int node : nodes) X_.push_back(mesh.X[static_cast<std::size_t>(node)]);
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
    const std::vector<double> basis = basisAt(shape_, parentPlace(shape_, X_, sample.X[q], element_), points.size());
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
