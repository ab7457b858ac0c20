// How thick a mesh is, and how many elements lie across.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "dovetail/fem/mesh/solid_mesh.hpp"

namespace dovetail::fem {

/// Across a mesh from a face of its boundary to the one that lies opposite.
struct MeshThickness {
  ElementShape shape{};        ///< of the element at the face
  Vec3 X, normal;              ///< where the line begins, m, and its direction, inwards
  Face face, opposite;         ///< of the boundary, at both ends
  double area = 0.0;           ///< of the face, m²
  double thickness = 0.0;      ///< length of the line, m
  double layers = 0.0;         ///< thickness over the mean extent, along the line, of the elements that it crosses
  double length = 0.0;         ///< of the longest line across the first one's middle, in the mesh, m
  double elementLength = 0.0;  ///< mean extent of the elements that it crosses, along it, m
  std::vector<std::size_t> elements;  ///< that the line crosses
};

/// Of up to `most` faces that are spread over the boundary; only where the opposite face is about parallel (30°): at
/// edges and in wedges there is no thickness. Elements are taken with straight edges. Empty for plane cells.
std::vector<MeshThickness> measureThickness(const SolidMesh& mesh, std::size_t most = 300);

}  // namespace dovetail::fem
