// Integrals over the faces of a mesh.
#pragma once

#include <span>
#include <vector>

#include "dovetail/fem/mesh/cell_topology.hpp"
#include "dovetail/fem/mesh/solid_mesh.hpp"
#include "shapes.hpp"

namespace dovetail::fem {

/// The nodes of a face, without the −1 at the end.
inline std::span<const int> nodesOf(const Face& face) {
  return {face.node.data(), static_cast<std::size_t>(nodesOf(face.shape))};
}

/// Shape functions, their derivatives by ξ and η, and the weight of one point of a quadrature.
struct FacePoint {
  std::span<const double> N, byXi, byEta;
  double weight;
};
/// ∂x/∂η of lines, which other faces have from their nodes: the thickness along z. ∂x/∂ξ × ∂x/∂η points outwards then.
inline Vec3 depthOf(FaceShape shape, double thickness) {
  return dimensionOf(shape) == 2 ? Vec3{0.0, 0.0, thickness} : Vec3{};
}
/// Calls visit(FacePoint) for the points of the rule of the shape. The rules are exact for N ∂x/∂ξ × ∂x/∂η and
/// x · ∂x/∂ξ × ∂x/∂η.
template <class Visit>
void visitPoints(FaceShape shape, Visit&& visit) {
  const detail::FaceRule& rule = detail::faceRule(shape);
  const auto n = static_cast<std::size_t>(rule.nodes);
  for (std::size_t q = 0; q < rule.weight.size(); ++q)
    visit(FacePoint{std::span(rule.value).subspan(n * q, n), std::span(rule.byXi).subspan(n * q, n),
                    std::span(rule.byEta).subspan(n * q, n), rule.weight[q]});
}

/// Σ coefficient_a field[node_a].
inline Vec3 interpolate(std::span<const double> coefficient, std::span<const int> nodes, std::span<const Vec3> field) {
  Vec3 sum;
  for (std::size_t a = 0; a < nodes.size(); ++a) sum += coefficient[a] * field[static_cast<std::size_t>(nodes[a])];
  return sum;
}

/// ∂X/∂ξ × ∂X/∂η at a point of a reference face, m².
inline Vec3 areaAt(const SolidMesh& mesh, const Face& face, const FacePoint& point) {
  const std::span<const int> nodes = nodesOf(face);
  return cross(interpolate(point.byXi, nodes, mesh.X),
               depthOf(face.shape, mesh.thickness) + interpolate(point.byEta, nodes, mesh.X));
}

/// @throws InputError, with `where`, for no faces, a node that the mesh does not have, lines on a mesh of three
/// dimensions or other faces on one of plane strain
void requireFaces(std::span<const Face> faces, const SolidMesh& mesh, const char* where);
/// Ascending nodes of the edges (of lines: ends) that belong to one face only; none if the faces close a surface.
std::vector<int> rimNodes(std::span<const Face> faces);

}  // namespace dovetail::fem
