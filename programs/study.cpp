// dovetail study
#include "dovetail/report/study.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <iostream>
#include <optional>

#include "dovetail/core/parallel.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/time_series.hpp"
#include "dovetail/report/text.hpp"
#include "dovetail/scene/execute.hpp"
#include "dovetail/scene/read.hpp"
#include "energy_study.hpp"
#include "program/options.hpp"
#include "verbs.hpp"

namespace dovetail::program {

namespace {

namespace fs = std::filesystem;

struct Settings {
  std::string scene, out, error;
  std::vector<std::string> over, set;
  std::optional<double> exact;
  int workers = threads();
  bool energy = false, replace = false;
};

/// A key and the values that it is given.
struct Axis {
  std::string key;
  std::vector<std::string> values;
};

/// "key=a,b,c"; commas in brackets and in quotation marks part nothing.
Axis axisOf(const std::string& text) {
  const std::size_t equals = text.find('=');
  const auto refuse = [&](const char* what) {
    return InputError(what, "--over " + text, "write key=a,b,c as in --over radius=1mm,2mm");
  };
  if (equals == std::string::npos || equals == 0) throw refuse("there is no key");
  Axis axis{text.substr(0, equals), {""}};
  int depth = 0;
  bool quoted = false;
  for (const char c : text.substr(equals + 1)) {
    if (c == '"') quoted = !quoted;
    if (!quoted) depth += (c == '[' || c == '{' || c == '(') - (c == ']' || c == '}' || c == ')');
    if (c == ',' && depth == 0 && !quoted)
      axis.values.emplace_back();
    else
      axis.values.back() += c;
  }
  if (std::any_of(axis.values.begin(), axis.values.end(), [](const auto& value) { return value.empty(); }))
    throw refuse("a value is empty");
  return axis;
}

/// Every combination of values, the last axis fastest.
std::vector<io::KeyValues> combinations(const std::vector<Axis>& axes) {
  std::vector<io::KeyValues> all{{}};
  for (const Axis& axis : axes) {
    std::vector<io::KeyValues> more;
    for (const io::KeyValues& some : all)
      for (const std::string& value : axis.values) {
        more.push_back(some);
        more.back().emplace_back(axis.key, value);
      }
    all = std::move(more);
    if (all.size() > 10000) throw InputError("there are more than 10000 runs", "--over", "give fewer values");
  }
  return all;
}

/// What a series ends with, by column, and what became of the energy.
void addSeries(const fs::path& file, report::Json& figures) {
  const io::TimeSeries series = io::readCsv(file);
  if (series.rows() == 0) return;
  figures.update(energyFigures(series));
  for (std::size_t c = 0; c < series.names().size(); ++c)
    figures[series.names()[c]] = report::numberOrNull(series.column(c).back());
}

constexpr const char* ownError = "largest_residual_J";

/// Before hours are spent on runs that have no such figure.
void requireColumn(const scene::Scene& scene, const std::string& name) {
  if (name == ownError) return;
  std::vector<std::string> columns;
  try {
    columns = scene::seriesColumns(scene);
  } catch (const InputError&) {  // its row will say why; others may do
    return;
  }
  if (std::find(columns.begin(), columns.end(), name) != columns.end()) return;
  std::string list = ownError;
  for (const std::string& column : columns) list += ", " + column;
  throw InputError("the series has no column of this name", "--error " + name, "take one of " + list);
}

report::Json runCase(const scene::Scene& scene, const fs::path& folder, const Settings& settings) {
  setThreads(std::max(1, detail::processors() / settings.workers));
  const auto begun = std::chrono::steady_clock::now();
  const fs::path logFile = folder / "log.txt";
  io::writeFileAtomically(logFile, io::provenanceLines(io::provenance(), "# "));
  std::ofstream log(logFile, std::ios::app);
  const bool finished = scene::run(scene, {.folder = folder, .progress = false}, log);
  report::Json figures{{"finished", finished}, {"failure", finished ? "" : "it was interrupted"}};
  figures["wall_seconds"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  addSeries(folder / "series.csv", figures);
  if (!figures.contains(settings.error) || !figures[settings.error].is_number())
    throw InputError("the series has no column of this name", "--error " + settings.error,
                     "take one of " + (folder / "series.csv").string());
  if (settings.exact) figures["error"] = figures[settings.error].get<double>() - *settings.exact;
  return figures;
}

/// Nothing if the values cannot be: then the refusal says why.
std::optional<scene::Scene> sceneOf(const Settings& settings, const std::vector<std::string>& values,
                                    std::optional<InputError>& refusal) {
  try {
    scene::Scene scene = scene::readScene(settings.scene, values);
    if (scene.output.series) return scene;
    refusal.emplace("the scene writes no series to compare", settings.scene,
                    "add output.series, or --set output.series=1ms");
  } catch (const InputError& error) {
    refusal = error;
  }
  return {};
}

/// A scene that a value makes impossible is a row that says why; what makes all of them so is refused before anything
/// is run.
report::Study planOf(const Settings& settings) {
  std::vector<Axis> axes;
  for (const std::string& text : settings.over) axes.push_back(axisOf(text));
  report::Study study;
  study.program = "dovetail";
  study.name = "study";
  study.folder = settings.out.empty() ? fs::path(settings.scene).stem().string() + "-study" : settings.out;
  study.workers = settings.workers;
  study.fronts = {{settings.exact ? "error" : settings.error, "on_front"}};
  study.shown = {settings.error};
  if (settings.exact) study.shown.emplace_back("error");
  std::optional<InputError> first;
  bool anyRuns = false;
  for (io::KeyValues& values : combinations(axes)) {
    std::vector<std::string> all = settings.set;
    std::string label;
    for (const auto& [key, value] : values) {
      all.push_back(key + "=" + value);
      label += (label.empty() ? "" : ", ") + all.back();
    }
    const fs::path folder = study.folder / report::format("%03zu", study.cases.size() + 1);
    values.emplace_back("folder", folder.filename().string());
    std::optional<InputError> refusal;
    const std::optional<scene::Scene> scene = sceneOf(settings, all, refusal);
    if (scene && !anyRuns) requireColumn(*scene, settings.error);
    anyRuns = anyRuns || scene;
    if (!first) first = refusal;
    study.cases.push_back({label, values, [=, &settings] {
                             if (refusal) throw InputError(*refusal);
                             return runCase(*scene, folder, settings);
                           }});
  }
  if (!anyRuns) throw InputError(*first);
  return study;
}

}  // namespace

bool studyScene(int argc, char** argv) {
  Settings settings;
  settings.error = ownError;
  Options options("dovetail study",
                  "Runs a scene with every combination of values; writes study.csv, .json, .md and .svg.");
  options.text("SCENE", settings.scene, "scene file (JSON)").require();
  options.texts("--over KEY=A,B,C", settings.over, "values of a parameter of \"let\", or at a path such as steps.dt")
      .require();
  options.texts("--set KEY=VALUE", settings.set, "the same for all runs");
  options.text("--error COLUMN", settings.error,
               "of the series: its magnitude at the end is the error; default: the largest residual");
  options.number("--exact VALUE", settings.exact, {-1e300, 1e300, true, true, "a number"},
                 "exact value of the column: the error is the difference from it");
  options.flag("--energy", settings.energy,
               "writes energy.html and .csv too: residual of the energy, its order in the step, growth and channels");
  options.integer("--workers N", settings.workers, 1, 1024, "processes at once; default: one for each processor");
  options.flag("--replace", settings.replace, "replaces an earlier study in the folder");
  options.text("--out DIR", settings.out, "folder; <scene>-study if not given");
  if (!options.parse(argc, argv)) return true;
  report::Study study = planOf(settings);
  study.about["settings"] = report::objectOf(options.described());
  std::vector<std::string> files = report::filesOf(study);
  if (settings.energy) std::ranges::copy(energyStudyFiles(), std::back_inserter(files));
  const auto folderOf = [&](std::size_t k) { return study.folder / report::format("%03zu", k + 1); };
  for (std::size_t k = 0; !settings.replace && k < study.cases.size(); ++k) io::requireNoRun(folderOf(k));
  io::prepareOutputFolder(study.folder, files);
  for (std::size_t k = 0; k < study.cases.size(); ++k) io::prepareInnerFolder(folderOf(k), {"log.txt"});
  if (!report::runStudy(study, std::cout, std::cerr)) return false;
  if (settings.energy) writeEnergyStudy(study.folder);
  std::cout << "tables and figure in " << study.folder.string() << '\n';
  return true;
}

}  // namespace dovetail::program
