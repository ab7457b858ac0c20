// Spheres from files of LAMMPS, LIGGGHTS, YADE and MercuryDPM, and into data files of LAMMPS.
//
// Rules of all readers. Whole files are read, texts only. What a file holds beside spheres (walls, bonds, boundaries,
// further columns) is named in `notes`; spheres that are parts of clumps, and particles of other shapes, are refused by
// their name. Byte-order marks of UTF-8 and lines that end with CR are taken.
//
// Every reader throws InputError, naming the file and the line, for files that cannot be read or break off, numbers
// that are none, NaN or infinite, positions beyond ±1e15 m, radii and densities that are not > 0, and ids that occur
// twice. Nothing that a file holds can make a reader do worse.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dovetail/core/vec3.hpp"
#include "dovetail/geometry/box.hpp"

namespace dovetail::grain_io {

/// Spheres in SI units. Arrays have one entry per sphere, or none where the file does not tell.
struct GrainFile {
  std::vector<Vec3> position;        ///< centres, m
  std::vector<double> radius;        ///< m
  std::vector<double> density;       ///< kg/m³
  std::vector<Vec3> velocity;        ///< m/s
  std::vector<Vec3> spin;            ///< rad/s
  std::vector<std::int64_t> id;      ///< in the file
  std::vector<std::int64_t> type;    ///< of atoms; number of the material of YADE, of the species of MercuryDPM
  std::optional<geometry::Box> box;  ///< of the simulation, m
  std::optional<std::array<bool, 3>> periodic;  ///< along which axes the box repeats; nothing: the file does not tell
  std::optional<double> time;                   ///< s
  std::vector<std::string> notes;               ///< one sentence each

  std::size_t size() const { return position.size(); }
};

/// Of LAMMPS' command `units`. lj: numbers without a unit, taken as metres, kilograms and seconds.
enum class Units { ofFile, si, cgs, micro, nano, lj };

/// A data file of LAMMPS or LIGGGHTS: atom styles sphere, granular, bpm/sphere, and hybrid of sphere with bond or
/// molecular, with Velocities; or a text dump of either, whose columns are known by their names: id, type; x, xu, xs or
/// xsu …; radius or diameter; density or mass; vx …; omegax …. The units are those that the file names, else SI.
/// @param frame  of a dump with several, from 0; −1 is the last, −2 the one before
/// @throws InputError also for units without a length in metres (real, metal, electron; lj unless it is given),
///         sheared boxes, and a frame that is not there
GrainFile readLammps(const std::filesystem::path& path, Units units = Units::ofFile, std::int64_t frame = -1);

/// What export.text and export.textExt of YADE write, with the formats x_y_z_r, x_y_z_r_matId, x_y_z_r_attrs and
/// id_x_y_z_r_matId; without a line "#format" rows of four numbers.
/// @throws InputError also for other formats, such as those of clumps and facets, by their names
GrainFile readYade(const std::filesystem::path& path);

/// A restart file of MercuryDPM, or a .data file in 3-D (14 columns) or 2-D (8 columns: spheres at z = 0).
/// @param frame  as above, of .data files
/// @throws InputError also for particles of other shapes, by their names, and for binary files
GrainFile readMercury(const std::filesystem::path& path, std::int64_t frame = -1);

/// Which of these a text is, by what it begins with.
enum class Code { lammps, yade, mercury };
/// @param where  the text comes from, for errors. @throws InputError if it is none of them
Code codeOf(std::string_view text, const std::string& where);

/// A data file of LAMMPS in SI units with atom style sphere, readable by `read_data`: Atoms and, where a velocity or
/// spin is not zero, Velocities. Numbers are the shortest that read back to the same bits. Types below 1 are raised so
/// that the first is 1. Without a box the file has that which encloses all spheres.
/// @throws InputError if there are no densities, or an array is neither empty nor as long as the others
std::string lammpsText(const GrainFile& grains);

}  // namespace dovetail::grain_io
