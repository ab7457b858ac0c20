// Trilinear shape functions of the 8-node brick, in the node order of Mesh::elements.
#pragma once

#include <array>

#include "dovetail/core/vec3.hpp"

namespace dovetail::fem {

/// ψ_a(ξ) of the eight nodes; their sum is one.
std::array<double, 8> shapeValues(const Vec3& xi);
/// ∂ψ_a/∂ξ_j of the eight nodes.
std::array<Vec3, 8> parentGradients(const Vec3& xi);

}  // namespace dovetail::fem
