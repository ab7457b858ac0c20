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
#include "study_plan.hpp"
#include "verbs.hpp"

namespace dovetail::program {

namespace {

namespace fs = std::filesystem;

/// The plan, and how it is carried out.
struct Settings : StudyPlan {
  std::string out;
  int workers = threads();
  bool energy = false, replace = false;

  bool hasError() const { return exact || against; }
};

/// What a series ends with, by column, and what became of the energy.
void addSeries(const fs::path& file, report::Json& figures) {
  const io::TimeSeries series = io::readCsv(file);
  if (series.rows() == 0) return;
  figures.update(energyFigures(series));
  for (std::size_t c = 0; c < series.names().size(); ++c)
    figures[series.names()[c]] = report::numberOrNull(series.column(c).back());
}

constexpr const char* ownError = "largest_residual_J";

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

/// The columns of these names; of a reference with two columns of other names, these two.
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
  if (const auto& against = settings.against) {
    const report::CurveError found =
        report::distanceFrom(curveIn(against->file, against->along, settings.error, true),
                             curveIn(folder / "series.csv", against->along, settings.error, false), against->norm);
    figures["error"] = found.value;
    figures["covered"] = found.covered;
  }
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

/// Runs that the figure of curves shows.
constexpr std::size_t shownCurves = 11;

/// The column of the runs beside the reference.
void drawCurves(const report::Study& study, const Settings& settings) {
  const std::string &x = settings.against->along, &y = settings.error;
  report::Figure figure{"curves", y + " along " + x, {x, false}, {y, false}, {}, {}};
  figure.curves.push_back(curveIn(settings.against->file, x, y, true));
  figure.curves.back().name = "reference";
  for (std::size_t k = 0; k < study.cases.size() && figure.curves.size() <= shownCurves; ++k) {
    const fs::path file = study.folder / report::format("%03zu", k + 1) / "series.csv";
    if (!fs::exists(file)) continue;
    figure.curves.push_back(curveIn(file, x, y, false));
    figure.curves.back().name = study.cases[k].label;
  }
  io::writeFileAtomically(study.folder / "curves.svg",
                          "<!-- " + io::provenance().front().second + " -->\n" + report::svgFileOf(figure));
}

std::vector<std::string> shownFigures(const Settings& settings) {
  std::vector<std::string> shown = settings.columns;
  if (std::ranges::find(shown, settings.error) == shown.end()) shown.push_back(settings.error);
  if (settings.hasError()) shown.emplace_back("error");
  if (settings.against) shown.emplace_back("covered");
  return shown;
}

void requireColumns(const scene::Scene& scene, const Settings& settings) {
  requireColumn(scene, settings.error, "--error");
  for (const std::string& column : settings.columns) requireColumn(scene, column, "--show");
  if (settings.against) requireColumn(scene, settings.against->along, "--along");
}

/// A scene that a value makes impossible is a row that says why; what makes all of them so is refused before anything
/// is run.
report::Study planOf(const Settings& settings, const std::string& file) {
  report::Study study;
  study.program = "dovetail";
  study.name = "study";
  study.folder = settings.out.empty() ? fs::path(file).stem().string() + "-study" : settings.out;
  study.workers = settings.workers;
  study.fronts = {{settings.hasError() ? "error" : settings.error, "on_front"}};
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
    const fs::path folder = study.folder / report::format("%03zu", study.cases.size() + 1);
    values.emplace_back("folder", folder.filename().string());
    std::optional<InputError> refusal;
    const std::optional<scene::Scene> scene = sceneOf(settings, all, refusal);
    if (scene && !anyRuns) requireColumns(*scene, settings);
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

/// Names of files that the study writes into its own folder.
std::vector<std::string> filesOf(const report::Study& study, const Settings& settings) {
  std::vector<std::string> files = report::filesOf(study);
  if (settings.energy) std::ranges::copy(energyStudyFiles(), std::back_inserter(files));
  if (settings.against) files.emplace_back("curves.svg");
  return files;
}

/// The command line as it was written.
struct Written {
  std::string file, error, against, along;
  report::Norm norm = report::Norm::mean;
  std::optional<double> exact;
  std::vector<std::string> over, set, show;
};

/// What the file plans, where it is a study, and over it what was written.
void plan(const Written& written, const Options& options, Settings& settings) {
  if (isStudy(written.file))
    static_cast<StudyPlan&>(settings) = readStudy(written.file);
  else
    settings.scene = written.file;
  for (const std::string& text : written.set) settings.set.push_back(settingFrom(text));
  if (!written.over.empty()) settings.over.clear();
  for (const std::string& text : written.over) settings.over.push_back(axisFrom(text, "--over " + text));
  if (settings.over.empty())
    throw InputError("there is nothing to vary", "dovetail study", "give --over KEY=A,B,C, or the file of a study");
  if (!written.show.empty()) settings.columns = written.show;
  if (!written.error.empty()) settings.error = written.error;
  if (written.exact || !written.against.empty()) settings.exact = written.exact, settings.against.reset();
  if (!written.against.empty()) settings.against = Against{fs::absolute(written.against).string()};
  if (settings.exact && settings.against)
    throw InputError("there are two references, \"exact\" and \"against\"", written.file, "leave out one of them");
  if (!settings.against)
    options.refuseIdle("--along --norm", "without a reference curve", "add --against FILE");
  else if (settings.error.empty())
    throw InputError("the reference has no column to be compared with", settings.against->file, "add --error COLUMN");
  if (!written.along.empty()) settings.against->along = written.along;
  if (options.given("--norm")) settings.against->norm = written.norm;
  if (settings.error.empty()) settings.error = ownError;
  if (settings.against)  // refused before anything is run
    curveIn(settings.against->file, settings.against->along, settings.error, true);
}

}  // namespace

bool studyScene(int argc, char** argv) {
  Settings settings;
  Written written;
  bool keys = false;
  Options options("dovetail study",
                  "Runs a scene with every combination of values; writes study.csv, .json, .md and .svg.");
  options.text("FILE", written.file, "scene (JSON), or study: a file with scene, axes and error");
  options.texts("--over KEY=A,B,C", written.over, "values of a parameter of \"let\", or at a path such as steps.dt");
  options.texts("--set KEY=VALUE", written.set, "the same for all runs");
  options.texts("--show COLUMN", written.show, "of the series, shown in the tables at the end of the run");
  options.text("--error COLUMN", written.error,
               "of the series: its magnitude at the end is the error; default: the largest residual");
  options.number("--exact VALUE", written.exact, {-1e300, 1e300, true, true, "a number"},
                 "exact value of the column: the error is the difference from it");
  options.text("--against FILE", written.against,
               "CSV file with a curve of the column, such as series.csv of a finer run: the error is the distance "
               "from it; draws curves.svg");
  options.text("--along COLUMN", written.along, "of x of that curve; default: time_s");
  options.choice("--norm", written.norm, normWords, "of the difference from that curve");
  options.flag("--energy", settings.energy,
               "writes energy.html and .csv too: residual of the energy, its order in the step, growth and channels");
  options.integer("--workers N", settings.workers, 1, 1024, "processes at once; default: one for each processor");
  options.flag("--replace", settings.replace, "replaces an earlier study in the folder");
  options.text("--out DIR", settings.out, "folder; <file>-study if not given");
  options.flag("--keys", keys, "prints a reference of the keys of studies");
  if (!options.parse(argc, argv)) return true;
  if (keys) return std::cout << studyReference(), true;
  if (written.file.empty()) throw InputError("FILE is missing", "dovetail study", "name a scene or a study");
  options.refuseBoth("--exact", "--against");
  plan(written, options, settings);
  report::Study study = planOf(settings, written.file);
  study.about["settings"] = report::objectOf(options.described());
  const auto folderOf = [&](std::size_t k) { return study.folder / report::format("%03zu", k + 1); };
  for (std::size_t k = 0; !settings.replace && k < study.cases.size(); ++k) io::requireNoRun(folderOf(k));
  io::prepareOutputFolder(study.folder, filesOf(study, settings));
  for (std::size_t k = 0; k < study.cases.size(); ++k) io::prepareInnerFolder(folderOf(k), {"log.txt"});
  if (!report::runStudy(study, std::cout, std::cerr)) return false;
  if (settings.energy) writeEnergyStudy(study.folder);
  if (settings.against) drawCurves(study, settings);
  std::cout << "tables and figure in " << study.folder.string() << '\n';
  return true;
}

}  // namespace dovetail::program
