// Studies: scenes over lists of values, in several processes, with functions of Python's.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <unistd.h>

#include <ostream>

#include "callbacks.hpp"
#include "dovetail/scene/read.hpp"
#include "scene_run.hpp"
#include "study_cases.hpp"

namespace dovetail::python {

namespace fs = std::filesystem;

namespace {

using program::StudySettings;

/// Points of an axis as Python gives them: labels, and keys with values.
using Points = std::vector<std::pair<std::string, std::vector<std::pair<std::string, std::string>>>>;

std::vector<program::Axis> axesOf(const std::vector<Points>& over) {
  std::vector<program::Axis> axes;
  for (const Points& points : over) {
    program::Axis& axis = axes.emplace_back(program::Axis{"over", "", "", {}});
    for (const auto& [name, settings] : points) {
      program::Point& point = axis.points.emplace_back(program::Point{name, {}});
      for (const auto& [key, value] : settings) point.set.push_back({key, value});
    }
  }
  return axes;
}

/// Functions are called in the process of their run, where the interpreter must be told that it is a copy.
class Calls {
public:
  /// @param function  gives figures as the text of JSON
  report::Json operator()(const py::function& function, const py::object& argument) const {
    if (const pid_t here = ::getpid(); here != known_) {
      PyOS_AfterFork_Child();
      known_ = here;
    }
    const std::string text = callOurs([&] { return py::cast<std::string>(function(argument)); });
    return report::Json::parse(text);
  }

private:
  mutable pid_t known_ = ::getpid();
};

/// The interpreter's lock is held but while processes work, which are copies of this one.
/// @param read  "key=value" … → Scene  @param act, measure  None, or a function that gives the text of JSON
void runStudy(const py::function& read, const std::vector<Points>& over, const fs::path& folder, const py::object& act,
              const py::object& measure, const std::string& error, std::optional<double> exact,
              std::optional<int> workers, bool replace, const py::function& write) {
  StudySettings settings;
  settings.ways = {{"", "", "", {}, axesOf(over)}};
  settings.folder = folder;
  settings.replace = replace;
  settings.exact = exact;
  settings.workers = workers.value_or(settings.workers);
  if (settings.workers < 0 || settings.workers > 1024)
    throw InputError("there are " + std::to_string(settings.workers) + " processes", "processes",
                     "give 1 to 1024, or 0 for one run after the other in this one");
  settings.read = [&](const std::vector<std::string>& values) {
    return callOurs([&] { return py::cast<scene::Scene>(read(values)); });
  };
  const Calls calls;
  if (!act.is_none())
    settings.act = [&](const scene::Scene& scene) { return calls(py::function(act), py::cast(scene)); };
  if (!measure.is_none())
    settings.measure = [&](const fs::path& of) { return calls(py::function(measure), py::str(of.string())); };
  if (!error.empty())
    settings.error = {error};
  else if (settings.needsSeries())
    settings.error = {program::ownError};
  if (exact && settings.error.empty())
    throw InputError("there is an exact value of no figure", "exact", "name the figure as error");
  const io::InterruptionGuard guard;
  Lines lines(write);
  std::ostream log(&lines);
  report::Study study = program::studyOf(settings);
  study.wait = [] {
    const py::gil_scoped_release free;
    ::usleep(5000);
  };
  program::prepareFolders(study, settings);
  endAs(report::runStudy(study, log, log));
}

}  // namespace

void bindStudies(py::module_& m) { m.def("run_study", &runStudy); }

}  // namespace dovetail::python
