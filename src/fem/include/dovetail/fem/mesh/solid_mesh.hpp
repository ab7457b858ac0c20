// Meshes of bricks, tetrahedra and quadrilaterals of plane strain, of first and second order, with named sets of nodes,
// faces and elements.
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
/// quad4 and quad8 are cells of plane strain in a plane z = const, corners counter-clockwise seen from +z, edges
/// 01 12 23 30.
enum class ElementShape : std::uint8_t { hex8, hex20, hex27, tet4, tet10, quad4, quad8 };
inline constexpr std::array allCellShapes = {ElementShape::hex8, ElementShape::hex20, ElementShape::hex27,
                                             ElementShape::tet4, ElementShape::tet10, ElementShape::quad4,
                                             ElementShape::quad8};
/// Faces of them, counter-clockwise seen from outside: corners, mid-edge nodes 01 12 …, centre. Those of plane cells
/// are lines, ends first, that run around the cell counter-clockwise seen from +z: tangent × e_z points outwards.
enum class FaceShape : std::uint8_t { quad4, quad8, quad9, tri3, tri6, line2, line3 };

constexpr int nodesOf(ElementShape shape) {
  constexpr std::array<int, 7> counts = {8, 20, 27, 4, 10, 4, 8};
  return counts[static_cast<std::size_t>(shape)];
}
constexpr int nodesOf(FaceShape shape) {
  constexpr std::array<int, 7> counts = {4, 8, 9, 3, 6, 2, 3};
  return counts[static_cast<std::size_t>(shape)];
}
/// 3, or 2 for plane strain.
constexpr int dimensionOf(ElementShape shape) {
  return shape == ElementShape::quad4 || shape == ElementShape::quad8 ? 2 : 3;
}
/// Of the cells that have such faces.
constexpr int dimensionOf(FaceShape shape) { return shape == FaceShape::line2 || shape == FaceShape::line3 ? 2 : 3; }
/// "hex8" and so on.
const char* name(ElementShape shape);

/// One face of a boundary; entries of `node` beyond nodesOf(shape) are −1.
struct Face {
  FaceShape shape;
  std::array<int, 9> node;
};

/// Elements of one shape.
struct ElementGroup {
  ElementShape shape;
  std::vector<int> node;  ///< nodesOf(shape) numbers per element
  std::size_t size() const { return node.size() / static_cast<std::size_t>(nodesOf(shape)); }
};

/// Elements are numbered through all groups in their order. All are of three dimensions or all of plane strain: then
/// every node has the same z, and makeModel holds that component.
struct SolidMesh {
  std::vector<Vec3> X;  ///< reference positions of the nodes, m
  std::vector<ElementGroup> groups;
  std::map<std::string, std::vector<int>> nodeSets;  ///< ascending node numbers
  std::map<std::string, std::vector<Face>> faceSets;
  std::map<std::string, std::vector<int>> elementSets;  ///< ascending element numbers
  /// Of a mesh of plane strain along z, m: forces, masses and energies are those of this length. Otherwise 1.
  double thickness = 1.0;

  std::size_t elementCount() const;
};

/// 3, or 2 for plane strain; of a mesh without elements that of its faces.
int dimensionOf(const SolidMesh& mesh);

/// A box of equal cells, with node and face sets "x-" … "z+" and "skin". Tetrahedra: six per brick cell. Plane cells
/// lie at the lower z, with the height of the box as thickness, and have no sets "z-" and "z+".
/// @param cells  along x, y and z; plane cells take 1 along z
/// @throws InputError for a count < 1, more than one layer of plane cells, or a box without volume
SolidMesh boxOf(ElementShape shape, std::array<int, 3> cells, Vec3 lower, Vec3 upper);

/// Faces of all elements that belong to one element only.
std::vector<Face> boundaryFaces(const SolidMesh& mesh);

/// @throws InputError naming the first element or set at fault: no nodes or elements, positions that are not finite,
///         nodes that do not exist, an element that names a node twice, det ∂X/∂ξ ≤ 0 at a node or quadrature point;
///         for plane cells beside others, nodes of plane cells that differ in z by more than 1e-9 of the extent of the
///         mesh, a thickness that is not > 0, or not 1 in three dimensions
void validate(const SolidMesh& mesh);

/// The sets of that name.
/// @throws InputError that lists the names there are
const std::vector<int>& nodeSet(const SolidMesh& mesh, const std::string& name);
const std::vector<Face>& faceSet(const SolidMesh& mesh, const std::string& name);
const std::vector<int>& elementSet(const SolidMesh& mesh, const std::string& name);

}  // namespace dovetail::fem
