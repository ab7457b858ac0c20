// Files of a run: VTU and PVD frames, time series as CSV and HDF5, velocity profiles as CSV.
#pragma once

#include <filesystem>
#include <memory>

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

/// Checks folder and file names before the run. Null without --out, and in builds without VTK.
/// @throws InputError with what to write instead
std::unique_ptr<FrameWriter> prepareOutputs(const Settings& settings);
/// Time series (series.csv, series.h5) and velocity profiles (profile.csv) into --out.
void writeTables(const RunResult& result, const io::TimeSeries& profile);

}  // namespace dovetail::wave
