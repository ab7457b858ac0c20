// Sets of runs and their tables.
#pragma once

#include <string>
#include <vector>

#include "run.hpp"

namespace dovetail::cantilever {

/// One run of a study. `outcome` is finished, refused, or broke down; `message` says why.
struct StudyRow {
  std::string label;
  Settings settings;
  std::string outcome, message;
  RunFigures figures;
  double madeByCoupling = 0.0, lostToDashpots = 0.0;  ///< J, at the end
  bool onErrorFront = false, onDriftFront = false;    ///< nothing is both faster and better
};

/// Runs the study named in the settings; other settings are the starting point of its variations. Prints a line per
/// run unless quiet, and writes <study>.csv and <study>.json into --out (default: the current folder), anew with every
/// run.
/// @return whether all runs were made; if it was interrupted (dovetail/io/interruption.hpp), it has said so on standard
///         error, and the run that was under way has no row
bool runStudy(const Settings& settings);

/// Coarse-graining widths 0 … 20 d in both schemes.
std::vector<StudyRow> widthsPlan(const Settings& settings);
/// Elements × meshes × time steps × FEM sub-steps.
std::vector<StudyRow> paretoPlan(const Settings& settings);
/// Time steps around the critical one, stiffness ratios 1e-3 … 1e4, widths to 40 d.
std::vector<StudyRow> stabilityPlan(const Settings& settings);
/// The parts of the paper's scheme one at a time.
std::vector<StudyRow> ablationPlan(const Settings& settings);

}  // namespace dovetail::cantilever
