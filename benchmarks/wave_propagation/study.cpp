#include "study.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <span>

#include "common/fronts.hpp"
#include "common/json.hpp"
#include "common/outputs.hpp"
#include "common/text.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/progress.hpp"
#include "dovetail/io/interruption.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/provenance.hpp"
#include "published.hpp"
#include "summary.hpp"

namespace dovetail::wave {

namespace {

using benchmark::Json;

struct Plan {
  const char* name;
  std::vector<StudyRow> rows;
};

Plan planOf(const Settings& settings) {
  switch (settings.study) {
    case Study::widths:
      return {"widths", widthsPlan(settings)};
    case Study::pareto:
      return {"pareto", paretoPlan(settings)};
    case Study::stability:
      return {"stability", stabilityPlan(settings)};
    case Study::constraints:
      return {"constraints", constraintsPlan(settings)};
    case Study::none:
      break;
  }
  return {"none", {}};
}

void runRow(StudyRow& row) {
  try {
    RunResult result = run(row.settings);
    if (row.settings.compare) compareWithParticles(result);
    row.figures = result.figures;
    row.outcome = result.figures.finished ? (result.figures.stable ? "finished" : "not stable") : "broke down";
    row.message = result.figures.failure;
    if (row.outcome == "not stable")
      row.message = benchmark::format("energy reached %.3g times what was put in", result.figures.largestExcess);
  } catch (const InputError& error) {
    row.outcome = "refused";
    row.message = error.what();
  }
}

void printRow(const StudyRow& row) {
  const RunFigures& f = row.figures;
  std::printf("%-56s %-10s", row.label.c_str(), row.outcome.c_str());
  if (row.outcome != "refused") {
    std::printf(" %8.3f s %8.2f us/step  lost %9.2e", f.wallSeconds,
                1e6 * f.wallSeconds / static_cast<double>(std::max<std::int64_t>(1, f.steps)), f.lostShare);
    if (f.compared) std::printf("  waveform %9.2e  reflected %8.1e", f.waveformErrorFem, f.reflectedShare);
    if (row.settings.signal == Signal::impulse) std::printf("  dissipated %6.4f", f.paperDissipatedShare);
  }
  if (!row.message.empty()) std::printf("  %s", row.message.c_str());
  std::printf("\n");
  std::fflush(stdout);
}

void markFronts(std::span<StudyRow> rows) {
  const auto finished = [](const StudyRow& r) { return r.outcome == "finished"; };
  const auto seconds = [](const StudyRow& r) { return r.figures.wallSeconds; };
  const auto waveform =
      benchmark::onFront(rows, finished, seconds, [](const StudyRow& r) { return r.figures.waveformErrorFem; });
  const auto energy =
      benchmark::onFront(rows, finished, seconds, [](const StudyRow& r) { return std::abs(r.figures.lostShare); });
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].onWaveformFront = waveform[i];
    rows[i].onEnergyFront = energy[i];
  }
}

/// The authors' figure for the row's n and width, if it is one of their runs.
Json publishedShare(const Settings& s) {
  if (s.scheme != Scheme::paper || s.signal != Signal::impulse) return nullptr;
  for (const PublishedRun& run : publishedRuns)
    if (run.particlesPerEdge == s.particlesPerEdge && run.cgWidth == s.cgWidth) return run.dissipatedShare;
  return nullptr;
}

void writeStudy(const std::filesystem::path& folder, const std::string& name, std::span<const StudyRow> rows) {
  std::vector<Json> entries;
  for (const StudyRow& row : rows) {
    Json entry{{"label", row.label}, {"outcome", row.outcome}, {"message", row.message}};
    entry.update(figuresAsJson(row.figures));
    entry["published_dissipated_share"] = publishedShare(row.settings);
    entry["on_waveform_front"] = row.onWaveformFront;
    entry["on_energy_front"] = row.onEnergyFront;
    entry["settings"] = benchmark::objectOf(describe(row.settings));
    entries.push_back(std::move(entry));
  }
  io::writeFileAtomically(folder / (name + ".csv"), benchmark::csvOf(entries, io::provenance()));
  Json json;
  json["study"] = name;
  json["provenance"] = benchmark::objectOf(io::provenance());
  json["runs"] = entries;
  io::writeFileAtomically(folder / (name + ".json"), json.dump(2) + "\n");
}

}  // namespace

bool runStudy(const Settings& settings) {
  auto [name, rows] = planOf(settings);
  const std::filesystem::path folder = settings.out.empty() ? "." : settings.out;
  benchmark::underName("--out", [&, base = std::string(name)] {
    return io::prepareOutputFolder(folder, {base + ".csv", base + ".json"});
  });
  Progress progress(std::string("study ") + name, static_cast<double>(rows.size()), !settings.quiet);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].settings.quiet = true;
    rows[i].settings.out.clear();
    progress.update(static_cast<double>(i), rows[i].label);
    const std::span done(rows.data(), i + 1);
    runRow(rows[i]);
    if (io::interruption() != 0) {
      progress.finish();
      std::fprintf(stderr, "wave_propagation: %s; %zu of %zu runs are written\n", io::nameOfInterruption().c_str(), i,
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

}  // namespace dovetail::wave
