// What a study runs, and what it compares: from the command line, or from a file of its own.
#pragma once

#include <cstdint>
#include <functional>
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

/// A curve that the series of the runs are held to.
struct Against {
  std::string file;              ///< CSV file; or
  std::string way, point;        ///< runs of the study: each repeat is held to the one with the same value
  std::string along = "time_s";  ///< column of x
  report::Norm norm = report::Norm::mean;
  std::int64_t stage = 0;  ///< whose rows of runs are compared, their time counted from its start; 0: all; −1: the last
};

/// A scene, and what is varied in it.
struct Way {
  std::string where;
  std::string name;  ///< empty: the only one
  std::string scene;
  std::vector<Setting> set;
  std::vector<Axis> over;
  bool prepares = false;  ///< what others begin with: it is not compared
};

struct StudyPlan {
  std::vector<Way> ways;
  std::vector<Setting> set;          ///< of all ways
  std::optional<Axis> repeat;        ///< the runs of a point, such as one for each seed
  std::vector<std::string> columns;  ///< to be shown
  std::vector<std::string> error;    ///< columns; empty: the largest residual
  std::optional<double> exact;
  std::optional<Against> against;
  std::string size;  ///< key of an axis with numbers: costs are compared over it; empty: none
};

inline constexpr const char* normWords = "mean|largest|end|relative";

/// Whether the file is a study rather than a scene: it names some.
bool isStudy(const std::string& file);

/// @throws InputError as scene::readScene; if an axis has neither or both of "key" and "points", if there are ways
/// beside a scene of its own, or two of one name, or if the reference is no single point of the study, or a way begins
/// with another that does not prepare
StudyPlan readStudy(const std::string& file);

/// Parts between commas; commas in brackets and in quotation marks part nothing.
std::vector<std::string> partsOf(const std::string& text);
/// "key=a,b,c"; commas in brackets and in quotation marks part nothing. @param where  for messages
Axis axisFrom(const std::string& text, const std::string& where);
/// "key=value". @throws InputError if there is no '='
Setting settingFrom(const std::string& text);

/// A run.
struct StudyRun {
  std::string scene;
  std::string way, point, repeat;  ///< labels
  std::vector<Setting> common;     ///< of all runs of its way
  std::vector<Setting> set;        ///< what is its own
  /// Its place on each axis: the key (of axes of named points all their names), and the name of the point.
  struct Place {
    std::string key, name;
  };
  std::vector<Place> places;
  std::vector<std::size_t> after;  ///< numbers of the runs that it begins with
  bool prepares = false;
  std::string label() const;
};
/// Whether the two have the same repeat, and the same value on each axis that both have, other than those that the
/// point names. @param point  as of isAt
bool areBeside(const StudyRun& a, const StudyRun& b, const std::string& point = "");
/// Whether it is of the point, given by the names of its places on some of the axes, with commas between them.
bool isAt(const StudyRun& run, const std::string& point);
/// The text with {NAME} of ways that prepare replaced by folder(number of their run).
std::string withFolders(std::string text, const StudyRun& run, const std::vector<StudyRun>& runs,
                        const std::function<std::string(std::size_t)>& folder);
/// @throws InputError if there is a size, and no run that is compared has one
void requireSizes(const StudyPlan& plan);
/// The number of its place on the axis of this key; nothing if it has none.
/// @throws InputError if it is no number > 0, or if two axes have the key
std::optional<double> sizeOf(const StudyRun& run, const std::string& key);
/// Its way, with the names of its places on all other axes.
std::string seriesOf(const StudyRun& run, const std::string& key);
/// All runs of the plan: of each way every combination of the points, the last axis fastest, each repeated.
/// @throws InputError if they are more than 10 000
std::vector<StudyRun> runsOf(const StudyPlan& plan);

/// JSON Schema and Markdown reference of files of studies.
std::string studyReference();

}  // namespace dovetail::program
