// The meshes that a volume coupling takes today.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "dovetail/core/vec3.hpp"
#include "dovetail/fem/mesh/cell_locator.hpp"
#include "dovetail/fem/mesh/solid_mesh.hpp"

namespace dovetail::arlequin {

/// The hex8 of a mesh, in the reference configuration.
struct Bricks {
  std::vector<Vec3> X;                       ///< of the nodes, m
  std::vector<std::array<int, 8>> elements;  ///< node numbers, in the order of fem::CellShape::hex8
};

/// @throws InputError if the mesh has elements of another shape, naming it
Bricks bricksOf(const fem::SolidMesh& mesh);

/// @param position  of the nodes, m: reference, or X + u
/// @throws as fem::CellLocator does
fem::CellLocator locatorOf(std::span<const std::array<int, 8>> elements, std::span<const Vec3> position);

}  // namespace dovetail::arlequin
