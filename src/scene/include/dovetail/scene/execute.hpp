// Runs a scene: stages, outputs, checkpoints, interruptions.
#pragma once

#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "dovetail/scene/build.hpp"

namespace dovetail::scene {

struct RunOptions {
  std::filesystem::path folder;  ///< for all that is written
  bool progress = true;          ///< shown on a terminal; elsewhere a line per tenth of a stage
  bool profile = false;          ///< time per part of a step in the summary
  bool onRanks = false;          ///< as of build()
  // Of resume():
  std::optional<double> until = {};  ///< s since the start: the new end of the last stage
  std::optional<int> threads = {};   ///< in place of the scene's
};

/// Runs all stages and writes into the folder: scene.json (the scene in full), series.csv and, if wanted, series.h5,
/// summary.txt and summary.json, frames (docs/outputs.md) and checkpoint.state, the one before as
/// checkpoint.previous.state. Every file names the build and the scene's hash. A run that is asked to end by a signal
/// (io/interruption.hpp) ends within 20 macro steps with a checkpoint.
/// @param log  for the summary and progress
/// @return whether all was done; false: a signal asked to end
/// @throws InputError before any step; NumericalError if the run breaks down: what was written stays
bool run(const Scene& scene, const RunOptions& settings, std::ostream& log);

/// The scene of a run. @throws InputError if this is no folder of one
Scene readRun(const std::filesystem::path& folder);

/// Continues from the last undamaged checkpoint in the folder: the files are the same to the last digit as without the
/// break, for any number of threads. With `until`, also for a finished run with checkpoints, they are those of a run
/// whose last stage had that end from the start; scene.json has it from then on.
/// @throws InputError also if there is no run, no checkpoint, or one of another scene; if the state is later than
/// `until`, or the end of the last stage is unknown, since it or an unfinished stage before it relaxes
bool resume(const RunOptions& settings, std::ostream& log);

/// Builds and starts the scene, and prints its sizes, all limits of the step, and the steps, memory, time and disk
/// space of a run, measured on macro steps for up to a second.
/// @throws InputError as build and start; NumericalError if the first steps break down
void check(const Scene& scene, std::ostream& log);

/// Columns of the series that a run of the scene would write. Builds and starts the scene.
/// @throws InputError as build and start
std::vector<std::string> seriesColumns(const Scene& scene);

/// Prints the contents of a file or folder written by Dovetail. @throws InputError if it is none
void tell(const std::filesystem::path& file, std::ostream& out);

}  // namespace dovetail::scene
