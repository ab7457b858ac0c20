#include "study_cases.hpp"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <optional>

#include "dovetail/core/error.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/time_series.hpp"
#include "dovetail/report/text.hpp"
#include "dovetail/scene/execute.hpp"
#include "dovetail/scene/read.hpp"
#include "energy_study.hpp"

namespace dovetail::program {

namespace {

namespace fs = std::filesystem;

/// What a series ends with, by column, and what became of the energy.
void addSeries(const fs::path& file, report::Json& figures) {
  const io::TimeSeries series = io::readCsv(file);
  if (series.rows() == 0) return;
  figures.update(energyFigures(series));
  for (std::size_t c = 0; c < series.names().size(); ++c)
    figures[series.names()[c]] = report::numberOrNull(series.column(c).back());
}

/// Before hours are spent on runs that have no such figure. @param option  that names it
void requireColumn(const scene::Scene& scene, const std::string& name, const std::string& option) {
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
  throw InputError("the series has no column of this name", option + " " + name, "take one of " + list);
}

bool hasColumn(const io::TimeSeries& series, const std::string& name) {
  return std::ranges::find(series.names(), name) != series.names().end();
}

/// All stages, with files in the folder.
report::Json runStages(const scene::Scene& scene, const fs::path& folder) {
  const fs::path logFile = folder / "log.txt";
  io::writeFileAtomically(logFile, io::provenanceLines(io::provenance(), "# "));
  std::ofstream log(logFile, std::ios::app);
  const bool finished = scene::run(scene, {.folder = folder, .progress = false}, log);
  return {{"finished", finished}, {"failure", finished ? "" : "it was interrupted"}};
}

/// The error of a run beside the references. @throws InputError if its figures do not have it
void addError(const fs::path& folder, const StudySettings& settings, report::Json& figures) {
  if (!figures.contains(settings.error) || !figures[settings.error].is_number())
    throw InputError("the series has no column of this name", "--error " + settings.error,
                     "take one of " + (folder / "series.csv").string());
  if (settings.exact) figures["error"] = figures[settings.error].get<double>() - *settings.exact;
  if (const auto& against = settings.against) {
    const report::CurveError found =
        report::distanceFrom(curveIn(against->file, against->along, settings.error, true),
                             curveIn(folder / "series.csv", against->along, settings.error, false), against->norm);
    figures["error"] = found.value;
    figures["covered"] = found.covered;
  }
}

report::Json runCase(const scene::Scene& scene, const fs::path& folder, const StudySettings& settings) {
  if (settings.workers > 0) setThreads(std::max(1, detail::processors() / settings.workers));
  const auto begun = std::chrono::steady_clock::now();
  const report::Json own = settings.act ? settings.act(scene) : report::Json::object();
  report::Json figures = settings.act ? report::Json{{"finished", true}} : runStages(scene, folder);
  figures["wall_seconds"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  if (!settings.act && fs::exists(folder / "series.csv")) addSeries(folder / "series.csv", figures);
  figures.update(own);
  if (settings.measure && figures["finished"] == true) figures.update(settings.measure(folder));
  if (!settings.error.empty()) addError(folder, settings, figures);
  return figures;
}

/// Nothing if the values cannot be: then the refusal says why.
std::optional<scene::Scene> sceneOf(const StudySettings& settings, const std::vector<std::string>& values,
                                    std::optional<InputError>& refusal) {
  try {
    scene::Scene scene = settings.read ? settings.read(values) : scene::readScene(settings.scene, values);
    if (scene.output.series || !settings.needsSeries()) return scene;
    refusal.emplace("the scene writes no series to compare", settings.scene,
                    "add output.series, or --set output.series=1ms");
  } catch (const InputError& error) {
    refusal = error;
  }
  return {};
}

std::vector<std::string> shownFigures(const StudySettings& settings) {
  std::vector<std::string> shown = settings.columns;
  if (!settings.error.empty() && std::ranges::find(shown, settings.error) == shown.end())
    shown.push_back(settings.error);
  if (settings.hasError()) shown.emplace_back("error");
  if (settings.against) shown.emplace_back("covered");
  return shown;
}

void requireColumns(const scene::Scene& scene, const StudySettings& settings) {
  requireColumn(scene, settings.error, "--error");
  for (const std::string& column : settings.columns) requireColumn(scene, column, "--show");
  if (settings.against) requireColumn(scene, settings.against->along, "--along");
}

}  // namespace

report::Curve curveIn(const fs::path& file, const std::string& x, const std::string& y, bool isReference) {
  const io::TimeSeries series = io::readCsv(file);
  const auto curve = [&](std::span<const double> a, std::span<const double> b) {
    return report::Curve{file.string(), {a.begin(), a.end()}, {b.begin(), b.end()}};
  };
  if (isReference && series.names().size() == 2 && !(hasColumn(series, x) && hasColumn(series, y)))
    return curve(series.column(std::size_t{0}), series.column(std::size_t{1}));
  for (const std::string& name : {x, y})
    if (!hasColumn(series, name))
      throw InputError("there is no column " + name, file.string(),
                       isReference ? "name its columns as in series.csv, or give two: x and y" : "correct its name");
  return curve(series.column(x), series.column(y));
}

fs::path folderOf(const StudySettings& settings, std::size_t run) {
  return settings.folder / report::format("%03zu", run + 1);
}

report::Study studyOf(const StudySettings& settings) {
  report::Study study;
  study.program = "dovetail";
  study.name = "study";
  study.folder = settings.folder;
  study.workers = settings.workers;
  if (!settings.error.empty()) study.fronts = {{settings.hasError() ? "error" : settings.error, "on_front"}};
  study.shown = shownFigures(settings);
  std::optional<InputError> first;
  bool anyRuns = false;
  for (const StudyRun& run : combinations(settings.over)) {
    std::vector<std::string> all;
    io::KeyValues values;
    for (const Setting& one : settings.set) all.push_back(one.key + "=" + one.value);
    for (const Setting& one : run.set) {
      all.push_back(one.key + "=" + one.value);
      values.emplace_back(one.key, one.value);
    }
    const fs::path folder = folderOf(settings, study.cases.size());
    if (!settings.act) values.emplace_back("folder", folder.filename().string());
    std::optional<InputError> refusal;
    const std::optional<scene::Scene> scene = sceneOf(settings, all, refusal);
    if (scene && !anyRuns && settings.needsSeries()) requireColumns(*scene, settings);
    anyRuns = anyRuns || scene;
    if (!first) first = refusal;
    study.cases.push_back({run.label, values, [=, &settings] {
                             if (refusal) throw InputError(*refusal);
                             return runCase(*scene, folder, settings);
                           }});
  }
  if (!anyRuns) throw InputError(*first);
  return study;
}

void prepareFolders(const report::Study& study, const StudySettings& settings, const std::vector<std::string>& more) {
  const std::size_t runs = settings.act ? 0 : study.cases.size();
  for (std::size_t k = 0; !settings.replace && k < runs; ++k) io::requireNoRun(folderOf(settings, k));
  std::vector<std::string> files = report::filesOf(study);
  files.insert(files.end(), more.begin(), more.end());
  io::prepareOutputFolder(study.folder, files);
  for (std::size_t k = 0; k < runs; ++k) io::prepareInnerFolder(folderOf(settings, k), {"log.txt"});
}

}  // namespace dovetail::program
