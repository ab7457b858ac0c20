// What every benchmark run can be told.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <utility>

#include "program/options.hpp"

namespace dovetail::benchmark {

struct RunSettings {
  double dtFactor = 0.0;                  ///< of the contact time
  bool dtAuto = false;                    ///< a fixed share of the critical step
  std::optional<double> shareOfCritical;  ///< dt over the critical step, wins over dtFactor (studies)
  bool beyondCritical = false;            ///< do not refuse a step above the critical one (studies)
  int femEvery = 1;                       ///< particle steps per step of the solid
  std::optional<double> until;            ///< s; each case has an end of its own
  double stiffnessRatio = 1.0;
  int threads = 1;

  std::string out, summary, reference, study;
  std::string only;             ///< runs of a study whose label is this, or, if none is, holds this
  double outputInterval = 0.0;  ///< s between pictures in --out
  int workers = 0;              ///< processes of a study; 0: one run after the other in this one
  bool profile = false, quiet = false;
};

/// Words in which the cases differ.
struct RunWords {
  std::string automaticStep, dtDefault, endDefault, curves, studies;
};

/// Adds --dt-factor … --threads, then the group of outputs and studies.
/// @return the row of --dt-factor
program::Option& addTimeOptions(program::Options& options, RunSettings& settings, const RunWords& words);
void addOutputOptions(program::Options& options, RunSettings& settings, const RunWords& words);

/// @throws InputError for what no run can use together
void checkRun(const RunSettings& settings);
void refuseIdleRunOptions(const program::Options& options, const RunSettings& settings);

/// Entries of io::provenance with what the options say and what none of them changes.
template <class Settings>
io::KeyValues provenanceOf(const Settings& settings) {
  auto entries = describe(settings);
  for (auto& entry : describeCase(typename Settings::Fixed{})) entries.push_back(std::move(entry));
  return io::provenance(entries);
}

/// @throws InputError for an impossible value of the option
void require(bool good, const std::string& option, const std::string& value, const std::string& remedy);

}  // namespace dovetail::benchmark
