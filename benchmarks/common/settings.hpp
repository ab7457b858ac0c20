// What every benchmark run can be told.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dovetail/report/table.hpp"
#include "program/options.hpp"

namespace dovetail::benchmark {

struct RunOptions {
  double dtFactor = 0.0;                     ///< of the contact time
  bool dtAuto = false;                       ///< a fixed fraction of the critical step
  std::optional<double> fractionOfCritical;  ///< dt over the critical step, wins over dtFactor
  bool beyondCritical = false;               ///< do not refuse a step above the critical one
  int femEvery = 1;                          ///< particle steps per step of the solid
  std::optional<double> until;               ///< s; each case has an end of its own
  double stiffnessRatio = 1.0;
  int threads = 1;

  std::string out, summary, reference, study;
  std::string only;             ///< runs of a study whose label is this, or, if none is, holds this
  double outputInterval = 0.0;  ///< s between pictures in --out
  int workers = 0;              ///< processes of a study; 0: one run after the other in this one
  bool profile = false, quiet = false;
  io::KeyValues written;  ///< options of the command line with their values; "true": a flag
};

/// Words in which the cases differ.
struct RunWords {
  std::string automaticStep, dtDefault, endDefault, curves, studies;
};

/// Adds --dt-factor … --threads, then the group of outputs and studies.
void addTimeOptions(program::Options& options, RunOptions& settings, const RunWords& words);
void addOutputOptions(program::Options& options, RunOptions& settings, const RunWords& words);

/// Notes what was written. @throws InputError for options that exclude one another or would do nothing
void checkRun(const program::Options& options, RunOptions& settings);

/// "key=value" of each entry, with all digits: changes of a scene.
std::vector<std::string> changesOf(const report::Json& entries);

/// @throws InputError for an impossible value of the option
void require(bool good, const std::string& option, const std::string& value, const std::string& remedy);

}  // namespace dovetail::benchmark
