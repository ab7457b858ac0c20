// Files of a run: VTU and PVD frames, time series as CSV and HDF5, the summary as JSON.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "run.hpp"

namespace dovetail::cantilever {

/// Writes frames of beam and particles while the run goes on. Which formats exist is settled at build time.
class FrameWriter {
public:
  virtual ~FrameWriter() = default;
  virtual void write(const Frame& frame) = 0;
};

/// Null in builds without VTK. @throws InputError if the folder cannot be written or holds foreign files of those names
std::unique_ptr<FrameWriter> makeFrameWriter(const std::filesystem::path& folder, const Settings& settings);
/// Does nothing in builds without HDF5 and returns false.
bool writeSeriesHdf5(const std::filesystem::path& file, const RunResult& result);

/// Makes the folders and checks file names before the run.
/// @return the writer of frames; null without --out
/// @throws InputError naming the option, with what to write instead
std::unique_ptr<FrameWriter> prepareOutputs(const Settings& settings);
/// Time series and energy ledger into --out. Returns the names of the files written.
std::vector<std::string> writeSeries(const RunResult& result);

}  // namespace dovetail::cantilever
