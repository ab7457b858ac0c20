// Files of studies.
#include <algorithm>

#include "dovetail/core/error.hpp"
#include "dovetail/report/table.hpp"
#include "dovetail/scene/files.hpp"
#include "study_plan.hpp"

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

std::string studyReference() {
  return scene::referenceText("study", [](Fields& f) {
    StudyPlan plan;
    Read read;
    describeStudy(f, plan, read);
  });
}

}  // namespace dovetail::program
