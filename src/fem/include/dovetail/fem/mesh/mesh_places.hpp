// Sets of nodes and faces by their place.
#pragma once

#include <functional>
#include <vector>

#include "dovetail/fem/mesh/solid_mesh.hpp"

namespace dovetail::fem {

/// Whether a reference position, m, is meant.
using Place = std::function<bool(const Vec3& X)>;

/// The box between two corners with its boundary. @param margin  added on all sides, m
Place inBox(Vec3 lower, Vec3 upper, double margin = 0.0);

/// Nodes in a place, ascending. @throws InputError if there are none
std::vector<int> nodesWhere(const SolidMesh& mesh, const Place& place);
/// Faces of the boundary whose nodes are all in a place. @throws InputError if there are none
std::vector<Face> facesWhere(const SolidMesh& mesh, const Place& place);

}  // namespace dovetail::fem
