// Shape functions of the cells of solid_mesh.hpp at a point.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "dovetail/core/vec3.hpp"
#include "dovetail/fem/mesh/solid_mesh.hpp"

namespace dovetail::fem {

/// Parent coordinates of the nodes: bricks fill [−1, 1]³, tetrahedra ξ, η, ζ ≥ 0 with ξ + η + ζ ≤ 1, plane cells
/// [−1, 1]² at ζ = 0; nothing of theirs depends on ζ.
std::span<const Vec3> parentNodes(ElementShape shape);
/// A place in the parent cell near ξ, which continues without a jump what is known there: ξ itself within.
Vec3 nearestInParent(ElementShape shape, const Vec3& xi);
/// ψ_a(ξ), whose sum is one, and ∂ψ_a/∂ξ_j, nodesOf(shape) entries each.
void shapeFunctions(ElementShape shape, const Vec3& xi, std::span<double> value, std::span<Vec3> gradient);
/// ψ_a(ξ) alone.
std::vector<double> shapeRow(ElementShape shape, const Vec3& xi);
/// The same of a face: quadrilaterals fill [−1, 1]², triangles ξ, η ≥ 0 with ξ + η ≤ 1.
std::vector<double> shapeRow(FaceShape shape, double xi, double eta);

/// ψ_a(ξ) of hex8.
std::array<double, 8> shapeValues(const Vec3& xi);
/// ∂ψ_a/∂ξ_j of hex8.
std::array<Vec3, 8> parentGradients(const Vec3& xi);

}  // namespace dovetail::fem
