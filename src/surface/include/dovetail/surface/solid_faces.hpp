// Faces of a solid's mesh for a skin.
#pragma once

#include <span>
#include <vector>

#include "dovetail/fem/mesh/solid_mesh.hpp"
#include "dovetail/surface/skin.hpp"

namespace dovetail::surface {

/// The corners of faces of hex8, for makeSkin.
/// @throws InputError naming the first face of another shape
std::vector<Quad> quadsOf(std::span<const fem::Face> faces);

}  // namespace dovetail::surface
