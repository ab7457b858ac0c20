// Bodies of a scene that lie in each other.
#pragma once

#include <array>
#include <vector>

#include "dovetail/geometry/triangle_mesh.hpp"

namespace dovetail::scene {

/// Pairs of meshes {i < j} that overlap, by geometry::auditOverlaps; none in builds without FCL.
std::vector<std::array<int, 2>> overlapping(const std::vector<geometry::TriangleMesh>& meshes);

}  // namespace dovetail::scene
