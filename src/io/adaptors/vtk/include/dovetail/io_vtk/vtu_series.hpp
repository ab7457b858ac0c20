// Frames of a run for ParaView: one VTU file per frame and a PVD file that gives their times.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "dovetail/core/vec3.hpp"
#include "dovetail/io/provenance.hpp"

namespace dovetail::io {

/// Views of the caller's data; they need to live only as long as the call that writes them.
struct VectorField {
  std::string name;
  std::span<const Vec3> values;
};
struct ScalarField {
  std::string name;
  std::span<const double> values;
};

/// A mesh of 8-node hexahedra. Points: where the nodes are now, m. Node order of a cell:
/// (−,−,−) (+,−,−) (+,+,−) (−,+,−) (−,−,+) (+,−,+) (+,+,+) (−,+,+). Point fields have one value per point, cell
/// fields one per cell.
struct HexFrame {
  std::span<const Vec3> points;
  std::span<const std::array<int, 8>> cells;
  std::vector<VectorField> pointVectors;
  std::vector<ScalarField> pointScalars;
  std::vector<ScalarField> cellScalars;
};

/// Particles as points (VTK_VERTEX cells). An empty velocity, force or id is left out of the file, except id, which
/// then counts from 0.
struct ParticleFrame {
  std::span<const Vec3> position;  // m
  std::span<const double> radius;  // m
  std::span<const Vec3> velocity;  // m/s
  std::span<const Vec3> force;     // N
  std::span<const std::int64_t> id;
  std::vector<VectorField> vectors;  // further fields, one value per particle
  std::vector<ScalarField> scalars;
};

/// Writes <folder>/<name>/<name>_000000.vtu, …, and <folder>/<name>.pvd, which lists the frames written so far and is
/// renewed after each of them, so that a run that breaks off leaves a series that opens. VTU: appended raw binary,
/// zlib-compressed, doubles; field data "TimeValue" (s) and "provenance" (strings "key: value").
/// Files of an earlier run are replaced one by one as the frames of the same number come; later ones stay, unlisted.
class VtuSeries {
public:
  /// Makes the folders and checks that they can be written; writes no frame.
  /// @throws InputError if that fails, if `name` is not made of ASCII letters, digits, '_', '-' and '.' starting with
  ///         a letter, or if one of the files is there and not ours (output_folder.hpp)
  VtuSeries(const std::filesystem::path& folder, std::string name, KeyValues provenance);
  /// Goes on with a series that a run has begun: its first frames have these times, s.
  /// @throws InputError also if one of these frames is not there
  VtuSeries(const std::filesystem::path& folder, std::string name, KeyValues provenance, std::vector<double> times);

  /// Writes the next frame; `time` in s, larger than the one before. The state at t = 0 is a frame of its own: write
  /// it.
  /// @throws InputError if a field's size or a cell's index does not fit, a name occurs twice, or the time is not
  ///         finite or not larger; nothing is written
  /// @throws Error if writing fails; the frames before are intact
  void write(double time, const HexFrame& frame);
  void write(double time, const ParticleFrame& frame);
  /// The bytes of a VTU file that somebody else has made, which should carry the mark (output_folder.hpp).
  void write(double time, const std::string& vtu);

  std::size_t frames() const { return times_.size(); }
  std::filesystem::path pvdPath() const { return folder_ / (name_ + ".pvd"); }
  std::filesystem::path framePath(std::size_t frame) const;

private:
  void requireLater(double time) const;
  void commit(double time, const std::string& vtu);

  std::filesystem::path folder_;
  std::string name_;
  KeyValues provenance_;
  std::vector<double> times_;
};

}  // namespace dovetail::io
