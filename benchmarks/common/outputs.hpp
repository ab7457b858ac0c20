// Output places of the benchmark programs.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/report.hpp"
#include "common/settings.hpp"
#include "dovetail/dem/particles/particles.hpp"
#include "dovetail/fem/mesh/solid_mesh.hpp"
#include "dovetail/fem/model/nodes.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/time_series.hpp"

namespace dovetail::benchmark {

/// Returns prepare(); what it refuses is told under the name of the option.
template <class Prepare>
auto underName(const std::string& option, Prepare prepare) {
  try {
    return prepare();
  } catch (const InputError& error) {
    throw InputError(option + ": " + error.what(), "", "");
  }
}

/// Checks that --summary FILE can be written, in a folder that is there. @throws InputError
void prepareSummary(const std::filesystem::path& summary);

template <class Value>
using Fields = std::vector<std::pair<std::string, std::span<const Value>>>;

/// What an observer sees of a run at some time.
struct Frame {
  double time;                 ///< s
  const fem::SolidMesh* mesh;  ///< of hexahedra; null without a solid
  const fem::Nodes* nodes;
  const dem::Particles& particles;
  const io::TimeSeries& series;   ///< up to now
  const io::TimeSeries* profile;  ///< a second table, if the case has one
  Fields<Vec3> nodeVectors;       ///< beside displacement and velocity
  Fields<double> nodeScalars, cellScalars, particleScalars;
};
using Observer = std::function<void(const Frame&)>;

/// A run that nothing stands in the way of; to be called once. The observer is called at t = 0 and every
/// outputInterval; it may be empty. Breakdowns and interruptions (dovetail/io/interruption.hpp) are reported in
/// figures.failure, with the state so far; an interrupted run is observed once more at its end.
template <class Result>
using PreparedRun = std::function<Result(const Observer& observer)>;

/// Writes frames of solid and particles while the run goes on. Which formats exist is settled at build time.
class FrameWriter {
public:
  virtual ~FrameWriter() = default;
  virtual void write(const Frame& frame) = 0;
};
/// Null in builds without VTK. @param solid  name of its files; empty: there is none
/// @throws InputError if the folder cannot be written or holds foreign files of those names
std::unique_ptr<FrameWriter> makeFrameWriter(const std::filesystem::path& folder, const std::string& solid,
                                             const io::KeyValues& provenance);
/// Does nothing in builds without HDF5.
void writeSeriesHdf5(const std::filesystem::path& file, const io::TimeSeries& series, const io::KeyValues& provenance);

/// The files of one run in --out: frames, series.csv and profile.csv, which grow with every frame, so that a run which
/// is cut off leaves them as long as its frames, and series.h5 at the end; and the place of --summary. Those of an
/// earlier run are removed before the run.
class Outputs {
public:
  /// Makes the folder, holds it for this run and checks the names. @param withProfile  whether frames have one
  /// @throws InputError naming the option, with what to write instead
  Outputs(const RunOptions& settings, const std::string& solid, bool withProfile, io::KeyValues provenance);
  /// What a run is to call with its frames; empty without --out.
  Observer observer();
  void finish(const RunData& result);

private:
  std::filesystem::path folder_;
  io::KeyValues provenance_;
  std::optional<io::FolderLock> lock_;
  std::unique_ptr<FrameWriter> frames_;
  io::GrowingCsv series_, profile_;
};

}  // namespace dovetail::benchmark
