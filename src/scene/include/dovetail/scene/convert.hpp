// Files of grains and meshes of one kind from those of another.
#pragma once

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <optional>

#include "dovetail/grain_io/grain_files.hpp"

namespace dovetail::scene {

struct ConvertOptions {
  std::optional<double> density;  ///< of grains, kg/m³, where the file has none
  grain_io::Units units = grain_io::Units::ofFile;
  std::optional<std::int64_t> frame{};  ///< of several, see grain_io::readLammps
};

/// Grains: from files of LAMMPS, LIGGGHTS, YADE and MercuryDPM by their content, from tables (.csv), frames (.vtu,
/// .vtp, .pvd), states (.state) and folders of runs; into data files of LAMMPS (.data, .lmp), tables (.csv) and frames
/// (.vtu); series of frames into one file (.vtkhdf). Meshes of solids: from .msh, .inp, .vtu and Exodus (.e, .exo, .g)
/// into .msh, .inp and .vtu. What the new file cannot hold is told. Units are SI.
/// @throws InputError for other endings, what cannot be read, and what is at `to` and not ours
void convert(const std::filesystem::path& from, const std::filesystem::path& to, const ConvertOptions& settings,
             std::ostream& log);

/// What `dovetail info` prints of a file of another code. @return false for other files
bool inspectGrains(const std::filesystem::path& file, std::ostream& out);

}  // namespace dovetail::scene
