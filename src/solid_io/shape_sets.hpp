// Sets of the elements of one shape, for fem::makeSolid.
#pragma once

#include "dovetail/fem/mesh/solid_mesh.hpp"

namespace dovetail::solid_io {

/// Of meshes and element sets of several shapes each shape gets a set of its own, "tet4" or "steel tet4"; a set of that
/// name that the file has stays as it is.
void addSetsByShape(fem::SolidMesh& mesh);

}  // namespace dovetail::solid_io
