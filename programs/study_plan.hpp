// What a study runs, and what it compares: from the command line, or from a file of its own.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dovetail/report/curve_error.hpp"

namespace dovetail::program {

/// A key of the scene and its value, as --set takes them.
struct Setting {
  std::string key, value;
};
/// What the runs at one place of an axis have in common.
struct Point {
  std::string name;
  std::vector<Setting> set;
};
/// An axis: values of one key, or points by name.
struct Axis {
  std::string where;
  std::string key, values;  ///< values with commas between them
  std::vector<Point> points;
};

/// A curve that the series of all runs are held to.
struct Against {
  std::string file;              ///< CSV file, or folder of a run
  std::string along = "time_s";  ///< column of x
  report::Norm norm = report::Norm::mean;
};

struct StudyPlan {
  std::string scene;
  std::vector<Setting> set;
  std::vector<Axis> over;
  std::vector<std::string> columns;  ///< to be shown
  std::string error;                 ///< column; empty: the largest residual
  std::optional<double> exact;
  std::optional<Against> against;
};

inline constexpr const char* normWords = "mean|largest|end";

/// Whether the file is a study rather than a scene: it names one.
bool isStudy(const std::string& file);

/// @throws InputError as scene::readScene; if an axis has neither or both of "key" and "points"
StudyPlan readStudy(const std::string& file);

/// "key=a,b,c"; commas in brackets and in quotation marks part nothing. @param where  for messages
Axis axisFrom(const std::string& text, const std::string& where);
/// "key=value". @throws InputError if there is no '='
Setting settingFrom(const std::string& text);

/// A run: its label and settings.
struct StudyRun {
  std::string label;
  std::vector<Setting> set;
};
/// Every combination of the points, the last axis fastest. @throws InputError if they are more than 10 000
std::vector<StudyRun> combinations(const std::vector<Axis>& axes);

/// JSON Schema and Markdown reference of files of studies.
std::string studyReference();

}  // namespace dovetail::program
