// What a run has come to, for readers and for programs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dovetail/core/stopwatch.hpp"
#include "dovetail/io/provenance.hpp"
#include "dovetail/io/time_series.hpp"
#include "dovetail/scene/build.hpp"

namespace dovetail::scene {

/// What is told of a run beside its end.
struct RunNotes {
  struct Stage {
    std::size_t number;  ///< from 1
    const char* what;
    TimeTaken taken;  ///< in all programs that worked on it
    double begins;    ///< s, simulated
  };
  std::vector<Stage> stages;
  std::vector<std::string> lines, warnings;
};

/// Writes summary.txt (coupling::report) and summary.json (report::writeSummary): provenance, sizes, step beside the
/// limit and who sets it, channels of the ledger, momenta, first, last and extreme values of the series' columns, time
/// per stage and, with a profile, per part of a step, warnings, and the scene in full. Values that are not finite are
/// null.
/// @param table  null without a series
/// @return the text without its provenance
std::string writeSummary(const std::filesystem::path& folder, const io::KeyValues& provenance, const Scene& scene,
                         Built& built, const RunNotes& notes, const io::TimeSeries* table);

}  // namespace dovetail::scene
