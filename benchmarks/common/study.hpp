// Studies of the published cases: runs that a file plans by options.
#pragma once

#include <string>
#include <vector>

#include "common/settings.hpp"
#include "dovetail/report/study.hpp"

namespace dovetail::benchmark {

/// A run of a study as words of the command line.
struct PlannedRun {
  std::string label;
  std::vector<std::string> words;
};

/// The runs of a study that `asked` names, and of those the ones that it asks for by --only.
///
/// A file of studies has, by name: "error" figures of the fronts with their "marks"; "shown" figures; "about";
/// "defaults" options that give way to those written; and "runs", a list of products of axes. An axis has points by
/// name, each with the options that it sets; null takes one away. Points of the last axis follow one another.
/// @param file  JSON text @throws InputError if no run is called as --only says
std::vector<PlannedRun> plannedRuns(const std::string& file, const RunOptions& asked);

/// All but the cases. @param program  whose study it is
report::Study studyFrom(const std::string& file, const std::string& program, const RunOptions& asked);

}  // namespace dovetail::benchmark
