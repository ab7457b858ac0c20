// Sets of runs and their tables.
#pragma once

#include <string>
#include <vector>

#include "run.hpp"

namespace dovetail::wave {

/// One run of a study. `outcome` is finished, not stable, broke down or refused; `message` says why.
struct StudyRow {
  std::string label;
  Settings settings;
  std::string outcome, message;
  RunFigures figures;
  bool onWaveformFront = false, onEnergyFront = false;  ///< nothing is both faster and better
};

/// Runs the study named in the settings; other settings are the starting point of its variations. Prints a line per
/// run unless quiet, and writes <study>.csv and <study>.json into --out (default: the current folder), anew with every
/// run.
/// @return whether all runs were made; if it was interrupted (dovetail/io/interruption.hpp), it has said so on standard
///         error, and the run that was under way has no row
bool runStudy(const Settings& settings);

/// Kernel widths 0 … 10 with penalty and multipliers, 0 … 2.5 in the paper's scheme.
std::vector<StudyRow> widthsPlan(const Settings& settings);
/// The four constraints and both forms of the gap, by penalty.
std::vector<StudyRow> constraintsPlan(const Settings& settings);
/// Particles per element × width × constraint × time step, and the paper's scheme under the same signal.
std::vector<StudyRow> paretoPlan(const Settings& settings);
/// Time steps around the critical one, weight floors to 0, penalties over six decades, stiffness and density ratios
/// 1e-3 … 1e3.
std::vector<StudyRow> stabilityPlan(const Settings& settings);

}  // namespace dovetail::wave
