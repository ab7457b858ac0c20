#include "study_errors.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "dovetail/core/error.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/time_series.hpp"
#include "dovetail/report/text.hpp"

namespace dovetail::program {

namespace {

namespace fs = std::filesystem;
using report::Json;

bool hasColumn(const io::TimeSeries& series, const std::string& name) {
  return std::ranges::find(series.names(), name) != series.names().end();
}

fs::path seriesOf(const StudySettings& settings, std::size_t run) { return folderOf(settings, run) / "series.csv"; }

bool isReference(const StudySettings& settings, const StudyRun& run) {
  const auto& against = settings.against;
  return against && !against->way.empty() && run.way == against->way && run.point == against->point;
}

/// The repeats of the reference among the runs, ascending.
std::vector<std::size_t> references(const StudySettings& settings, const std::vector<StudyRun>& runs) {
  std::vector<std::size_t> found;
  for (std::size_t k = 0; k < runs.size(); ++k)
    if (isReference(settings, runs[k])) found.push_back(k);
  return found;
}

bool finished(const Json& row) { return !row.is_null() && row["outcome"] == "finished"; }

/// The reference of a run; nothing as long as it is not there, and for itself.
std::optional<fs::path> referenceOf(const StudySettings& settings, const std::vector<StudyRun>& runs,
                                    const std::vector<Json>& rows, std::size_t run) {
  if (settings.against->way.empty()) return settings.against->file;
  for (const std::size_t k : references(settings, runs))
    if (k != run && runs[k].repeat == runs[run].repeat && finished(rows[k])) return seriesOf(settings, k);
  return {};
}

double meanSquareRoot(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

void addDistance(const StudySettings& settings, const fs::path& reference, std::size_t run, Json& row) {
  const Against& against = *settings.against;
  std::vector<double> errors;
  double covered = 1.0;
  for (const std::string& column : settings.error) {
    const report::CurveError found =
        report::distanceFrom(curveIn(reference, against.along, column, true),
                             curveIn(seriesOf(settings, run), against.along, column, false), against.norm);
    errors.push_back(found.value);
    covered = std::min(covered, found.covered);
  }
  row["error"] = errors.size() == 1 ? errors.front() : meanSquareRoot(errors);
  row["covered"] = covered;
  for (std::size_t c = 0; errors.size() > 1 && c < errors.size(); ++c) row["error_" + settings.error[c]] = errors[c];
}

Json scatterOf(const StudySettings& settings, const std::vector<StudyRun>& runs, const std::vector<Json>& rows) {
  const std::vector<std::size_t> repeats = references(settings, runs);
  if (repeats.size() < 2 || !std::ranges::all_of(repeats, [&](std::size_t k) { return finished(rows[k]); }))
    return Json::object();
  std::vector<double> distances;
  for (const std::string& column : settings.error) {
    std::vector<report::Curve> curves;
    for (const std::size_t k : repeats)
      curves.push_back(curveIn(seriesOf(settings, k), settings.against->along, column, true));
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
void drawCurves(const StudySettings& settings, const std::vector<StudyRun>& runs, const std::string& y) {
  const std::string& x = settings.against->along;
  report::Figure figure{"curves", y + " along " + x, {x, false}, {y, false}, {}, {}};
  const auto add = [&](const fs::path& file, const std::string& name, bool isReference) {
    if (!fs::exists(file) || figure.curves.size() > shownCurves) return;
    figure.curves.push_back(curveIn(file, x, y, isReference));
    figure.curves.back().name = name;
  };
  const std::vector<std::size_t> repeats = references(settings, runs);
  add(repeats.empty() ? fs::path(settings.against->file) : seriesOf(settings, repeats.front()), "reference", true);
  for (std::size_t k = 0; k < runs.size(); ++k)
    if (!isReference(settings, runs[k]) && !runs[k].prepares && runs[k].repeat == runs.front().repeat)
      add(seriesOf(settings, k), runs[k].label(), false);
  io::writeFileAtomically(settings.folder / curveFile(settings, y),
                          "<!-- " + io::provenance().front().second + " -->\n" + report::svgFileOf(figure));
}

}  // namespace

report::Json addErrors(const StudySettings& settings, const std::vector<StudyRun>& runs, std::vector<Json>& rows) {
  for (std::size_t k = 0; k < rows.size(); ++k) {
    Json& row = rows[k];
    if (!finished(row) || row.contains("error") || runs[k].prepares) continue;
    try {
      if (settings.exact)
        row["error"] = row[settings.error.front()].get<double>() - *settings.exact;
      else if (const auto reference = referenceOf(settings, runs, rows, k))
        addDistance(settings, *reference, k, row);
    } catch (const InputError& error) {
      row["error"] = nullptr;
      row["message"] = error.what();
    }
  }
  return settings.against ? scatterOf(settings, runs, rows) : Json::object();
}

std::vector<std::string> curveFiles(const StudySettings& settings) {
  std::vector<std::string> files;
  for (const std::string& column : settings.error)
    if (settings.against) files.push_back(curveFile(settings, column));
  return files;
}

void drawCurves(const StudySettings& settings) {
  const std::vector<StudyRun> runs = runsOf(settings);
  for (const std::string& column : settings.error) drawCurves(settings, runs, column);
}

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

}  // namespace dovetail::program
