// Shape functions and quadrature of the cells and faces of solid_mesh.hpp.
#pragma once

#include <array>
#include <span>
#include <tuple>
#include <vector>

#include "dovetail/fem/mesh/shape.hpp"

namespace dovetail::fem::detail {

constexpr bool isTet(ElementShape shape) { return shape == ElementShape::tet4 || shape == ElementShape::tet10; }

/// make(shape) for all shapes, in the order of ElementShape.
template <class Make>
auto perShape(Make make) {
  return std::apply([&](auto... shape) { return std::array{make(shape)...}; }, allCellShapes);
}

/// Largest numbers of nodes and quadrature points of a cell (of the rule that forces use).
inline constexpr int maxCellNodes = 27;
inline constexpr int maxCellPoints = 27;

/// Points and weights of a quadrature with the shape functions there.
struct CellRule {
  int nodes, points;
  std::vector<Vec3> point;
  std::vector<double> weight;  ///< sum: volume of the parent cell, area of a plane one
  std::vector<double> value;   ///< [nodes q + a]
  std::vector<Vec3> gradient;  ///< [nodes q + a]
};
/// For forces: hex8 2×2×2, hex20 and hex27 3×3×3, tet4 1, tet10 4, quad4 2×2, quad8 3×3 points.
const CellRule& forceRule(ElementShape shape);
/// Exact for products of two shape functions on affine cells.
const CellRule& massRule(ElementShape shape);
/// For forces of quad8 with reduced integration: 2×2 points.
const CellRule& reducedRule(ElementShape shape);
/// One point, at the centre.
const CellRule& centreRule(ElementShape shape);

/// The faces of a cell: local numbers of their nodes, counter-clockwise seen from outside.
struct CellFaces {
  FaceShape shape;
  std::vector<std::array<int, 9>> node;  ///< −1 beyond nodesOf(shape)
};
const CellFaces& facesOf(ElementShape shape);

/// ψ_a(ξ, η) and its derivatives by ξ and η: quadrilaterals fill [−1, 1]², triangles ξ, η ≥ 0 with ξ + η ≤ 1, lines
/// [−1, 1] for every η.
void faceFunctions(FaceShape shape, double xi, double eta, std::span<double> value, std::span<double> byXi,
                   std::span<double> byEta);
struct FaceRule {
  int nodes, points;
  std::vector<std::array<double, 2>> point;
  std::vector<double> weight;              ///< sum: area of the parent face
  std::vector<double> value, byXi, byEta;  ///< [nodes q + a]
};
/// quad4 2×2, quad8 and quad9 3×3, tri3 3, tri6 6, line2 2, line3 3 points.
const FaceRule& faceRule(FaceShape shape);

}  // namespace dovetail::fem::detail
