// The parts of what is told of files.
#pragma once

#include <filesystem>
#include <iosfwd>

#include "dovetail/io/provenance.hpp"
#include "dovetail/io/time_series.hpp"

namespace dovetail::scene {

void inspectTable(const io::TimeSeries& table, std::ostream& out);
/// Of what ends in .vtu, .vtp, .vti or .pvd. @return false for other files, and in builds without VTK
bool inspectFrames(const std::filesystem::path& file, std::ostream& out);
/// Of summary.json. @return false for other files
bool inspectSummary(const std::filesystem::path& file, std::ostream& out);
/// Of surfaces (.stl, .obj, .ply) and meshes (.msh, .inp). @return false for other files
bool inspectShape(const std::filesystem::path& file, std::ostream& out);

/// Provenance of a series.h5.
io::KeyValues readProvenanceHdf5(const std::filesystem::path& file);

}  // namespace dovetail::scene
