// Rows of energies, momenta, forces and probes that a run writes while it goes on.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dovetail/dem/setup/streams.hpp"
#include "dovetail/io/time_series.hpp"
#include "dovetail/scene/series_row.hpp"

namespace dovetail::scene {

/// Sums of the surface contacts' forces on each solid that has some, N, in the order of the solids; with names.
std::vector<std::pair<std::string, Vec3>> forcesOnSolids(const Built& built);

/// In the order of the scene's.
std::vector<const dem::Insertion*> insertionsOf(const Built& built);

/// Where the series goes, series.csv as it grows and, if wanted, series.h5 when it is closed.
struct SeriesFiles {
  std::filesystem::path folder;
  io::KeyValues provenance;
  bool hdf5 = false;
  std::int64_t every = 1;  ///< macro steps between two rows
};

/// The limit of the step takes the eigenvalues of all elements: rows closer than 2000 macro steps repeat the last one
/// found.
class Series {
public:
  /// @throws InputError for a probe of what is not there, and where HDF5 is wanted of a build without
  Series(Built& built, const Scene& scene, SeriesFiles files);
  /// Goes on with what an earlier run has written, of which so many rows are kept.
  /// @throws InputError if the file does not hold them
  void takeUp(std::uint64_t rows);
  void add(Built& built);
  /// Whether the next row does; counted in rows, so that it is the same where a run goes on.
  bool looksAtLimit() const;
  std::uint64_t rows() const { return table_.rows(); }
  const io::TimeSeries& table() const { return table_; }
  /// As last found by this program, if it was.
  const std::optional<StepLimit>& limit() const { return limit_; }
  /// Writes what is not written as it grows. @param scene  in full
  void close(const std::string& scene) const;

private:
  SeriesRow row_;
  io::TimeSeries table_;
  SeriesFiles files_;
  std::filesystem::path path_;
  io::GrowingCsv file_;
  std::optional<StepLimit> limit_;
};

/// Does nothing but throw in builds without HDF5. @throws InputError
void requireHdf5();
void writeSeriesHdf5(const std::filesystem::path& path, const io::TimeSeries& table, const io::KeyValues& provenance);

/// The solids as they are now, solid_<name>.vtkhdf, with what `output.contents` says of them.
void writeSolidsHdf5(const std::filesystem::path& folder, const Built& built, const Scene& scene,
                     const io::KeyValues& provenance);

}  // namespace dovetail::scene
