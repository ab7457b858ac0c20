#include "study_plan.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "dovetail/core/error.hpp"
#include "dovetail/io/plain_text.hpp"
#include "dovetail/report/table.hpp"
#include "dovetail/scene/files.hpp"

namespace dovetail::program {

using scene::Fields;

void describe(Fields& f, Setting& v) {
  f.text({"key", "of the scene: a parameter of \"let\", or a path such as steps.dt"}, v.key, true);
  f.text({"value", "as in the scene, in quotes"}, v.value, true);
}
void describe(Fields& f, Point& v) {
  f.text({"name", "label of its runs"}, v.name, true);
  f.list({"set", "what its runs have in common; nothing if not given"}, v.set);
}
void describe(Fields& f, Axis& v) {
  f.where(v.where);
  f.text({"key", "of the scene, which takes one value after the other"}, v.key, false);
  f.text({"values", "of the key, with commas between them: \"1 mm, 2 mm\""}, v.values, false);
  f.list({"points", "in place of key and values: places of the axis by name, each with any settings"}, v.points);
}
void describe(Fields& f, Way& v) {
  f.where(v.where);
  f.text({"name", "of its curve in the figure, and before the labels of its runs"}, v.name, true);
  f.file({"scene", "file of the scene"}, v.scene);
  f.list({"set", "values of the scene's keys, the same for all its runs"}, v.set);
  f.list({"over", "axes, as of a study; a single run if not given"}, v.over);
  f.flag({"prepares",
          "whether later ways begin with what it writes, such as a packing: {NAME} in their values is the "
          "folder of its run with the same repeat, and the same value on each axis of its own; it is not compared"},
         v.prepares);
}
void describe(Fields& f, Against& v) {
  static constexpr const char* norms[] = {"mean", "largest", "end", "relative"};
  f.file({"file", "CSV file with the columns, such as series.csv of a run; or with two columns, x and y"}, v.file,
         false);
  f.text({"way", "in place of a file: name of the way whose run is the reference"}, v.way, false);
  f.text({"point", "label of that run, as in the tables; not needed where the way has one"}, v.point, false);
  f.text({"along", "column of x"}, v.along, false);
  f.integer({"stage",
             "only rows of this stage of the runs are compared, and their time counts from its start, as where "
             "stages before relax; -1 is the last, -2 the one before; 0: all rows"},
            v.stage, -1000, 1000);
  f.choice({"norm",
            "root of the mean square, largest magnitude, or value at the end of the difference; or the first "
            "over that of the reference"},
           v.norm, norms);
}

namespace {

/// What is text in the file, and where a study has a single way.
struct Read {
  Way only;
  std::string columns, error;
};

void describeStudy(Fields& f, StudyPlan& v, Read& read) {
  f.includes({"include", "other files, whose keys come first"});
  f.file({"scene", "file of the scene"}, read.only.scene, false);
  f.list({"over", "axes; the study runs every combination of their points"}, read.only.over);
  f.list({"ways", "in place of scene and over: several scenes of one problem, each with axes of its own"}, v.ways);
  f.list({"set", "values of the scenes' keys, the same for all runs"}, v.set);
  f.object({"repeat", "an axis such as the seed: its runs are one point of the figure, with their mean and range"},
           v.repeat);
  f.text({"columns", "of the series, with commas between them: shown in the tables, at the end"}, read.columns, false);
  f.text({"error",
          "column of the series: its magnitude at the end is the error; the largest residual if not given; "
          "several, with commas between them, for relative distances: root of their mean square"},
         read.error, false);
  f.number({"exact", "value of the column: the error is the difference from it"}, v.exact,
           scene::any(scene::unit::none));
  f.object({"against", "a curve: the error is the distance of the column from it"}, v.against);
  f.text({"size",
          "key of an axis whose values are numbers, such as a number of grains along an edge: a further figure has "
          "the processor time over it, and a table the sizes from which one way costs less than another"},
         v.size, false);
}

std::vector<Point> pointsOf(const Axis& axis) {
  if (!axis.points.empty()) return axis.points;
  std::vector<Point> points;
  for (const std::string& value : partsOf(axis.values)) {
    if (value.empty())
      throw InputError("a value is empty", axis.where, "write values with commas between them, as in 1mm,2mm");
    points.push_back({axis.key + "=" + value, {{axis.key, value}}});
  }
  return points;
}

void requireAxes(const std::vector<Axis>& axes) {
  for (const Axis& axis : axes)
    if (axis.key.empty() == axis.points.empty() || axis.key.empty() != axis.values.empty())
      throw InputError("the axis has no single list of points", axis.where,
                       "write \"key\" with \"values\", or \"points\"");
}

void requireWays(const StudyPlan& plan) {
  for (const Way& way : plan.ways) {
    requireAxes(way.over);
    if (std::ranges::count(plan.ways, way.name, &Way::name) > 1)
      throw InputError("two ways are named \"" + way.name + "\"", way.where, "give each a name of its own");
  }
}

/// Points of the way of the reference at which a run may be held to it.
std::vector<std::string> pointsBeside(const StudyRun& run, const std::vector<StudyRun>& runs, const Against& against) {
  std::vector<std::string> points;
  for (const StudyRun& one : runs)
    if (one.way == against.way && isAt(one, against.point) && areBeside(one, run, against.point) &&
        std::ranges::find(points, one.point) == points.end())
      points.push_back(one.point);
  return points;
}

/// Every run has one among the study's own that it is held to.
void findReference(const StudyPlan& plan, Against& against, const std::string& file) {
  const std::vector<StudyRun> runs = runsOf(plan);
  std::vector<std::string> points;
  for (const StudyRun& run : runs)
    if (run.way == against.way && !run.prepares && std::ranges::find(points, run.point) == points.end())
      points.push_back(run.point);
  std::string list;
  for (const std::string& point : points) list += (list.empty() ? "" : "; ") + point;
  if (points.empty())
    throw InputError("there is no way \"" + against.way + "\" to compare with", file + ", against.way",
                     "name one of \"ways\" that does not prepare others");
  if (points == std::vector<std::string>{""} && against.point == against.way) against.point.clear();
  if (std::ranges::none_of(runs,
                           [&](const StudyRun& run) { return run.way == against.way && isAt(run, against.point); }))
    throw InputError("the way has no point \"" + against.point + "\"", file + ", against.point", "take one of " + list);
  bool any = false;
  for (const StudyRun& run : runs) {
    if (run.prepares || (run.way == against.way && isAt(run, against.point))) continue;
    any = true;
    const std::size_t count = pointsBeside(run, runs, against).size();
    if (count != 1)
      throw InputError(count == 0 ? "no run of the way stands beside \"" + run.label() + "\""
                                  : "the way has several points beside \"" + run.label() + "\"",
                       file + ", against.point", "take one of " + list);
  }
  if (!any)
    throw InputError("all runs are references, and none is held to them", file + ", against.point",
                     "take one of " + list);
}

}  // namespace

bool isStudy(const std::string& file) {
  const report::Json json = report::Json::parse(scene::textOfFile(file).text, nullptr, false, true);
  return json.is_object() && (json.contains("scene") || json.contains("ways"));
}

StudyPlan readStudy(const std::string& file) {
  StudyPlan plan;
  Read read;
  scene::readFields(scene::textOfFile(file), {}, [&](Fields& f) {
    plan = {};
    read = {};
    describeStudy(f, plan, read);
  });
  if (plan.ways.empty())
    plan.ways = {read.only};
  else if (!read.only.scene.empty() || !read.only.over.empty())
    throw InputError("there are \"ways\" beside a scene or axes of the study's own", file,
                     "give each way its scene and its axes");
  requireWays(plan);
  if (plan.repeat) requireAxes({*plan.repeat});
  if (!read.columns.empty()) plan.columns = partsOf(read.columns);
  if (!read.error.empty()) plan.error = partsOf(read.error);
  if (plan.against) {
    if (plan.against->file.empty() == plan.against->way.empty())
      throw InputError("the reference is no single one", file + ", against", "give \"file\", or \"way\"");
    if (plan.against->file.empty()) findReference(plan, *plan.against, file);
  }
  return plan;
}

std::vector<std::string> partsOf(const std::string& text) {
  std::vector<std::string> parts{""};
  int depth = 0;
  bool quoted = false;
  for (const char c : text) {
    if (c == '"') quoted = !quoted;
    if (!quoted) depth += (c == '[' || c == '{' || c == '(') - (c == ']' || c == '}' || c == ')');
    if (c == ',' && depth == 0 && !quoted)
      parts.emplace_back();
    else if (c != ' ' || !parts.back().empty())
      parts.back() += c;
  }
  for (std::string& part : parts) part.erase(part.find_last_not_of(' ') + 1);
  return parts;
}

Axis axisFrom(const std::string& text, const std::string& where) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw InputError("there is no key", where, "write key=a,b,c as in --over radius=1mm,2mm");
  return {where, text.substr(0, equals), text.substr(equals + 1), {}};
}

Setting settingFrom(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw InputError("there is no key", "--set " + text, "write key=value");
  return {text.substr(0, equals), text.substr(equals + 1)};
}

namespace {

std::string markOf(const StudyRun& run) { return "{" + run.way + "}"; }

/// Whether a run can begin with it: it is where the run is, on all of its own axes.
bool preparesFor(const StudyRun& before, const StudyRun& run) {
  return before.prepares && areBeside(before, run) &&
         std::ranges::all_of(before.places, [&](const StudyRun::Place& own) {
           return std::ranges::any_of(run.places, [&](const StudyRun::Place& one) { return one.name == own.name; });
         });
}

/// The numbers of those before that the settings name.
void findPreparations(StudyRun& run, const std::vector<StudyRun>& before) {
  for (std::size_t k = 0; k < before.size(); ++k)
    for (const auto* const some : {&run.common, &run.set})
      if (preparesFor(before[k], run) && std::ranges::any_of(*some, [&](const Setting& one) {
            return one.value.find(markOf(before[k])) != std::string::npos;
          }))
        if (std::ranges::find(run.after, k) == run.after.end()) run.after.push_back(k);
}

/// {NAME} that is no preparation: a wrong name would only be found when the packing has been made.
void requireMarks(const StudyRun& run, const std::vector<StudyRun>& before, const std::string& where) {
  for (const auto* const some : {&run.common, &run.set})
    for (const Setting& one : *some)
      for (std::size_t at = one.value.find('{'); at != std::string::npos; at = one.value.find('{', at + 1)) {
        const std::size_t end = one.value.find_first_of("{}\":,", at + 1);
        if (end == std::string::npos || one.value[end] != '}' || end == at + 1) continue;  // an object
        const std::string mark = one.value.substr(at, end + 1 - at);
        if (std::ranges::none_of(before, [&](const StudyRun& b) { return preparesFor(b, run) && markOf(b) == mark; }))
          throw InputError("no way before this one prepares " + mark + " for \"" + run.label() + "\"",
                           where + ", " + one.key,
                           "name an earlier way with \"prepares\": true, whose axes this one has too");
      }
}

}  // namespace

std::string withFolders(std::string text, const StudyRun& run, const std::vector<StudyRun>& runs,
                        const std::function<std::string(std::size_t)>& folder) {
  for (const std::size_t k : run.after) {
    const std::string mark = markOf(runs[k]);
    const std::string name = folder(k);
    for (std::size_t at = 0; (at = text.find(mark, at)) != std::string::npos; at += name.size())
      text.replace(at, mark.size(), name);
  }
  return text;
}

bool areBeside(const StudyRun& a, const StudyRun& b, const std::string& point) {
  const std::vector<std::string> named = partsOf(point);
  const auto isNamed = [&](const StudyRun::Place& one) {
    return one.name == point || std::ranges::find(named, one.name) != named.end();
  };
  return a.repeat == b.repeat && std::ranges::all_of(a.places, [&](const StudyRun::Place& one) {
           return isNamed(one) || std::ranges::all_of(b.places, [&](const StudyRun::Place& other) {
                    return other.key != one.key || other.name == one.name;
                  });
         });
}

bool isAt(const StudyRun& run, const std::string& point) {
  if (point.empty() || point == run.point) return true;
  const auto has = [&](const std::string& name) {
    return std::ranges::any_of(run.places, [&](const StudyRun::Place& one) { return one.name == name; });
  };
  return has(point) || std::ranges::all_of(partsOf(point), has);
}

void requireSizes(const StudyPlan& plan) {
  const std::vector<StudyRun> runs = runsOf(plan);
  const auto isCompared = [&](const StudyRun& run) { return !run.prepares && sizeOf(run, plan.size); };
  if (!plan.size.empty() && std::ranges::none_of(runs, isCompared))
    throw InputError("no axis has the key \"" + plan.size + "\"", "size",
                     "name the key of an axis that ways have in common");
}

std::optional<double> sizeOf(const StudyRun& run, const std::string& key) {
  if (std::ranges::count(run.places, key, &StudyRun::Place::key) > 1)
    throw InputError("two axes of the way have the key of the size", key, "leave one of them out");
  for (const StudyRun::Place& place : run.places) {
    if (key.empty() || place.key != key) continue;
    const std::string value = place.name.substr(key.size() + 1);
    char* end = nullptr;
    const double size = std::strtod(value.c_str(), &end);
    if (*end != '\0' || !(size > 0.0) || !std::isfinite(size))
      throw InputError("the size \"" + value + "\" of a run is no number above 0", key, "write plain numbers");
    return size;
  }
  return {};
}

std::string seriesOf(const StudyRun& run, const std::string& key) {
  std::string series = run.way;
  for (const StudyRun::Place& place : run.places)
    if (place.key != key) series += (series.empty() ? "" : ", ") + place.name;
  return series;
}

std::string StudyRun::label() const {
  std::string text = point;
  if (!repeat.empty()) text += (text.empty() ? "" : ", ") + repeat;
  if (way.empty()) return text;
  return way + (text.empty() ? "" : ": ") + text;
}

std::vector<StudyRun> runsOf(const StudyPlan& plan) {
  std::vector<StudyRun> all;
  for (const Way& way : plan.ways) {
    std::vector<StudyRun> some{{way.scene, way.name, "", "", way.set, {}, {}, {}}};
    const auto multiply = [&](const Axis& axis, std::string StudyRun::*label) {
      std::vector<StudyRun> more;
      const std::vector<Point> points = pointsOf(axis);
      for (const Point& point : points)
        if (std::ranges::count(points, point.name, &Point::name) > 1)
          throw InputError("two points of the axis are named \"" + point.name + "\"", axis.where,
                           "give each a name or a value of its own");
      for (const StudyRun& run : some)
        for (const Point& point : points) {
          more.push_back(run);
          std::string& name = more.back().*label;
          name += (name.empty() ? "" : ", ") + point.name;
          more.back().set.insert(more.back().set.end(), point.set.begin(), point.set.end());
        }
      some = std::move(more);
      if (all.size() + some.size() > 10000)
        throw InputError("there are more than 10000 runs", axis.where, "give fewer values");
    };
    for (const Axis& axis : way.over) {
      multiply(axis, &StudyRun::point);
      const std::vector<Point> points = pointsOf(axis);
      std::string key = axis.key;
      for (std::size_t k = 0; k < points.size() && axis.key.empty(); ++k) key += points[k].name + ";";
      for (std::size_t k = 0; k < some.size(); ++k) some[k].places.push_back({key, points[k % points.size()].name});
    }
    if (plan.repeat) multiply(*plan.repeat, &StudyRun::repeat);
    for (StudyRun& run : some) {
      run.prepares = way.prepares;
      findPreparations(run, all);
      requireMarks(run, all, way.where);
    }
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

std::string studyReference() {
  return scene::referenceText("study", [](Fields& f) {
    StudyPlan plan;
    Read read;
    describeStudy(f, plan, read);
  });
}

}  // namespace dovetail::program
