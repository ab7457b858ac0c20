// Triangulated surfaces from VTK's polygonal XML files.
#pragma once

#include <filesystem>

#include "dovetail/geometry/triangle_mesh.hpp"

namespace dovetail::mesh_io {

/// VTP: points, polygons (cut into fans around their first vertex) and triangle strips; vertices, lines and data arrays
/// are passed over. Coordinates as they are in the file.
/// @throws InputError, naming the file, if it cannot be read, is no VTP file, is not complete, holds a coordinate that
///   is not finite or an index out of range, or has no facets
geometry::TriangleMesh readVtp(const std::filesystem::path& path);

}  // namespace dovetail::mesh_io
