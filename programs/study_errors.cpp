#include "study_errors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <span>

#include "dovetail/core/error.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/plain_text.hpp"
#include "dovetail/io/time_series.hpp"
#include "dovetail/report/text.hpp"

namespace dovetail::program {

namespace {

namespace fs = std::filesystem;
using report::Json;

bool hasColumn(const io::TimeSeries& series, const std::string& name) {
  return std::ranges::find(series.names(), name) != series.names().end();
}

void requireColumns(const io::TimeSeries& series, const fs::path& file, const std::vector<std::string>& names,
                    const std::string& remedy) {
  for (const std::string& name : names)
    if (!hasColumn(series, name)) throw InputError("there is no column " + name, file.string(), remedy);
}

report::Curve curveOf(const fs::path& file, std::span<const double> x, std::span<const double> y) {
  return {file.string(), {x.begin(), x.end()}, {y.begin(), y.end()}};
}

/// When a stage of a finished run began, and the next; s.
std::array<double, 2> timesOf(const fs::path& folder, std::int64_t stage) {
  const Json summary = Json::parse(io::readWhole(folder / "summary.json", "summary"), nullptr, false);
  const Json stages =
      summary.is_object() ? summary.value("times", Json::object()).value("stages", Json::array()) : Json();
  if (!stages.is_array() || std::ranges::any_of(stages, [](const Json& one) { return !one.contains("begins_s"); }))
    throw InputError("its summary does not say when stages began", folder.string(), "run it anew");
  const auto count = static_cast<std::int64_t>(stages.size()), number = stage > 0 ? stage - 1 : count + stage;
  if (number < 0 || number >= count)
    throw InputError("the run has " + std::to_string(count) + " stages", folder.string(),
                     "correct against.stage, which is " + std::to_string(stage));
  const auto begins = [&](std::int64_t k) { return stages[static_cast<std::size_t>(k)].at("begins_s").get<double>(); };
  return {begins(number), number + 1 < count ? begins(number + 1) : std::numeric_limits<double>::infinity()};
}

/// Of a run of the study.
report::Curve curveOfRun(const StudySettings& settings, std::size_t run, const std::string& column) {
  const Against& against = *settings.against;
  const fs::path folder = folderOf(settings, run), file = folder / "series.csv";
  const io::TimeSeries series = io::readCsv(file);
  requireColumns(series, file, {against.along, column}, "correct its name");
  report::Curve whole = curveOf(file, series.column(against.along), series.column(column));
  if (against.stage == 0) return whole;
  const auto [begin, end] = timesOf(folder, against.stage);
  const auto time = series.column("time_s");
  report::Curve curve{whole.name, {}, {}};
  for (std::size_t k = 0; k < whole.x.size(); ++k)
    if (time[k] >= begin && time[k] <= end) {
      curve.x.push_back(against.along == "time_s" ? whole.x[k] - begin : whole.x[k]);
      curve.y.push_back(whole.y[k]);
    }
  return curve;
}

bool isReference(const StudySettings& settings, const StudyRun& run) {
  const auto& against = settings.against;
  return against && !against->way.empty() && run.way == against->way && isAt(run, against->point);
}

/// Runs that others are held to, ascending: of one point its repeats, or of several.
std::vector<std::size_t> references(const StudySettings& settings, const std::vector<StudyRun>& runs) {
  std::vector<std::size_t> found;
  for (std::size_t k = 0; k < runs.size(); ++k)
    if (isReference(settings, runs[k])) found.push_back(k);
  return found;
}

bool finished(const Json& row) { return !row.is_null() && row["outcome"] == "finished"; }

/// The curve that a run is held to, by column.
using Reference = std::function<report::Curve(const std::string& column)>;

Reference fileOf(const StudySettings& settings) {
  return [&](const std::string& column) { return curveOfFile(settings.against->file, *settings.against, column); };
}
Reference runOf(const StudySettings& settings, std::size_t run) {
  return [&settings, run](const std::string& column) { return curveOfRun(settings, run, column); };
}

/// Empty as long as the reference is not there, and for itself. @throws InputError if it did not finish
Reference referenceOf(const StudySettings& settings, const std::vector<StudyRun>& runs, const std::vector<Json>& rows,
                      std::size_t run) {
  if (settings.against->way.empty()) return fileOf(settings);
  for (const std::size_t k : references(settings, runs)) {
    if (k == run || !areBeside(runs[k], runs[run], settings.against->point) || rows[k].is_null()) continue;
    if (finished(rows[k])) return runOf(settings, k);
    throw InputError("its reference, \"" + runs[k].label() + "\", did not finish", "", "see the row of that run");
  }
  return {};
}

double meanSquareRoot(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

void addDistance(const StudySettings& settings, const Reference& reference, std::size_t run, Json& row) {
  std::vector<double> errors;
  double covered = 1.0;
  for (const std::string& column : settings.error) {
    const report::CurveError found =
        report::distanceFrom(reference(column), curveOfRun(settings, run, column), settings.against->norm);
    errors.push_back(found.value);
    covered = std::min(covered, found.covered);
  }
  row["error"] = errors.size() == 1 ? errors.front() : meanSquareRoot(errors);
  row["covered"] = covered;
  for (std::size_t c = 0; errors.size() > 1 && c < errors.size(); ++c) row["error_" + settings.error[c]] = errors[c];
}

Json scatterOf(const StudySettings& settings, const std::vector<StudyRun>& runs, const std::vector<Json>& rows) {
  const std::vector<std::size_t> repeats = references(settings, runs);
  const bool onePoint =
      std::ranges::all_of(repeats, [&](std::size_t k) { return runs[k].point == runs[repeats[0]].point; });
  if (repeats.size() < 2 || !onePoint ||
      !std::ranges::all_of(repeats, [&](std::size_t k) { return finished(rows[k]); }))
    return Json::object();
  std::vector<double> distances;
  for (const std::string& column : settings.error) {
    std::vector<report::Curve> curves;
    for (const std::size_t k : repeats) curves.push_back(curveOfRun(settings, k, column));
    const report::Curve mean = report::meanOf(curves);
    for (const report::Curve& curve : curves)
      distances.push_back(report::distanceFrom(mean, curve, settings.against->norm).value);
  }
  return {{"scatter", meanSquareRoot(distances)}};
}

std::string curveFile(const StudySettings& settings, const std::string& column) {
  return settings.error.size() == 1 ? "curves.svg" : "curves_" + column + ".svg";
}

/// Runs that the figure of curves shows.
constexpr std::size_t shownCurves = 11;

/// The first of the repeats stands for all.
void drawCurves(const StudySettings& settings, const std::vector<StudyRun>& runs, const std::vector<Json>& rows,
                const std::string& y) {
  const std::string& x = settings.against->along;
  const auto isCompared = [](const Json& row) { return row.contains("error") && row["error"].is_number(); };
  if (std::ranges::none_of(rows, isCompared)) return;
  report::Figure figure{"curves", y + " along " + x, {x, false}, {y, false}, {}, {}};
  const auto add = [&](report::Curve curve, const std::string& name) {
    figure.curves.push_back(std::move(curve));
    figure.curves.back().name = name;
  };
  std::vector<std::size_t> drawn = references(settings, runs);
  if (drawn.empty()) add(curveOfFile(settings.against->file, *settings.against, y), "reference");
  std::erase_if(drawn, [&](std::size_t k) { return runs[k].repeat != runs.front().repeat; });
  for (const std::size_t k : drawn)
    if (finished(rows[k])) add(curveOfRun(settings, k, y), drawn.size() == 1 ? "reference" : runs[k].label());
  for (std::size_t k = 0; k < runs.size() && figure.curves.size() <= shownCurves; ++k)
    if (isCompared(rows[k]) && runs[k].repeat == runs.front().repeat) add(curveOfRun(settings, k, y), runs[k].label());
  io::writeFileAtomically(settings.folder / curveFile(settings, y),
                          "<!-- " + io::provenance().front().second + " -->\n" + report::svgFileOf(figure));
}

}  // namespace

report::Json addErrors(const StudySettings& settings, const std::vector<StudyRun>& runs, std::vector<Json>& rows) {
  for (std::size_t k = 0; k < rows.size(); ++k) {
    Json& row = rows[k];
    if (!finished(row) || row.contains("error") || runs[k].prepares) continue;
    try {
      if (settings.exact && !row[settings.error.front()].is_number())
        throw InputError("the figure is no number", settings.error.front(), "take another column");
      if (settings.exact)
        row["error"] = row[settings.error.front()].get<double>() - *settings.exact;
      else if (const Reference reference = referenceOf(settings, runs, rows, k))
        addDistance(settings, reference, k, row);
    } catch (const InputError& error) {
      row["error"] = nullptr;
      row["message"] = error.what();
    }
  }
  if (!settings.against) return Json::object();
  try {
    return scatterOf(settings, runs, rows);
  } catch (const InputError& error) {
    return {{"scatter_message", error.what()}};
  }
}

std::vector<std::string> curveFiles(const StudySettings& settings) {
  std::vector<std::string> files;
  for (const std::string& column : settings.error)
    if (settings.against) files.push_back(curveFile(settings, column));
  return files;
}

void drawCurves(const StudySettings& settings) {
  const std::vector<StudyRun> runs = runsOf(settings);
  const std::vector<Json> rows = Json::parse(io::readWhole(settings.folder / "study.json", "study")).at("runs");
  for (const std::string& column : settings.error) drawCurves(settings, runs, rows, column);
}

report::Curve curveOfFile(const fs::path& file, const Against& against, const std::string& column) {
  const io::TimeSeries series = io::readCsv(file);
  const bool named = hasColumn(series, against.along) && hasColumn(series, column);
  if (series.names().size() == 2 && !named)
    return curveOf(file, series.column(std::size_t{0}), series.column(std::size_t{1}));
  requireColumns(series, file, {against.along, column}, "name its columns as in series.csv, or give two: x and y");
  return curveOf(file, series.column(against.along), series.column(column));
}

}  // namespace dovetail::program
