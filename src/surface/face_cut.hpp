// How faces become triangles.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "dovetail/surface/skin.hpp"

namespace dovetail::surface {

/// Triangles of a face by its local nodes; number nodesOf(shape) is a vertex of its own in the middle of the face.
std::span<const std::array<int, 3>> trianglesOf(fem::FaceShape shape, QuadSplit split);

/// The corners of faces of four nodes.
/// @throws InputError naming the first other face, and `who` does not take it
std::vector<std::array<int, 4>> quadsOf(std::span<const fem::Face> faces, const char* who);

}  // namespace dovetail::surface
