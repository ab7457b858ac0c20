// A calibration file carried out.
#pragma once

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <optional>

#include "dovetail/calibration/calibration.hpp"
#include "dovetail/calibration/experiments.hpp"
#include "dovetail/calibration/fit.hpp"
#include "dovetail/calibration/search.hpp"

namespace dovetail::calibration {

/// A target beside what the experiments gave with the parameters found.
struct Comparison {
  const Target* target;
  double deviation;  ///< standard, of the target
  double model;
};

/// How well known parameters are recovered: targets made from them with noise, and fits that begin elsewhere.
struct Rehearsal {
  int draws = 0;
  std::uint64_t seed = 1;
  std::vector<double> truth;
  std::vector<std::vector<double>> estimate;     ///< one row per draw
  std::vector<std::vector<double>> uncertainty;  ///< stated, likewise
};

/// What a calibration found. Experiments without parameters leave `fit` and `optimum` empty.
struct CalibrationResult {
  std::optional<FitResult> fit;
  std::optional<Optimum> optimum;
  std::vector<double> value;                              ///< of the parameters
  std::vector<Comparison> targets;                        ///< at these
  std::vector<std::pair<std::string, Outcome>> outcomes;  ///< by experiment, at these
  std::optional<Cone> cone;                               ///< through all triaxial experiments
  std::optional<Rehearsal> rehearsal;
  std::int64_t simulated = 0, recalled = 0;
  double seconds = 0.0, simulatorSeconds = 0.0;
  bool interrupted = false;
  std::string whyStopped;
};

struct CalibrationOptions {
  std::filesystem::path folder;  ///< evaluations.json, calibration.json, calibration.txt
  int rehearsals = 0;            ///< > 0: draws of a rehearsal, in place of the fit
  std::uint64_t seed = 1;
};

/// Does the experiments, or fits or searches the parameters; a line for each new evaluation goes to the log. What has
/// been evaluated is kept in the folder, so the same call goes on where an earlier one was broken off. With rehearsals,
/// the parameters' starts are the truth: targets are made from them with normal noise of the targets' deviations, and
/// each fit begins at random in the middle half of the bounds.
/// @throws InputError as readCalibration and Laboratory; NumericalError if experiments without parameters break down
CalibrationResult calibrate(const Calibration& file, const CalibrationOptions& settings, std::ostream& log);

/// Estimates, uncertainties, residuals, quality of the fit, correlation, flatness, evaluations and time, in words.
std::string reportOf(const Calibration& file, const CalibrationResult& result);
/// The same as calibration.txt and calibration.json in the folder, with provenance.
void writeReports(const std::filesystem::path& folder, const Calibration& file, const CalibrationResult& result);

}  // namespace dovetail::calibration
