// Meshes of 8-node bricks with named sets of nodes and boundary faces.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "dovetail/core/vec3.hpp"

namespace dovetail::fem {

/// Bricks in the reference configuration.
struct Mesh {
  std::vector<Vec3> X;                       ///< reference positions of the nodes, m
  std::vector<std::array<int, 8>> elements;  ///< node numbers: (−,−,−) (+,−,−) (+,+,−) (−,+,−), then the same at +ζ
  std::map<std::string, std::vector<int>> nodeSets;                 ///< ascending node numbers
  std::map<std::string, std::vector<std::array<int, 4>>> faceSets;  ///< counter-clockwise seen from outside
};

/// A box cut into equal bricks, with node sets and face sets "x-", "x+", "y-", "y+", "z-", "z+" and "skin" (all six).
/// Nodes are numbered along x first, then y, then z, and so are elements. Move X afterwards to distort the mesh.
/// @param elements  bricks along x, y and z
/// @param lower, upper  opposite corners, m
/// @throws InputError for a count < 1 or a box without volume
Mesh boxMesh(std::array<int, 3> elements, Vec3 lower, Vec3 upper);

/// @throws InputError if there are no nodes or elements, a position is not finite, an element, node set or face set
///         names a node that does not exist, or det ∂X/∂ξ ≤ 0 at a corner or Gauss point of
///         an element (its number is named)
void validate(const Mesh& mesh);

/// The node set of that name.
/// @throws InputError that lists the names there are
const std::vector<int>& nodeSet(const Mesh& mesh, const std::string& name);
/// The face set of that name.
/// @throws InputError that lists the names there are
const std::vector<std::array<int, 4>>& faceSet(const Mesh& mesh, const std::string& name);

}  // namespace dovetail::fem
