// What both writers check first.
#pragma once

#include <string>
#include <vector>

#include "dovetail/fem/mesh/solid_mesh.hpp"
#include "face_finder.hpp"

namespace dovetail::solid_io {

/// "dovetail 0.1.0", the mark of our files.
std::string mark();
/// @throws InputError as fem::validate, or for a name that is empty or holds a quote or line break
void requireWritable(const fem::SolidMesh& mesh);
/// The element and side of a face.
/// @throws InputError naming the set if no element has it
Side requireSide(const FaceFinder& finder, const fem::Face& face, const std::string& set);

}  // namespace dovetail::solid_io
