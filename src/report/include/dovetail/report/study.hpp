// Studies: many runs, their table, and the front of error against run time.
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "dovetail/report/table.hpp"

namespace dovetail::report {

struct StudyCase {
  std::string label;
  io::KeyValues settings;  ///< columns of their own
  /// Runs it and returns its figures, numbers and texts by name; the cost of the study is one of them. "finished":
  /// false says that it broke down, "stable": false that it cannot be trusted, and "failure" why; "prepares": true
  /// keeps it out of the fronts. @throws InputError if refused
  std::function<Json()> run;
  std::string way = {};    ///< a curve of the figure, of several; empty: there are no others
  std::string point = {};  ///< cases of the same way and point repeat each other, as with other seeds; empty: the label
  std::optional<double> size = {};      ///< of the problem: cases of one series are compared over it
  std::string series = {};              ///< curve of costs over the size
  std::vector<std::size_t> after = {};  ///< numbers of earlier cases that must have finished; refused if one has not
};

struct Study {
  std::string program;  ///< prefix of messages on interruptions

  /// Marks what no other point beats in both the magnitude of a figure and the cost, means of its finished runs.
  struct Front {
    std::string error;  ///< the figure
    std::string mark;   ///< column for the mark
  };
  /// What runs cost: a figure in seconds, and its name in tables and figures.
  struct Cost {
    std::string figure = "wall_seconds", name = "run time";
  };
  std::string name;
  std::filesystem::path folder;
  std::vector<StudyCase> cases;
  std::vector<Front> fronts;
  Cost cost = {};
  std::string size = {};           ///< what StudyCase::size is; empty: there is none
  std::vector<std::string> shown;  ///< figures for the printed lines and the Markdown
  Json about = Json::object();     ///< goes into `<name>.json`
  int workers = 0;                 ///< processes at once; 0: one run after the other in this process
  bool quiet = false;              ///< no lines, no progress
  /// Adds figures that a run has only beside others, whenever one has ended; empty: there are none. Rows stand in the
  /// order of the cases, null as long as there is none. Returns figures of the study as a whole, which go into
  /// `<name>.json`; "scatter", of the reference of the first front, is drawn as a line.
  std::function<Json(std::vector<Json>& rows)> relate = {};
  /// For some milliseconds, while processes are at work; empty: sleeps.
  std::function<void()> wait = {};
};

/// Runs that repeat each other.
struct StudyPoint {
  std::string way, point;
  int runs = 0;          ///< that finished and have the figure
  double seconds = 0.0;  ///< mean cost
  double error = 0.0;    ///< mean magnitude of the figure of a front
  double lowest = 0.0, highest = 0.0;
  bool onFront = false;
};
/// The points of these rows, in the order of their first ones, and which of them are on the front.
/// @param cost  figure in seconds
std::vector<StudyPoint> pointsOf(const std::vector<Json>& rows, const std::string& error, const std::string& cost);

/// Names of the files that a study writes.
std::vector<std::string> filesOf(const Study& study);

/// Runs all cases, prints a line for each, and writes `<name>.csv`, .json, .md and, with a front, .svg into the folder,
/// anew with every run, rows in the order of the cases; where several ways or repeats are compared, also their points,
/// with the means and ranges of the first front's figure; with a size, <name>_scaling.svg has the costs over it. A
/// column "outcome" tells finished, not stable, broke down or refused, "message" why. Signals that ask to end
/// (io/interruption.hpp) are handed on to the processes.
/// @return whether all were run; if not, `error` got a line that says so, and runs that were under way have no row
/// @throws InputError as io::prepareOutputFolder
bool runStudy(const Study& study, std::ostream& log, std::ostream& error);

}  // namespace dovetail::report
