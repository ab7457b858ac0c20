#include "energy_study.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <optional>

#include "dovetail/io/output_folder.hpp"
#include "dovetail/report/page.hpp"
#include "dovetail/report/summary.hpp"
#include "dovetail/report/text.hpp"

namespace dovetail::program {

namespace {

namespace fs = std::filesystem;
using report::format, report::Json;

/// A run of the study that finished.
struct Run {
  std::string label;
  io::KeyValues settings;
  Json figures;
  io::TimeSeries series;
  double dt = 0.0;  // s
  std::optional<double> order;
};

/// Columns of the channels of energy, "…_J".
std::vector<std::size_t> channelsOf(const io::TimeSeries& series) {
  std::vector<std::size_t> columns;
  for (std::size_t c = 0; c < series.names().size(); ++c) {
    const std::string& name = series.names()[c];
    if (io::unitOf(name) == "J" && name != "residual_J") columns.push_back(c);
  }
  return columns;
}

double largestMagnitude(std::span<const double> values) {
  double largest = 0.0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

double changedHands(const io::TimeSeries& series) {
  const std::vector<std::size_t> channels = channelsOf(series);
  double most = 0.0;
  for (std::size_t row = 0; row < series.rows(); ++row) {
    double sum = 0.0;
    for (const std::size_t c : channels) sum += 0.5 * std::abs(series.column(c)[row] - series.column(c)[0]);
    most = std::max(most, sum);
  }
  return most;
}

double growthOf(std::span<const double> residual) {
  const double half = largestMagnitude(residual.first((residual.size() + 1) / 2)), all = largestMagnitude(residual);
  return half > 0.0 ? std::log2(all / half) : std::nan("");
}

double numberIn(const Json& row, const char* key) {
  return row.contains(key) && row[key].is_number() ? row[key].get<double>() : std::nan("");
}

Json readJson(const fs::path& path) {
  std::ifstream file = openFile(path);
  return Json::parse(file);
}

std::vector<Run> readRuns(const fs::path& folder) {
  std::vector<Run> runs;
  const Json study = readJson(folder / "study.json");
  for (const Json& row : study["runs"]) {
    if (row["outcome"] != "finished") continue;
    Run run{.label = row["label"], .settings = {}, .figures = row, .series = io::TimeSeries({"time_s"}), .order = {}};
    fs::path place = folder;
    for (const auto& [key, value] : row["settings"].items()) {
      if (key == "folder")
        place /= value.get<std::string>();
      else
        run.settings.emplace_back(key, value);
    }
    run.series = io::readCsv(place / "series.csv");
    run.dt = report::readSummary(place / "summary.json")["step"]["dt_s"];
    runs.push_back(std::move(run));
  }
  return runs;
}

/// Whether two runs differ in one setting at most.
bool differInOne(const Run& a, const Run& b) {
  int others = 0;
  for (std::size_t k = 0; k < a.settings.size(); ++k) others += a.settings[k] != b.settings[k];
  return others <= 1;
}

/// The run with the next larger step that differs in one setting alone.
const Run* coarser(const std::vector<Run>& runs, const Run& run) {
  const Run* found = nullptr;
  for (const Run& other : runs)
    if (other.dt > 1.01 * run.dt && differInOne(other, run) && (!found || other.dt < found->dt)) found = &other;
  return found;
}

void findOrders(std::vector<Run>& runs) {
  for (Run& run : runs) {
    const Run* const other = coarser(runs, run);
    if (!other) continue;
    const double ratio =
        numberIn(other->figures, "largest_residual_fraction") / numberIn(run.figures, "largest_residual_fraction");
    run.order = std::log(ratio) / std::log(other->dt / run.dt);
  }
}

report::Table tableOf(const std::vector<Run>& runs) {
  report::Table table{
      {"run", "step (s)", "steps", "largest residual (J)", "over exchanged energy", "order", "growth", "seconds"}, {}};
  const auto text = [](double value, const char* pattern = "%.3g") {
    char line[64];
    std::snprintf(line, sizeof line, pattern, value);
    return std::isfinite(value) ? std::string(line) : std::string();
  };
  for (const Run& run : runs) {
    const double time = run.series.column("time_s").back();
    table.rows.push_back(
        {run.label, text(run.dt), text(std::round(time / run.dt), "%.0f"),
         text(numberIn(run.figures, "largest_residual_J")), text(numberIn(run.figures, "largest_residual_fraction")),
         run.order ? text(*run.order, "%.2f") : "", text(numberIn(run.figures, "residual_growth"), "%.2f"),
         text(numberIn(run.figures, "wall_seconds"))});
  }
  return table;
}

report::Figure againstStep(const std::vector<Run>& runs) {
  report::Curve curve{"runs", {}, {}, false, true};
  for (const Run& run : runs) {
    curve.x.push_back(run.dt);
    curve.y.push_back(numberIn(run.figures, "largest_residual_fraction"));
  }
  return {"energy_step", "Residual against step", {"step (s)", true}, {"over exchanged energy", true}, {curve}, {}};
}

/// Of so many runs at most: more curves cannot be told apart.
report::Figure againstTime(const std::vector<Run>& runs) {
  constexpr std::size_t most = 8;
  report::Figure figure{
      "energy_time", "Residual over time", {"time (s)", false}, {"over exchanged energy", true}, {}, {}};
  for (std::size_t k = 0; k < std::min(most, runs.size()); ++k) {
    const io::TimeSeries& series = runs[k].series;
    const double scale = numberIn(runs[k].figures, "changed_hands_J");
    report::Curve curve{runs[k].label, {}, {}};
    double largest = 0.0;
    for (std::size_t row = 0; row < series.rows(); ++row) {
      largest = std::max(largest, std::abs(series.column("residual_J")[row]) / scale);
      curve.x.push_back(series.column("time_s")[row]);
      curve.y.push_back(largest);
    }
    figure.curves.push_back(std::move(curve));
  }
  return figure;
}

/// What every channel has gained from the start to the end, by run; channels that gain nothing in all are left out.
report::Table channelTable(const std::vector<Run>& runs) {
  report::Table table{{"gained by the end (J)"}, {}};
  for (const Run& run : runs) table.head.push_back(run.label);
  for (const std::size_t c : channelsOf(runs.front().series)) {
    const std::string& name = runs.front().series.names()[c];
    table.rows.push_back({name});
    bool gains = false;
    for (const Run& run : runs) {
      const auto& names = run.series.names();
      const bool has = std::find(names.begin(), names.end(), name) != names.end();
      const double gained = has ? run.series.column(name).back() - run.series.column(name).front() : 0.0;
      table.rows.back().push_back(has ? format("%.4g", gained) : "");
      gains = gains || gained != 0.0;
    }
    if (!gains) table.rows.pop_back();
  }
  return table;
}

}  // namespace

Json energyFigures(const io::TimeSeries& series) {
  const double residual = largestMagnitude(series.column("residual_J")), changed = changedHands(series);
  return {{"largest_residual_J", residual},
          {"changed_hands_J", changed},
          {"largest_residual_fraction", report::numberOrNull(changed > 0.0 ? residual / changed : std::nan(""))},
          {"residual_growth", report::numberOrNull(growthOf(series.column("residual_J")))}};
}

std::vector<std::string> energyStudyFiles() { return {"energy.html", "energy.csv"}; }

void writeEnergyStudy(const fs::path& folder) {
  std::vector<Run> runs = readRuns(folder);
  if (runs.empty()) return;
  findOrders(runs);
  const report::Page page{
      "Energy balance of a study",
      {{"Runs",
        {report::Paragraph{
             "Residual: energy that no channel accounts for, the largest of the run. Order: of the residual over "
             "exchanged energy, against the run with the next larger step and all else equal. Growth: exponent of the "
             "largest residual over time: 0 bounded, 0.5 a random walk, 1 a drift."},
         tableOf(runs), againstStep(runs), againstTime(runs)}},
       {"Channels", {channelTable(runs)}}}};
  const io::KeyValues provenance = io::provenance();
  std::vector<Json> rows;
  for (const Run& run : runs) {
    Json row{{"label", run.label}, {"dt_s", run.dt}, {"order", run.order ? Json(*run.order) : Json(nullptr)}};
    for (const char* key :
         {"largest_residual_J", "changed_hands_J", "largest_residual_fraction", "residual_growth", "wall_seconds"})
      row[key] = run.figures.contains(key) ? run.figures[key] : Json(nullptr);
    row["settings"] = report::objectOf(run.settings);
    rows.push_back(std::move(row));
  }
  io::writeFileAtomically(folder / "energy.csv", report::csvOf(rows, provenance));
  io::writeFileAtomically(folder / "energy.html", report::htmlOf(page, provenance.front().second));
}

}  // namespace dovetail::program
