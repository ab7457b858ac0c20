// One trilinear brick, entity by entity: geometry for the set-up and the element matrices.
#pragma once

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "dovetail/core/vec3.hpp"
#include "dovetail/fem/mesh/shape.hpp"

namespace dovetail::fem::detail {

/// Distance of the 2×2×2 Gauss points from the centre in parent coordinates, 1/√3; all weights are 1.
inline constexpr double gaussDistance = 0.57735026918962576451;

using BrickCorners = std::array<Vec3, 8>;
/// Row-major 3 × 3: entry (i, j) is m[3 i + j].
using Matrix3 = std::array<double, 9>;

/// Parent coordinate (±1) of a local node.
inline constexpr std::array<std::array<int, 3>, 8> parentSign = {
    {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}}};

BrickCorners cornersOf(const std::array<int, 8>& element, std::span<const Vec3> X);
/// Parent coordinates of Gauss point p: bit 0, 1, 2 of p set means +ξ, +η, +ζ.
Vec3 gaussPoint(int p);
/// ∂X_i/∂ξ_j.
Matrix3 jacobian(const BrickCorners& corners, const Vec3& xi);
double determinant(const Matrix3& m);
Matrix3 inverse(const Matrix3& m);
Matrix3 product(const Matrix3& a, const Matrix3& b);

/// A field at the eight local nodes of a brick.
using CornerValues = std::array<double, 8>;
/// Values of the element's corners of a nodal field; ones if the field is empty.
CornerValues cornerValues(const std::array<int, 8>& element, std::span<const double> field);
/// The trilinear interpolation of corner values at ξ; exact where they are all the same.
double interpolated(const CornerValues& values, const Vec3& xi);

/// ∫w ψ_a dV, m³, w interpolated from `fraction`.
std::array<double, 8> nodalVolumes(const BrickCorners& corners, const CornerValues& fraction);
/// ∫w ψ_a ψ_b dV, row-major, m³; 3×3×3 Gauss points, exact for parallelepipeds.
std::array<double, 64> shapeProducts(const BrickCorners& corners, const CornerValues& fraction);

/// Values of the 18 stress modes of Pian & Tong (1986) at ξ, as a row-major 6 × 18 matrix with rows
/// 11, 22, 33, 12, 23, 31 along the parent axes: 11: 1 η ζ ηζ; 22: 1 ξ ζ ξζ; 33: 1 ξ η ξη; 12: 1 ζ; 23: 1 ξ; 31: 1 η.
std::array<double, 108> stressModes(const Vec3& xi);

}  // namespace dovetail::fem::detail
