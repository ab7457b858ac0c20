// Meshes of bricks and tetrahedra of first and second order, with named sets of nodes, faces and elements.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "dovetail/core/vec3.hpp"

namespace dovetail::fem {

/// Shapes of elements; nodes are numbered as VTK does: corners, then mid-edge, mid-face and centre nodes.
/// hex20 edges: 01 12 23 30, 45 56 67 74, 04 15 26 37. hex27 adds the faces x−, x+, y−, y+, z−, z+ and the centre.
/// tet10 edges: 01 12 20 03 13 23.
enum class CellShape : std::uint8_t { hex8, hex20, hex27, tet4, tet10 };
/// Faces of them, counter-clockwise seen from outside: corners, mid-edge nodes 01 12 …, centre.
enum class FaceShape : std::uint8_t { quad4, quad8, quad9, tri3, tri6 };

constexpr int nodesOf(CellShape shape) {
  constexpr std::array<int, 5> counts = {8, 20, 27, 4, 10};
  return counts[static_cast<std::size_t>(shape)];
}
constexpr int nodesOf(FaceShape shape) {
  constexpr std::array<int, 5> counts = {4, 8, 9, 3, 6};
  return counts[static_cast<std::size_t>(shape)];
}
/// "hex8" and so on.
const char* name(CellShape shape);

/// One face of a boundary; entries of `node` beyond nodesOf(shape) are −1.
struct Face {
  FaceShape shape;
  std::array<int, 9> node;
};

/// Elements of one shape.
struct CellGroup {
  CellShape shape;
  std::vector<int> node;  ///< nodesOf(shape) numbers per element
  std::size_t size() const { return node.size() / static_cast<std::size_t>(nodesOf(shape)); }
};

/// Elements are numbered through all groups in their order.
struct SolidMesh {
  std::vector<Vec3> X;  ///< reference positions of the nodes, m
  std::vector<CellGroup> groups;
  std::map<std::string, std::vector<int>> nodeSets;  ///< ascending node numbers
  std::map<std::string, std::vector<Face>> faceSets;
  std::map<std::string, std::vector<int>> elementSets;  ///< ascending element numbers

  std::size_t elementCount() const;
};

/// A box of equal cells, with node and face sets "x-" … "z+" and "skin". Tetrahedra: six per brick cell.
/// @param cells  along x, y and z
/// @throws InputError for a count < 1 or a box without volume
SolidMesh boxOf(CellShape shape, std::array<int, 3> cells, Vec3 lower, Vec3 upper);

/// Faces of all elements that belong to one element only.
std::vector<Face> boundaryFaces(const SolidMesh& mesh);

/// @throws InputError naming the first element or set at fault: no nodes or elements, positions that are not finite,
///         nodes that do not exist, an element that names a node twice, det ∂X/∂ξ ≤ 0 at a node or quadrature point
void validate(const SolidMesh& mesh);

/// The sets of that name.
/// @throws InputError that lists the names there are
const std::vector<int>& nodeSet(const SolidMesh& mesh, const std::string& name);
const std::vector<Face>& faceSet(const SolidMesh& mesh, const std::string& name);
const std::vector<int>& elementSet(const SolidMesh& mesh, const std::string& name);

}  // namespace dovetail::fem
