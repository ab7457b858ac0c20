#include "study_cases.hpp"

#include <algorithm>
#include <fstream>
#include <optional>

#include "dovetail/core/error.hpp"
#include "dovetail/core/stopwatch.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/plain_text.hpp"
#include "dovetail/io/time_series.hpp"
#include "dovetail/report/text.hpp"
#include "dovetail/scene/execute.hpp"
#include "dovetail/scene/read.hpp"
#include "energy_study.hpp"
#include "study_errors.hpp"

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

/// All stages, with files in the folder, or those that are left.
report::Json runStages(const scene::Scene& scene, const fs::path& folder, bool resumes) {
  const fs::path logFile = folder / "log.txt";
  if (!resumes) io::writeFileAtomically(logFile, io::provenanceLines(io::provenance(), "# "));
  std::ofstream log(logFile, std::ios::app);
  const scene::RunOptions options{.folder = folder, .progress = false};
  const bool finished = resumes ? scene::resume(options, log) : scene::run(scene, options, log);
  return {{"finished", finished}, {"failure", finished ? "" : "it was interrupted"}};
}

/// Before a reference is asked for them.
void requireFigures(const fs::path& folder, const StudySettings& settings, const report::Json& figures) {
  for (const std::string& column : settings.error)
    if (!figures.contains(column) || !figures[column].is_number())
      throw InputError("the series has no column of this name", "--error " + column,
                       "take one of " + (folder / "series.csv").string());
}

/// What the stages of a run took, in all programs that ran them.
TimeTaken takenByStages(const fs::path& folder) {
  TimeTaken sum;
  const report::Json summary = report::Json::parse(io::readWhole(folder / "summary.json", "summary"));
  for (const report::Json& stage : summary.at("times").at("stages"))
    sum += {stage.at("seconds").get<double>(), stage.at("processor_seconds").get<double>()};
  return sum;
}

report::Json runCase(const scene::Scene& scene, const fs::path& folder, const StudySettings& settings, bool compared,
                     bool resumes) {
  if (settings.threadsEach)
    setThreads(*settings.threadsEach);
  else if (settings.workers > 0)
    setThreads(std::max(1, detail::processors() / settings.workers));
  const Stopwatch watch;
  const report::Json own = settings.act ? settings.act(scene) : report::Json::object();
  report::Json figures = settings.act ? report::Json{{"finished", true}} : runStages(scene, folder, resumes);
  const TimeTaken taken = resumes && figures["finished"] == true ? takenByStages(folder) : watch.sinceBegin();
  figures["wall_seconds"] = taken.wall;
  figures["processor_seconds"] = taken.processor;
  if (!settings.act && fs::exists(folder / "series.csv")) addSeries(folder / "series.csv", figures);
  figures.update(own);
  if (settings.measure && figures["finished"] == true) figures.update(settings.measure(folder));
  if (compared)
    requireFigures(folder, settings, figures);
  else
    figures["prepares"] = true;
  return figures;
}

/// Nothing if the values cannot be: then the refusal says why.
std::optional<scene::Scene> sceneOf(const StudySettings& settings, const std::string& file,
                                    const std::vector<std::string>& values, bool compared,
                                    std::optional<InputError>& refusal) {
  try {
    scene::Scene scene = settings.read ? settings.read(values) : scene::readScene(file, values);
    if (scene.output.series || !settings.needsSeries() || !compared) return scene;
    refusal.emplace("the scene writes no series to compare", file, "add output.series, or --set output.series=1ms");
  } catch (const InputError& error) {
    refusal = error;
  }
  return {};
}

std::vector<std::string> shownFigures(const StudySettings& settings) {
  std::vector<std::string> shown = settings.columns;
  for (const std::string& column : settings.error)
    if (std::ranges::find(shown, column) == shown.end()) shown.push_back(column);
  if (settings.hasError()) shown.emplace_back("error");
  if (settings.against) shown.emplace_back("covered");
  return shown;
}

void requireColumns(const scene::Scene& scene, const StudySettings& settings) {
  for (const std::string& column : settings.error) requireColumn(scene, column, "--error");
  for (const std::string& column : settings.columns) requireColumn(scene, column, "--show");
  if (settings.against) requireColumn(scene, settings.against->along, "--along");
}

/// What the repeats of a run have in common; empty: it has no name but the label.
std::string pointOf(const StudySettings& settings, const StudyRun& run) {
  if (!settings.repeat && run.way.empty()) return "";
  if (!run.point.empty()) return run.point;
  return run.way.empty() ? "all" : run.way;
}

/// What an earlier study in the folder left of a run, where the scene is still the same.
struct Earlier {
  std::optional<report::Json> figures;  ///< of the run, if it need not be done again
  bool resumes = false;                 ///< from a checkpoint
};

/// @param rows  of the earlier study
Earlier earlierOf(const fs::path& folder, const StudyRun& run, const scene::Scene& scene,
                  const std::vector<report::Json>& rows) {
  try {
    if (!fs::exists(folder / "scene.json") || sceneText(scene::readRun(folder)) != sceneText(scene)) return {};
  } catch (const InputError&) {  // of a run of another version: it is run anew
    return {};
  }
  for (const report::Json& row : rows)
    if (row["label"] == run.label() && row["outcome"] == "finished" && row.contains("processor_seconds") &&
        row["settings"].value("folder", "") == folder.filename().string()) {
      report::Json figures = row;
      for (const char* const key : {"label", "way", "point", "outcome", "message", "settings", "on_front", "prepares"})
        figures.erase(key);
      if (run.prepares) figures["prepares"] = true;
      for (const auto& [key, value] : row.items())
        if (key == "covered" || key.starts_with("error")) figures.erase(key);
      return {figures, false};
    }
  return {{}, fs::exists(folder / "checkpoint.state")};
}

std::vector<report::Json> earlierRows(const StudySettings& settings) {
  const fs::path file = settings.folder / "study.json";
  if (!settings.goOn || !fs::exists(file)) return {};
  const report::Json study = report::Json::parse(io::readWhole(file, "study"), nullptr, false);
  if (study.is_discarded() || !study.contains("runs"))
    throw InputError("this is no table of a study", file.string(), "give --replace to begin anew");
  return study["runs"];
}

}  // namespace

fs::path folderOf(const StudySettings& settings, std::size_t run) {
  return settings.folder / report::format("%03zu", run + 1);
}

report::Study studyOf(const StudySettings& settings) {
  requireSizes(settings);
  report::Study study;
  study.program = "dovetail";
  study.name = "study";
  study.folder = settings.folder;
  study.workers = settings.workers;
  study.cost = {"processor_seconds", "processor time"};
  study.size = settings.size;
  if (!settings.error.empty()) study.fronts = {{settings.hasError() ? "error" : settings.error.front(), "on_front"}};
  study.shown = shownFigures(settings);
  const std::vector<StudyRun> runs = runsOf(settings);
  const auto folderNamed = [&](std::size_t k) { return fs::absolute(folderOf(settings, k)).string(); };
  if (settings.hasError())
    study.relate = [=, &settings](std::vector<report::Json>& rows) { return addErrors(settings, runs, rows); };
  const std::vector<report::Json> rows = earlierRows(settings);
  std::optional<InputError> first;
  std::vector<std::string> checked;  // ways
  std::vector<bool> kept;            // runs of an earlier study
  for (const StudyRun& run : runs) {
    std::vector<std::string> all;
    for (const auto* const some : {&settings.set, &run.common, &run.set})
      for (const Setting& one : *some) all.push_back(one.key + "=" + withFolders(one.value, run, runs, folderNamed));
    io::KeyValues values;
    for (const Setting& one : run.set) values.emplace_back(one.key, one.value);
    const fs::path folder = folderOf(settings, study.cases.size());
    if (!settings.act) values.emplace_back("folder", folder.filename().string());
    std::optional<InputError> refusal;
    const std::optional<scene::Scene> scene = sceneOf(settings, run.scene, all, !run.prepares, refusal);
    if (scene && settings.needsSeries() && !run.prepares && run.after.empty() &&
        std::ranges::find(checked, run.way) == checked.end())
      requireColumns(*scene, settings);
    if (refusal && !run.after.empty()) refusal.reset();  // what it begins with is not there yet
    if (!refusal) checked.push_back(run.way);
    if (!first) first = refusal;
    // What begins with another is kept as long as that one is.
    const bool mayStay =
        scene && settings.goOn && std::ranges::all_of(run.after, [&](std::size_t k) { return kept[k]; });
    const Earlier earlier = mayStay ? earlierOf(folder, run, *scene, rows) : Earlier{};
    kept.push_back(earlier.figures.has_value());
    const auto work = [=, &settings] {
      if (earlier.figures) return *earlier.figures;
      std::optional<InputError> late = refusal;
      const std::optional<scene::Scene> now =
          scene || late ? scene : sceneOf(settings, run.scene, all, !run.prepares, late);
      if (late) throw InputError(*late);
      if (settings.needsSeries() && !run.prepares && !run.after.empty()) requireColumns(*now, settings);
      return runCase(*now, folder, settings, !run.prepares, earlier.resumes);
    };
    study.cases.push_back({run.label(), values, work, run.way, pointOf(settings, run), sizeOf(run, settings.size),
                           seriesOf(run, settings.size), run.after});
  }
  if (checked.empty()) throw InputError(*first);
  return study;
}

void prepareFolders(const report::Study& study, const StudySettings& settings, const std::vector<std::string>& more) {
  const std::size_t runs = settings.act ? 0 : study.cases.size();
  for (std::size_t k = 0; !settings.replace && !settings.goOn && k < runs; ++k) io::requireNoRun(folderOf(settings, k));
  std::vector<std::string> files = report::filesOf(study);
  files.insert(files.end(), more.begin(), more.end());
  io::prepareOutputFolder(study.folder, files);
  for (std::size_t k = 0; k < runs; ++k) io::prepareInnerFolder(folderOf(settings, k), {"log.txt"});
}

}  // namespace dovetail::program
