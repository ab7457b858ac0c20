// Files that a run writes while it goes on.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "dovetail/io/provenance.hpp"
#include "dovetail/io/time_series.hpp"
#include "dovetail/scene/build.hpp"

namespace dovetail::scene {

/// Where a run stands in its stages, and what it has written.
struct Progress {
  std::uint64_t stage = 0;
  std::int64_t window = 0;     ///< in this stage
  std::uint64_t rows = 0;      ///< of the series
  std::vector<double> frames;  ///< their times, s
};

/// Sums of the surface contacts' forces on each solid that has some, N, in the order of the solids; with names.
std::vector<std::pair<std::string, Vec3>> forcesOnSolids(const Built& built);

/// Rows of energies, momenta and forces on solids. Columns are those of the run at its start and of what grains may
/// book later.
class Series {
public:
  Series(Built& built, std::filesystem::path file, io::KeyValues provenance);
  /// Goes on with what an earlier run has written, of which so many rows are kept.
  /// @throws InputError if the file does not hold them
  void takeUp(std::uint64_t rows);
  void add(Built& built);
  std::uint64_t rows() const { return table_.rows(); }

private:
  std::vector<std::string> channels_;
  io::TimeSeries table_;
  std::filesystem::path path_;
  io::GrowingCsv file_;
};

/// Frames for ParaView. In builds without VTK there are none, and wanting them is an InputError.
class Frames {
public:
  Frames(const Built& built, const std::filesystem::path& folder, const io::KeyValues& provenance,
         const std::vector<double>& times);
  ~Frames();
  void add(const Built& built);
  std::vector<double> times() const;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// What states of scenes are; with the mark of our files (output_folder.hpp).
inline constexpr const char* stateKind = "dovetail 1 scene";

/// Keeps the last checkpoint, and the one before.
void writeCheckpoint(const std::filesystem::path& folder, const std::string& hash, const Progress& progress,
                     coupling::CoupledRun& run);
/// @return where the run stood. @throws InputError if there is none, or it is of another scene or damaged
Progress readCheckpoint(const std::filesystem::path& folder, const std::string& hash, coupling::CoupledRun& run);

/// 16 digits of FNV-1a.
std::string hashOf(const std::string& text);

}  // namespace dovetail::scene
