#include "study_plan.hpp"

#include <algorithm>

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
void describe(Fields& f, Against& v) {
  static constexpr const char* norms[] = {"mean", "largest", "end"};
  f.file({"file", "CSV file with the columns, such as series.csv of a run; or with two columns, x and y"}, v.file);
  f.text({"along", "column of x"}, v.along, false);
  f.choice({"norm", "root of the mean square, largest magnitude, or value at the end of the difference"}, v.norm,
           norms);
}

namespace {

void describeStudy(Fields& f, StudyPlan& v, std::string& columns) {
  f.includes({"include", "other files, whose keys come first"});
  f.file({"scene", "file of the scene"}, v.scene);
  f.list({"set", "values of the scene's keys, the same for all runs"}, v.set);
  f.list({"over", "axes; the study runs every combination of their points"}, v.over, true);
  f.text({"columns", "of the series, with commas between them: shown in the tables, at the end"}, columns, false);
  f.text({"error", "column of the series: its magnitude at the end is the error; the largest residual if not given"},
         v.error, false);
  f.number({"exact", "value of the column: the error is the difference from it"}, v.exact,
           scene::any(scene::unit::none));
  f.object({"against", "a curve: the error is the distance of the column from it"}, v.against);
}

/// Parts between commas; commas in brackets and in quotation marks part nothing.
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
  return parts;
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

}  // namespace

bool isStudy(const std::string& file) {
  const report::Json json = report::Json::parse(scene::textOfFile(file).text, nullptr, false, true);
  return json.is_object() && json.contains("scene");
}

StudyPlan readStudy(const std::string& file) {
  StudyPlan plan;
  std::string columns;
  scene::readFields(scene::textOfFile(file), {}, [&](Fields& f) {
    plan = {};
    describeStudy(f, plan, columns);
  });
  for (const Axis& axis : plan.over)
    if (axis.key.empty() == axis.points.empty() || axis.key.empty() != axis.values.empty())
      throw InputError("the axis has no single list of points", axis.where,
                       "write \"key\" with \"values\", or \"points\"");
  if (!columns.empty()) plan.columns = partsOf(columns);
  return plan;
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

std::vector<StudyRun> combinations(const std::vector<Axis>& axes) {
  std::vector<StudyRun> all{{}};
  for (const Axis& axis : axes) {
    std::vector<StudyRun> more;
    for (const StudyRun& some : all)
      for (const Point& point : pointsOf(axis)) {
        more.push_back(some);
        more.back().label += (some.label.empty() ? "" : ", ") + point.name;
        more.back().set.insert(more.back().set.end(), point.set.begin(), point.set.end());
      }
    all = std::move(more);
    if (all.size() > 10000) throw InputError("there are more than 10000 runs", axis.where, "give fewer values");
  }
  return all;
}

std::string studyReference() {
  return scene::referenceText("study", [](Fields& f) {
    StudyPlan plan;
    std::string columns;
    describeStudy(f, plan, columns);
  });
}

}  // namespace dovetail::program
