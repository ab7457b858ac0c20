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

struct IntegerField {
  std::string name;
  std::span<const std::int64_t> values;
};
/// One value, vector or tensor (nine, row-major) per point.
struct ComponentField {
  std::string name;
  std::span<const double> values;
  int components = 1;
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

/// The view of what holds these arrays by these names, such as dem::Particles. @param particles  must outlive the view
template <class Particles>
ParticleFrame frameOf(const Particles& particles) {
  return {.position = particles.x,
          .radius = particles.radius,
          .velocity = particles.v,
          .force = particles.f,
          .id = particles.id,
          .vectors = {},
          .scalars = {}};
}

/// Lines, or triangles (VTP files), with points of their own: fields have one value per line or triangle.
struct PolyFrame {
  std::span<const Vec3> points;                   // m
  std::span<const std::array<int, 2>> lines;      // numbers of points
  std::span<const std::array<int, 3>> triangles;  // of these or of lines there are none
  std::vector<VectorField> vectors;
  std::vector<ScalarField> scalars;
  std::vector<IntegerField> integers;
};

/// Points without a size (VTK_VERTEX cells), such as those of a quadrature.
struct PointFrame {
  std::span<const Vec3> points;  // m
  std::vector<ComponentField> fields;
  std::vector<IntegerField> integers;
};

/// Values on a regular grid, x fastest.
struct GridFrame {
  Vec3 lower, spacing;       // first point, distance of points, m
  std::array<int, 3> count;  // of points per direction
  std::vector<ComponentField> fields;
};
/// Its bytes as a VTI file. @throws InputError if a field has another size than the grid; Error if VTK fails
std::string vtiText(double time, const GridFrame& frame, const KeyValues& provenance);

/// The bytes of one frame as a VTU file. The sizes of fields must be checked. @throws Error if VTK fails
std::string vtuText(double time, const ParticleFrame& frame, const KeyValues& provenance);

/// What the frames of a series are files of.
enum class FrameFile { vtu, vtp };

/// Writes `<folder>/<name>/<name>_000000.vtu` (or .vtp), …, and `<folder>/<name>.pvd`, which lists the frames written
/// so far and is updated after each of them, so that a run that breaks off leaves a series that opens. Frames survive
/// kills, not power cuts (core/atomic_file.hpp). Appended raw binary, doubles; particles are not compressed, which
/// would take longer than the rest; field data "TimeValue" (s) and "provenance" (strings "key: value"). Files of an
/// earlier run are replaced one by one as the frames of the same number come; later ones stay, unlisted.
class VtuSeries {
public:
  /// Makes the folders and checks that they can be written; writes no frame.
  /// @throws InputError if that fails, if `name` is not made of ASCII letters, digits, '_', '-' and '.' starting with
  ///         a letter, or if one of the files is there and not ours (output_folder.hpp)
  VtuSeries(const std::filesystem::path& folder, std::string name, KeyValues provenance);
  /// Goes on with a series that a run has begun: its first frames have these times, s.
  /// @throws InputError also if one of these frames is not there
  VtuSeries(const std::filesystem::path& folder, std::string name, KeyValues provenance, std::vector<double> times,
            FrameFile file = FrameFile::vtu);

  /// Writes the next frame; `time` in s, larger than the one before. The state at t = 0 is a frame of its own: write
  /// it.
  /// @throws InputError if a field's size or a cell's index does not fit, a name occurs twice, or the time is not
  ///         finite or not larger; nothing is written
  /// @throws Error if writing fails; the frames before are intact
  void write(double time, const HexFrame& frame);
  void write(double time, const ParticleFrame& frame);
  void write(double time, const PolyFrame& frame);
  void write(double time, const PointFrame& frame);
  /// The bytes of a VTU file that somebody else has made, which should carry the mark (output_folder.hpp).
  void write(double time, const std::string& vtu);
  /// Takes the last frame back: the next one has its place.
  void dropLast() {
    if (!times_.empty()) times_.pop_back();
  }

  std::size_t frames() const { return times_.size(); }
  std::filesystem::path pvdPath() const { return folder_ / (name_ + ".pvd"); }
  std::filesystem::path framePath(std::size_t frame) const;
  void requireFreeFrames() const;

private:
  void requireLater(double time) const;
  void commit(double time, const std::string& vtu);
  std::string fileName(std::size_t frame) const;

  std::filesystem::path folder_;
  std::string name_;
  KeyValues provenance_;
  FrameFile file_ = FrameFile::vtu;
  std::vector<double> times_;
};

}  // namespace dovetail::io
