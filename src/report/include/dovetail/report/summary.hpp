// summary.json: what a run has come to, for programs (docs/outputs.md).
#pragma once

#include <filesystem>

#include "dovetail/core/ledger.hpp"
#include "dovetail/core/profile.hpp"
#include "dovetail/io/time_series.hpp"
#include "dovetail/report/table.hpp"

namespace dovetail::report {

/// Raised when a key of summary.json goes or gets another meaning, not when one is added.
inline constexpr int summaryVersion = 1;

/// Part "energy": every channel at the start and now, sums and residuals, J.
Json energyOf(const EnergyLedger& ledger);
/// Part "times": seconds and calls per part of a step.
Json timesOf(const Profile& profile);
/// Part "figures": first, last, least and largest value of every column.
Json figuresOf(const io::TimeSeries& series);

/// Writes provenance, version and the parts: those above, and "results" of a case by name. Numbers that are not finite
/// become null.
/// @throws InputError as io::writeFileAtomically
void writeSummary(const std::filesystem::path& file, const io::KeyValues& provenance, const Json& parts);

/// @throws InputError for what is no summary, is damaged or of another version
Json readSummary(const std::filesystem::path& file);

}  // namespace dovetail::report
