// Meshes in VTK's format on HDF5, for ParaView and for h5py.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "dovetail/core/vec3.hpp"
#include "dovetail/io/provenance.hpp"

namespace dovetail::io {

/// Cells of any of VTK's types with values per point or cell, side by side.
struct HdfGrid {
  std::span<const Vec3> points;            ///< m
  std::vector<std::int64_t> connectivity;  ///< numbers of points, cell by cell
  std::vector<std::int64_t> offsets;       ///< of each cell therein, and the end
  std::vector<std::uint8_t> types;         ///< of cells
  struct Field {
    std::string name;
    std::span<const double> values;
    int components = 1;
    bool perCell = false;
  };
  std::vector<Field> fields;
};

/// One state as VTKHDF 1.0, an UnstructuredGrid, which VTK 9.1 and later read; "TimeValue" (s) is field data, the
/// provenance lies in string attributes of the root group. Later versions of the format have series, which VTK 9.1 does
/// not read.
/// @throws InputError for a field of another size than the grid, and as writeHdf5; Error as writeHdf5
void writeVtkHdf(const std::filesystem::path& path, double time, const HdfGrid& grid, const KeyValues& provenance);

/// Points at an instant, with values side by side.
struct HdfPoints {
  double time = 0.0;             ///< s
  std::span<const Vec3> points;  ///< m
  struct Field {
    std::string name;
    std::span<const double> values;
    int components = 1;
  };
  struct Integers {
    std::string name;
    std::span<const std::int64_t> values;
  };
  std::vector<Field> fields;
  std::vector<Integers> integers;
};

/// All frames in one file: a temporal UnstructuredGrid of vertices, VTKHDF 2.0, which VTK 9.3 and ParaView 5.12 and
/// later read. Points may come and go between the frames.
/// @throws InputError if there are no frames, times do not grow, frames have other fields than the first, or fields
/// another size than the points; and as writeHdf5; Error as writeHdf5
void writeVtkHdfSeries(const std::filesystem::path& path, const std::vector<HdfPoints>& frames,
                       const KeyValues& provenance);

}  // namespace dovetail::io
