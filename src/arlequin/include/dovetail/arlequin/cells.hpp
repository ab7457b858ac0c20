// The cells of a solid's mesh as an overlap sees them: their corners, the vertex shape functions on these, and points
// to integrate with.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "dovetail/core/vec3.hpp"
#include "dovetail/fem/mesh/solid_mesh.hpp"

namespace dovetail::arlequin {

struct Cell {
  fem::ElementShape shape;
  std::span<const int> node;            ///< all its nodes
  std::span<const int> corner() const;  ///< the first of them
};

/// @param element  number in the mesh
Cell cellOf(const fem::SolidMesh& mesh, int element);

/// @throws InputError for plane cells: particles are spheres, which do not fit into a slice of plane strain
void requireSpatialCells(const fem::SolidMesh& mesh);

/// ψ of the corners alone, as of the cell of first order with the same corners: not negative anywhere, whatever the
/// order of the cell; their sum is one. Beyond the cell they keep their values at its border.
/// @param xi  parent coordinates
std::vector<double> vertexShapes(fem::ElementShape shape, const Vec3& xi);

/// A point of a quadrature: vertex shape functions of the corners, place and weight (m³).
struct CellPoint {
  std::array<double, 8> vertexShape;
  Vec3 x;
  double weight;
};

/// Points of a cell cut into parts³ (tetrahedra: into 8ⁿ, n the power of two that comes next).
/// @param position  of the nodes, m
std::vector<CellPoint> cellPoints(const fem::SolidMesh& mesh, std::span<const Vec3> position, int element, int parts);

/// ∫dV of the reference configuration, m³.
double cellVolume(const fem::SolidMesh& mesh, int element);
/// Length of an edge of the cube, or of the regular tetrahedron, of the same volume, m.
double elementSize(const fem::SolidMesh& mesh, int element);

/// X + u, m.
std::vector<Vec3> positionsOf(std::span<const Vec3> X, std::span<const Vec3> u);

}  // namespace dovetail::arlequin
