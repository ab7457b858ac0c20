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
  std::optional<io::TimeSeries> modes;          ///< of stages that find modes, a row per mode
  std::vector<EnergyLedger::Channel> channels;  ///< at opening and at the end, J
  std::optional<double> residual;               ///< of the energy balance, J, where it is known better than by these
  std::vector<Profile::Row> stages;             ///< time per part of a step
  io::KeyValues figures;                        ///< numbers of the summary by name: errors, residuals, times
  std::vector<std::string> notes, warnings;     ///< of the summary
  std::string summary, scene;                   ///< their text; the scene with every key
};

/// Reads series.csv, modes.csv, scene.json, summary.json and the text of summary.txt, as far as they are there.
/// @throws InputError if there is no series, scene or summary, or one is damaged or of another version
RunRecord readRunFolder(const std::filesystem::path& folder);

}  // namespace dovetail::report
