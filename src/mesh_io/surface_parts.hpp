// What the readers of surfaces share.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dovetail/geometry/triangle_mesh.hpp"
#include "dovetail/io/text_source.hpp"

namespace dovetail::mesh_io {

using io::lower, io::shown, io::TextSource;

/// @throws InputError if it is no file, cannot be read, or is empty
std::string readWhole(const std::filesystem::path& path);

/// @throws InputError
[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& place, const std::string& problem,
                         const std::string& remedy);

/// What the last step of every reader makes sure of.
/// @throws InputError if there are no facets, more vertices than int can count, or one farther than 1e15 m from the
///         origin
void requireFacets(const geometry::TriangleMesh& mesh, const std::filesystem::path& path);

/// Appends a fan around the first corner.
void addFan(const std::vector<int>& corners, geometry::TriangleMesh& mesh);

}  // namespace dovetail::mesh_io
