// What becomes of the energy in the runs of a study: how much is left over, of which order, and whether it grows.
#pragma once

#include <filesystem>

#include "dovetail/io/time_series.hpp"
#include "dovetail/report/table.hpp"

namespace dovetail::program {

/// Of a run's series: "largest_residual_J"; "changed_hands_J", the most that channels have given and taken since the
/// start, half of the sum of the magnitudes of all changes; "largest_residual_fraction", their ratio; and
/// "residual_growth", the exponent p of a largest residual that grows with time to the power p, from its values after
/// half of the time and at the end: 0 bounded, ½ a random walk, 1 a drift. @param series  with a column residual_J
report::Json energyFigures(const io::TimeSeries& series);

/// Writes energy.html and energy.csv into the folder of a study: for each run step, residual, its order beside the run
/// that differs in its step alone, growth and channels; figures of residual against step and time.
/// @param folder  with study.json and the folders of the runs
void writeEnergyStudy(const std::filesystem::path& folder);

/// Names of the files that it writes.
std::vector<std::string> energyStudyFiles();

}  // namespace dovetail::program
