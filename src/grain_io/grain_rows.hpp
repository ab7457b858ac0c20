// Spheres of a file as they are read, with their checks.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "dovetail/grain_io/grain_files.hpp"
#include "dovetail/io/text_source.hpp"

namespace dovetail::grain_io {

using io::lower, io::shown, io::TextSource, io::trimmed;

/// "1 wall", "2 walls".
inline std::string counted(std::size_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

std::vector<std::string_view> wordsOf(std::string_view line);

/// A sphere in the units of its file; NaN: not told.
struct Row {
  Vec3 position;
  double radius;
  std::optional<double> density{};
  std::optional<Vec3> velocity{}, spin{};
  std::optional<std::int64_t> id{}, type{};
};

/// Factors to SI units.
struct Scale {
  double length = 1.0, mass = 1.0, time = 1.0;
};

/// Appends rows to a file; what one row tells all tell. Errors name the line that was read last.
class GrainRows {
public:
  GrainRows(const TextSource& source, const Scale& scale) : source_(source), scale_(scale) {}

  void add(const Row& row);
  /// Of a sphere that is there already, by its id.
  void setMotion(std::int64_t id, const Vec3& velocity, const Vec3& spin);
  GrainFile file;
  /// @throws InputError if there are no spheres
  GrainFile finish();

private:
  void requireSound(const Row& row) const;

  const TextSource& source_;
  Scale scale_;
  std::unordered_map<std::int64_t, std::size_t> byId_;
  std::vector<char> moves_;  ///< whose motion was set
};

/// The place of frame `frame` of a list with `count` of them, see readLammps.
std::size_t frameAt(std::int64_t frame, std::size_t count, const std::string& where);

// The readers of texts that are there whole.
GrainFile lammpsData(TextSource& source, Units units);
GrainFile lammpsDump(TextSource& source, Units units, std::int64_t frame);
GrainFile mercuryRestart(TextSource& source);
GrainFile mercuryData(TextSource& source, std::int64_t frame);

/// @param named  by the file, empty if it names none
Scale scaleOf(Units units, std::string_view named, const TextSource& source);
/// Mass over the volume of a sphere.
double densityOf(double mass, double radius);

}  // namespace dovetail::grain_io
