#include "dovetail/arlequin/locate.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/mesh/shape.hpp"

namespace dovetail::arlequin {

namespace {

/// How far outside of −1 … 1 a parent coordinate may lie by round-off.
constexpr double edgeTolerance = 1e-9;

double farthest(const Vec3& xi) { return std::max({std::abs(xi.x), std::abs(xi.y), std::abs(xi.z)}); }

}  // namespace

std::optional<Vec3> parentCoordinates(const std::array<Vec3, 8>& corners, const Vec3& point) {
  Vec3 xi;
  for (int iteration = 0; iteration < 30; ++iteration) {
    const std::array<double, 8> psi = fem::shapeValues(xi);
    const std::array<Vec3, 8> gradient = fem::parentGradients(xi);
    Eigen::Vector3d residual(point.x, point.y, point.z);
    Eigen::Matrix3d J = Eigen::Matrix3d::Zero();
    for (std::size_t a = 0; a < 8; ++a)
      for (int i = 0; i < 3; ++i) {
        residual[i] -= psi[a] * corners[a][i];
        for (int j = 0; j < 3; ++j) J(i, j) += corners[a][i] * gradient[a][j];
      }
    const Eigen::Vector3d step = J.partialPivLu().solve(residual);
    if (!step.allFinite()) return std::nullopt;
    for (int i = 0; i < 3; ++i) xi[i] += step[i];
    if (step.lpNorm<Eigen::Infinity>() < 1e-14 * std::max(1.0, farthest(xi)) * 8.0) return xi;
    if (farthest(xi) > 10.0) return std::nullopt;
  }
  return std::nullopt;
}

ElementLocator::ElementLocator(std::span<const std::array<int, 8>> elements, std::span<const Vec3> position) {
  if (elements.empty())
    throw InputError("there are no elements", "ElementLocator", "give the elements of the solid's mesh");
  std::vector<Vec3> centre;
  std::vector<double> radius;
  for (std::size_t e = 0; e < elements.size(); ++e) {
    std::array<Vec3, 8> corners;
    Vec3 middle;
    for (std::size_t a = 0; a < 8; ++a) {
      const int node = elements[e][a];
      if (node < 0 || static_cast<std::size_t>(node) >= position.size())
        throw InputError("node " + std::to_string(node) + " does not exist", "element " + std::to_string(e),
                         "use node numbers of the mesh");
      corners[a] = position[static_cast<std::size_t>(node)];
      middle += 0.125 * corners[a];
    }
    double reach = 0.0;
    for (const Vec3& corner : corners) reach = std::max(reach, norm(corner - middle));
    corners_.push_back(corners);
    centre.push_back(middle);
    radius.push_back(reach * (1.0 + 1e-9));
  }
  grid_.build(centre, radius);
}

std::optional<Place> ElementLocator::find(const Vec3& point) const {
  for (const int e : grid_.query({point, point})) {
    const auto xi = parentCoordinates(corners_[static_cast<std::size_t>(e)], point);
    if (xi && farthest(*xi) <= 1.0 + edgeTolerance) return Place{e, *xi, fem::shapeValues(*xi)};
  }
  return std::nullopt;
}

}  // namespace dovetail::arlequin
