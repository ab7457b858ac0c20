// Triangulated surfaces from files: STL, OBJ and PLY.
//
// All readers take files as they come and change no coordinate: lengths are those of the file, and what they mean in
// metres is the caller's business. Polygons are cut into fans around their first vertex, which is right for convex
// ones. Facets without area are kept; geometry/surface_checks.hpp finds them, geometry/triangle_mesh.hpp drops them.
//
// Every reader throws InputError, naming the file and the line or byte, if the file cannot be read, is of another kind,
// breaks off, goes on after its end, holds a coordinate that is no finite number or an index out of range, or has no
// facets. Nothing that a file holds can make a reader do worse.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "dovetail/geometry/triangle_mesh.hpp"

namespace dovetail::mesh_io {

using geometry::TriangleMesh;

/// STL, binary (32-bit, little-endian) or ASCII, told apart by the length. Every facet of an STL file has vertices of
/// its own; they are welded (geometry::weldVertices). The order of the vertices counts: normals in the file that point
/// to the other side are only noted.
/// @param tolerance of the welding, in the file's unit; 0 joins equal coordinates only, which suffices for files
///   whose writer rounded every vertex the same way everywhere
/// @param notes  gets sentences on ignored parts of the file, if not null
TriangleMesh readStl(const std::filesystem::path& path, double tolerance = 0.0,
                     std::vector<std::string>* notes = nullptr);

/// OBJ: lines v and f, with the index forms i, i/t, i//n, i/t/n and negative (relative) ones. Textures, normals, names,
/// groups and materials are passed over, free-form curves and surfaces refused.
TriangleMesh readObj(const std::filesystem::path& path);

/// PLY 1.0, ASCII or binary little-endian: x, y, z of the element vertex and vertex_indices (or vertex_index) of the
/// element face, in any of the format's number types. Other elements and properties are passed over.
TriangleMesh readPly(const std::filesystem::path& path);

/// By the ending of the name, in whatever case: .stl (tolerance 0), .obj or .ply.
/// @param notes  as of readStl
/// @throws InputError also on another ending
TriangleMesh readSurface(const std::filesystem::path& path, std::vector<std::string>* notes = nullptr);

/// Binary STL: coordinates as 32-bit numbers, unit normals (zero where there is no area). Written whole or not at all;
/// an earlier file of ours is replaced, other files are not (io/output_folder.hpp).
/// @throws InputError as makeTopology on bad facets, if there are none or too many for the format, if a coordinate is
///   not finite or beyond 32-bit numbers, or as io::writeFileAtomically
void writeStl(const std::filesystem::path& path, std::span<const Vec3> x, std::span<const geometry::Facet> facets);

}  // namespace dovetail::mesh_io
