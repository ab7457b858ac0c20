// Weights of the Arlequin framework: which fraction of mass and energy each model carries in the overlap.
//
// The particles' weight w is held at the nodes of the solid's mesh and interpolated, so it moves with the mesh; the
// solid carries 1 − w (partition of unity). w = 1 at the mesh's border inside the particles (s = 0), w = 0 at the
// particles' border inside the solid (s = 1).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "dovetail/core/vec3.hpp"
#include "dovetail/fem/mesh/solid_mesh.hpp"
#include "dovetail/geometry/box.hpp"

namespace dovetail::arlequin {

enum class WeightProfile {
  halfCosine,  ///< ½ (1 + cos πs): no slope at both ends (Cheng et al. 2023, sec. 5.2)
  linear,      ///< 1 − s
  smooth       ///< 1 − s³ (10 − 15 s + 6 s²): no slope and no curvature at both ends
};

/// 1 at s ≤ 0, 0 at s ≥ 1.
double profile(WeightProfile shape, double s);
/// d profile / ds; 0 outside 0 < s < 1.
double profileSlope(WeightProfile shape, double s);

struct WeightOptions {
  WeightProfile profile = WeightProfile::halfCosine;
  /// Within the overlap w stays between floor and 1 − floor, so that no model is without mass there. 0 ≤ floor < ½.
  double floor = 1e-3;
};
/// @throws InputError naming the field
void validate(const WeightOptions& options);

/// Value of s that marks a node beyond the particles' border, where the solid is alone: w = 0 without floor.
inline constexpr double beyondOverlap = 2.0;

/// w at the nodes: floor + (1 − 2 floor) profile(s) for s ≤ 1, 0 for s > 1.
/// @param s  per node; NaN is refused
std::vector<double> nodalWeights(std::span<const double> s, const WeightOptions& options);

/// Gives mid-edge, mid-face and centre nodes of second-order cells the mean of the corners about them, so that the
/// weights of both models add up to one everywhere: w goes by the vertex shape functions of the corners.
void levelMidNodes(const fem::SolidMesh& mesh, std::span<double> weight);

using Triangle = std::array<Vec3, 3>;  ///< m

/// Two triangles per face.
std::vector<Triangle> triangles(std::span<const Vec3> X, std::span<const fem::Face> faces);

/// s = d_FE / (d_FE + d_DE) from the distances to the two borders of an overlap of any shape; 0 or 1 on a border.
/// @param solidBorder     border of the mesh that lies within the particles
/// @param particleBorder  border of the particles that lies within the mesh
/// @throws InputError for an empty border, or a point that lies on both
std::vector<double> distanceCoordinate(std::span<const Vec3> points, std::span<const Triangle> solidBorder,
                                       std::span<const Triangle> particleBorder);

/// s between two nested boxes: the largest over the sides of (distance from the inner side) / (distance of the two),
/// linear across each side; less than 0 within the inner box, more than 1 outside of the outer one. Sides that coincide
/// are open, for boxes that reach beyond a face of the mesh.
/// @throws InputError for an inner box that is not inside, boxes open on all sides, or a point beyond an open side
std::vector<double> boxCoordinate(std::span<const Vec3> points, const geometry::Box& solidBorder,
                                  const geometry::Box& particleBorder);

/// s from Laplace's equation on the elements of the overlap: s = 0 on `solidBorder`, 1 on `particleBorder`, no flux
/// elsewhere. Nodes without an element of the overlap get `beyondOverlap`. Solved on the corners of the cells; nodes
/// between get the mean of these.
/// @param elements  numbers of the overlap's elements
/// @throws InputError for an empty set, or a node in both sets; NumericalError if the system cannot be solved
std::vector<double> laplaceCoordinate(const fem::SolidMesh& mesh, std::span<const int> elements,
                                      std::span<const int> solidBorder, std::span<const int> particleBorder);

}  // namespace dovetail::arlequin
