#include "study.hpp"

#include <cstdio>
#include <nlohmann/json.hpp>
#include <span>
#include <sstream>

#include "common/text.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/progress.hpp"
#include "dovetail/io/interruption.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/provenance.hpp"
#include "published.hpp"
#include "summary.hpp"

namespace dovetail::cantilever {

namespace {

const char* nameOf(Study study) {
  switch (study) {
    case Study::widths:
      return "widths";
    case Study::pareto:
      return "pareto";
    case Study::stability:
      return "stability";
    case Study::ablation:
      return "ablation";
    case Study::none:
      break;
  }
  return "none";
}

std::vector<StudyRow> planOf(const Settings& settings) {
  switch (settings.study) {
    case Study::widths:
      return widthsPlan(settings);
    case Study::pareto:
      return paretoPlan(settings);
    case Study::stability:
      return stabilityPlan(settings);
    case Study::ablation:
      return ablationPlan(settings);
    case Study::none:
      break;
  }
  return {};
}

void runRow(StudyRow& row) {
  try {
    RunResult result = run(row.settings);
    compareWithReferences(result);
    row.figures = result.figures;
    row.outcome = result.figures.finished ? (result.figures.stable ? "finished" : "not stable") : "broke down";
    row.message = result.figures.failure;
    for (const auto& channel : result.ledger.channels()) {
      if (channel.name.starts_with("dashpots")) row.lostToDashpots = channel.joules;
      if (channel.name.starts_with("coupling")) row.madeByCoupling = -channel.joules;
    }
  } catch (const InputError& error) {
    row.outcome = "refused";
    row.message = error.what();
  }
}

/// Marks rows that no other row beats in both wall time and `measure`.
template <class Measure, class Mark>
void markFront(std::span<StudyRow> rows, Measure measure, Mark mark) {
  for (StudyRow& row : rows) {
    if (row.outcome != "finished") continue;
    bool beaten = false;
    for (const StudyRow& other : rows)
      beaten = beaten || (other.outcome == "finished" && other.figures.wallSeconds < row.figures.wallSeconds &&
                          measure(other) < measure(row));
    mark(row, !beaten);
  }
}

using benchmark::quoted;

void markFronts(std::span<StudyRow> rows) {
  markFront(
      rows, [](const StudyRow& r) { return r.figures.errorDynamic; },
      [](StudyRow& r, bool on) { r.onErrorFront = on; });
  markFront(
      rows, [](const StudyRow& r) { return r.figures.energyDrift; }, [](StudyRow& r, bool on) { r.onDriftFront = on; });
}

void printRow(const StudyRow& row) {
  const RunFigures& f = row.figures;
  std::printf("%-58s %-10s", row.label.c_str(), row.outcome.c_str());
  if (row.outcome == "refused") {
    std::printf(" %s\n", row.message.c_str());
    return;
  }
  std::printf(" %8.3f s  drift %9.2e  E %9.3g ... %9.3g J", f.wallSeconds, f.energyDrift, f.energyMin, f.energyMax);
  if (f.left)
    std::printf("  leaves %7.3f s  error %8.3f mm static (%.3f mm in z) %8.3f mm dynamic", f.leaveTime,
                1e3 * f.errorStatic, 1e3 * f.errorStaticVertical, 1e3 * f.errorDynamic);
  if (!row.message.empty()) std::printf("  %s", row.message.c_str());
  std::printf("\n");
  std::fflush(stdout);
}

void writeStudy(const std::string& folder, const std::string& name, std::span<const StudyRow> rows) {
  std::ostringstream csv;
  csv << io::provenanceLines(io::provenance(), "# ");
  csv << "label,outcome,message,wall_seconds,steps,dt_s,leave_time_s,energy_initial_J,energy_min_J,energy_max_J,"
         "energy_drift_relative,ledger_residual_relative,made_by_coupling_J,dashpots_J,lateral_drift_m,"
         "moment_residual_relative,no_contact_share,time_mean_error_m,time_mean_error_vertical_m,time_mean_error_"
         "authors_arm_m,"
         "time_mean_error_dynamic_m,time_mean_error_dynamic_same_time_m,on_error_front,on_drift_front";
  for (const auto& [key, value] : describe(Settings{})) csv << ',' << key;
  csv << '\n';
  nlohmann::ordered_json json;
  json["study"] = name;
  for (const auto& [key, value] : io::provenance())
    json["provenance"][key] = value;  // early: it marks the file as ours
  json["published_code"] = {{"seconds_per_step", publishedSecondsPerStep}, {"dt_factor", publishedDtFactor}};
  for (const StudyRow& row : rows) {
    const RunFigures& f = row.figures;
    csv << quoted(row.label) << ',' << row.outcome << ',' << quoted(row.message);
    for (double value : {f.wallSeconds, static_cast<double>(f.steps), f.dt, f.leaveTime, f.energyInitial, f.energyMin,
                         f.energyMax, f.energyDrift, f.ledgerResidual, row.madeByCoupling, row.lostToDashpots,
                         f.lateralDrift, f.momentResidual, f.noContactShare, f.errorStatic, f.errorStaticVertical,
                         f.errorStaticAuthors, f.errorDynamic, f.errorDynamicSameTime})
      csv << ',' << formatNumber(value);
    csv << ',' << row.onErrorFront << ',' << row.onDriftFront;
    nlohmann::ordered_json entry = figuresAsJson(f);
    entry["label"] = row.label;
    entry["outcome"] = row.outcome;
    entry["message"] = row.message;
    entry["made_by_coupling_J"] = row.madeByCoupling;
    entry["dashpots_J"] = row.lostToDashpots;
    entry["on_error_front"] = row.onErrorFront;
    entry["on_drift_front"] = row.onDriftFront;
    for (const auto& [key, value] : describe(row.settings)) {
      csv << ',' << quoted(value);
      entry["settings"][key] = value;
    }
    csv << '\n';
    json["runs"].push_back(entry);
  }
  const std::filesystem::path where = folder.empty() ? "." : folder;
  io::writeFileAtomically(where / (name + ".csv"), csv.str());
  io::writeFileAtomically(where / (name + ".json"), json.dump(2) + "\n");
}

}  // namespace

bool runStudy(const Settings& settings) {
  const std::string name = nameOf(settings.study);
  const std::string folder = settings.out.empty() ? "." : settings.out;
  io::prepareOutputFolder(folder, {name + ".csv", name + ".json"});
  std::vector<StudyRow> rows = planOf(settings);
  Progress progress("study " + name, static_cast<double>(rows.size()), !settings.quiet);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].settings.quiet = true;
    rows[i].settings.out.clear();
    progress.update(static_cast<double>(i), rows[i].label);
    const std::span done(rows.data(), i + 1);
    runRow(rows[i]);
    if (io::interruption() != 0) {
      progress.finish();
      std::fprintf(stderr, "cantilever: %s; %zu of %zu runs are written\n", io::nameOfInterruption().c_str(), i,
                   rows.size());
      return false;
    }
    if (!settings.quiet) printRow(rows[i]);
    if (settings.study == Study::pareto) markFronts(done);
    writeStudy(folder, name, done);
  }
  progress.finish();
  return true;
}

}  // namespace dovetail::cantilever
