// Files of a run: VTU and PVD frames, time series as CSV and HDF5, velocity profiles as CSV, the summary as JSON.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "dovetail/io/output_folder.hpp"
#include "run.hpp"

namespace dovetail::wave {

/// Writes frames of solid and particles while the run goes on. Which formats exist is settled at build time.
class FrameWriter {
public:
  virtual ~FrameWriter() = default;
  virtual void write(const Frame& frame) = 0;
};

/// Null in builds without VTK. @throws InputError if the folder cannot be written or holds foreign files of those names
std::unique_ptr<FrameWriter> makeFrameWriter(const std::filesystem::path& folder, const Settings& settings);
/// Does nothing in builds without HDF5 and returns false.
bool writeSeriesHdf5(const std::filesystem::path& file, const RunResult& result);

/// The files of one run in --out, and --summary. series.csv and profile.csv grow with every frame, so that a run which
/// is cut off leaves them as long as its frames; series.h5 and the summary are written at the end, and those of an
/// earlier run are removed before the run.
class Outputs {
public:
  /// Makes the folder, holds it for this run and checks the names. @throws InputError naming the option, with what to
  /// write instead
  explicit Outputs(const Settings& settings);
  /// What a run is to call with its frames; empty without --out.
  Observer observer();
  void finish(const RunResult& result);

private:
  Settings settings_;
  std::filesystem::path folder_;
  std::optional<io::FolderLock> lock_;
  std::unique_ptr<FrameWriter> frames_;
  io::TimeSeries profile_;
  io::GrowingCsv seriesFile_, profileFile_;
};

}  // namespace dovetail::wave
