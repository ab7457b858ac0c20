// The meshes that a volume coupling takes today.
#pragma once

#include <array>
#include <vector>

#include "dovetail/core/vec3.hpp"
#include "dovetail/fem/mesh/solid_mesh.hpp"

namespace dovetail::arlequin {

/// The hex8 of a mesh, in the reference configuration.
struct Bricks {
  std::vector<Vec3> X;                       ///< of the nodes, m
  std::vector<std::array<int, 8>> elements;  ///< node numbers, in the order of fem::CellShape::hex8
};

/// @throws InputError if the mesh has elements of another shape, naming it
Bricks bricksOf(const fem::SolidMesh& mesh);

}  // namespace dovetail::arlequin
