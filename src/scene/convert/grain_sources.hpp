// Grains from whatever file holds them, and into files.
#pragma once

#include <filesystem>
#include <vector>

#include "dovetail/fem/mesh/solid_mesh.hpp"
#include "dovetail/scene/convert.hpp"

namespace dovetail::scene {

/// The grains of one instant. @throws InputError as convert
grain_io::GrainFile grainsFrom(const std::filesystem::path& from, const ConvertOptions& settings);

/// Of a frame (.vtu, .vtp); refused in builds without VTK.
grain_io::GrainFile grainsOfFrame(const std::filesystem::path& frame);
/// Times, s, and files of a series (.pvd).
std::vector<std::pair<double, std::filesystem::path>> framesOf(const std::filesystem::path& series);
void writeGrainFrame(const std::filesystem::path& to, const grain_io::GrainFile& grains);
void writeMeshFrame(const std::filesystem::path& to, const fem::SolidMesh& mesh);

/// Frames of grains, one after the other; refused in builds without HDF5.
void writeGrainSeries(const std::filesystem::path& to, const std::vector<grain_io::GrainFile>& frames);

}  // namespace dovetail::scene
