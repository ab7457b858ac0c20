// Studies: many runs, their table, and the front of error against run time.
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "dovetail/report/table.hpp"

namespace dovetail::report {

struct StudyCase {
  std::string label;
  io::KeyValues settings;  ///< columns of their own
  /// Runs it and returns its figures, numbers and texts by name; "wall_seconds" is its run time. "finished": false says
  /// that it broke down, "stable": false that it cannot be trusted, and "failure" why. @throws InputError if refused
  std::function<Json()> run;
};

struct Study {
  std::string program;  ///< prefix of messages on interruptions

  /// Marks what no other finished run beats in both the magnitude of a figure and the run time.
  struct Front {
    std::string error;  ///< the figure
    std::string mark;   ///< column for the mark
  };
  std::string name;
  std::filesystem::path folder;
  std::vector<StudyCase> cases;
  std::vector<Front> fronts;
  std::vector<std::string> shown;  ///< figures for the printed lines and the Markdown
  Json about = Json::object();     ///< goes into `<name>.json`
  int workers = 0;                 ///< processes at once; 0: one run after the other in this process
  bool quiet = false;              ///< no lines, no progress
  /// For some milliseconds, while processes are at work; empty: sleeps.
  std::function<void()> wait = {};
};

/// Names of the files that a study writes.
std::vector<std::string> filesOf(const Study& study);

/// Runs all cases, prints a line for each, and writes `<name>.csv`, .json, .md and, with a front, .svg into the folder,
/// anew with every run, rows in the order of the cases. A column "outcome" tells finished, not stable, broke down or
/// refused, "message" why. Signals that ask to end (io/interruption.hpp) are handed on to the processes.
/// @return whether all were run; if not, `error` got a line that says so, and runs that were under way have no row
/// @throws InputError as io::prepareOutputFolder
bool runStudy(const Study& study, std::ostream& log, std::ostream& error);

/// Error against run time of the rows that finished, those on the front joined.
struct Figure;
Figure frontFigure(const std::vector<Json>& rows, const Study::Front& front, const std::string& name);

}  // namespace dovetail::report
