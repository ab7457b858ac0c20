#include "study_plan.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "dovetail/core/error.hpp"

namespace dovetail::program {

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

}  // namespace dovetail::program
