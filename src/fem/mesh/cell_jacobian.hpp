// ∂X/∂ξ of one element.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "dovetail/fem/mesh/solid_mesh.hpp"

namespace dovetail::fem::detail {

/// Columns ∂X/∂ξ_j.
using Jacobian = std::array<Vec3, 3>;

inline double determinant(const Jacobian& J) { return dot(J[0], cross(J[1], J[2])); }

/// ∂X/∂ζ of plane cells, which others have from their nodes: the thickness along z.
inline Vec3 depthOf(ElementShape shape, double thickness) {
  return dimensionOf(shape) == 2 ? Vec3{0.0, 0.0, thickness} : Vec3{};
}

/// @param gradient  ∂ψ_a/∂ξ_j of the element's nodes
/// @param depth     depthOf its shape
inline Jacobian jacobianAt(std::span<const Vec3> X, std::span<const int> nodes, std::span<const Vec3> gradient,
                           const Vec3& depth) {
  Jacobian J{Vec3{}, Vec3{}, depth};
  for (std::size_t a = 0; a < nodes.size(); ++a)
    for (int j = 0; j < 3; ++j)
      J[static_cast<std::size_t>(j)] += gradient[a][j] * X[static_cast<std::size_t>(nodes[a])];
  return J;
}

/// Gradients of the shape functions at the shape's own nodes, [nodes b + a].
const std::vector<Vec3>& nodalGradients(ElementShape shape);

/// "element 3", or "elements 3, 7, 9" with at most ten of them and how many there are.
std::string listed(const char* item, std::span<const int> numbers);

}  // namespace dovetail::fem::detail
