// Contents of the folder of a run.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dovetail/core/ledger.hpp"
#include "dovetail/core/profile.hpp"
#include "dovetail/io/time_series.hpp"

namespace dovetail::report {

struct RunRecord {
  std::string title;         ///< of the scene; the folder's name where there is none
  bool finished = false;     ///< it wrote a summary
  io::KeyValues provenance;  ///< of the series, or of the scene
  std::optional<io::TimeSeries> series;
  std::vector<EnergyLedger::Channel> channels;  ///< at opening and at the end, J
  std::optional<double> residual;               ///< of the energy balance, J, where it is known better than by these
  std::vector<Profile::Row> stages;             ///< time per part of a step
  io::KeyValues figures;                        ///< numbers of the summary by name: errors, residuals, times
  std::vector<std::string> notes, warnings;     ///< lines of the summary
  std::string summary, scene;                   ///< their text; the scene with every key
};

/// Reads series.csv, scene.json and summary.json or summary.txt, as far as they are there.
/// @throws InputError if there is none of them, or one is damaged
RunRecord readRunFolder(const std::filesystem::path& folder);

/// Takes what a summary.txt says into the record.
void readSummaryText(const std::string& text, RunRecord& record);

/// Takes what a summary.json says into the record: that of a scene (docs/outputs.md), or that of a benchmark, which is
/// numbers and texts by their keys, "ledger": a list of {channel, kind, at_opening_J, at_end_J}, "profile": a list of
/// {stage, seconds, calls}, and "settings".
/// @throws InputError if it is no such file. @param where  for messages
void readSummaryJson(const std::string& text, const std::string& where, RunRecord& record);

}  // namespace dovetail::report
