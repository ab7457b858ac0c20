#include "dovetail/calibration/calibrate.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ostream>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/setup/random_stream.hpp"
#include "dovetail/io/interruption.hpp"

namespace dovetail::calibration {

namespace {

/// A file on its way: the simulator, and what the parameters make of the targets.
class Calibrating {
public:
  Calibrating(const Calibration& file, Laboratory& laboratory, std::ostream& log)
      : file_(file), laboratory_(laboratory), log_(log) {}

  bool stops() const { return io::interruption() != 0 || laboratory_.simulated >= file_.evaluations; }

  std::vector<std::string> settingsOf(std::span<const double> values) const {
    std::vector<std::string> settings;
    for (std::size_t k = 0; k < values.size(); ++k) {
      const std::string unit = scene::siName(file_.parameters[k].start.dimension);
      settings.push_back(file_.parameters[k].key + "=" + formatNumber(values[k]) + (unit.empty() ? "" : " " + unit));
    }
    return settings;
  }

  /// What the targets' quantities are with these parameters; empty if an experiment breaks down.
  std::vector<double> model(std::span<const double> values) {
    const std::vector<std::string> settings = settingsOf(values);
    std::map<std::string, const Outcome*> outcomes;
    std::vector<double> found;
    for (const Target& target : file_.targets) {
      const Outcome*& outcome = outcomes[target.of];
      if (!outcome) outcome = &perform(experimentNamed(target.of), settings);
      if (!outcome->failure.empty()) return {};
      found.push_back(outcome->value(target.quantity, target.at, target.where));
      if (!std::isfinite(found.back())) return {};
    }
    return found;
  }

  /// @throws InputError if an experiment cannot be done where the parameters start
  void requireStart() {
    const std::vector<double> values = starts();
    for (const Target& target : file_.targets) {
      const Experiment& experiment = experimentNamed(target.of);
      const Outcome& outcome = perform(experiment, settingsOf(values));
      if (!outcome.failure.empty())
        throw InputError(
            "the experiment \"" + experiment.name + "\" cannot be done where the parameters start: " + outcome.failure,
            experiment.where, "");
      outcome.value(target.quantity, target.at, target.where);
    }
  }

  /// A fit to targets, which may be others than the file's.
  FitResult fitTo(const std::vector<double>& targets, const std::vector<double>& deviations,
                  const std::vector<double>& start) {
    std::vector<FitParameter> parameters = fitParameters();
    for (std::size_t k = 0; k < start.size(); ++k) parameters[k].start = start[k];
    return fit(parameters, static_cast<int>(targets.size()),
               [&](std::span<const double> values, std::span<double> residuals) {
                 const std::vector<double> now = model(values);
                 for (std::size_t k = 0; k < now.size(); ++k) residuals[k] = (now[k] - targets[k]) / deviations[k];
                 return !now.empty();
               },
               {.tolerance = file_.tolerance, .stop = [this] { return stops(); }});
  }

  Optimum search() {
    const Measure measure = [this](std::span<const double> values) -> std::optional<double> {
      const std::vector<double> now = model(values);
      if (now.empty()) return {};
      double sum = 0.0;
      for (std::size_t k = 0; k < now.size(); ++k) {
        const double r = (now[k] - file_.targets[k].value.value) / file_.targets[k].deviation();
        sum += r * r;
      }
      return std::sqrt(sum);
    };
    return searchOptimum(fitParameters(), measure,
                         {.samples = file_.search->samples, .refinements = file_.search->refinements, .stop = [this] {
                            return stops();
                          }});
  }

  Rehearsal rehearse(int draws, std::uint64_t seed) {
    Rehearsal found{draws, seed, starts(), {}, {}};
    const std::vector<double> truth = model(found.truth);
    dem::RandomStream random(seed);
    for (int draw = 0; draw < draws && !stops(); ++draw) {
      std::vector<double> targets, deviations, start;
      for (std::size_t k = 0; k < truth.size(); ++k) {
        const Target& target = file_.targets[k];
        deviations.push_back(target.uncertainty.value > 0.0 ? target.uncertainty.value : 0.01 * std::abs(truth[k]));
        targets.push_back(truth[k] + deviations.back() * random.normal());
      }
      for (const Parameter& p : file_.parameters)
        start.push_back(p.least.value + random.uniform(0.25, 0.75) * (p.most.value - p.least.value));
      const FitResult result = fitTo(targets, deviations, start);
      if (result.stopped) break;
      found.estimate.push_back(result.value);
      found.uncertainty.push_back(result.uncertainty);
      log_ << "draw " << draw + 1 << " of " << draws << ":";
      for (std::size_t k = 0; k < result.value.size(); ++k)
        log_ << ' ' << file_.parameters[k].key << ' ' << result.value[k];
      log_ << std::endl;
    }
    return found;
  }

  std::vector<double> starts() const {
    std::vector<double> values;
    for (const Parameter& p : file_.parameters) values.push_back(p.start.value);
    return values;
  }

  const Outcome& perform(const Experiment& experiment, const std::vector<std::string>& settings) {
    const std::int64_t before = laboratory_.simulated;
    const Outcome& outcome = laboratory_.perform(experiment, settings);
    if (laboratory_.simulated > before) {
      log_ << "evaluation " << laboratory_.simulated << ", " << experiment.name;
      for (const std::string& setting : settings) log_ << ", " << setting;
      log_ << ": "
           << (outcome.failure.empty() ? formatNumber(std::round(1e3 * outcome.seconds) / 1e3) + " s" : outcome.failure)
           << std::endl;
    }
    return outcome;
  }

private:
  const Experiment& experimentNamed(const std::string& name) const {
    return *std::find_if(file_.experiments.begin(), file_.experiments.end(),
                         [&](const Experiment& one) { return one.name == name; });
  }
  std::vector<FitParameter> fitParameters() const {
    std::vector<FitParameter> parameters;
    for (const Parameter& p : file_.parameters)
      parameters.push_back({p.key, p.start.value, p.least.value, p.most.value, p.step});
    return parameters;
  }

  const Calibration& file_;
  Laboratory& laboratory_;
  std::ostream& log_;
};

/// All experiments with the parameters found, and the targets beside them.
void addOutcomes(Calibrating& work, const Calibration& file, CalibrationResult& result) {
  const std::vector<std::string> settings = work.settingsOf(result.value);
  std::vector<TriaxialCurve> curves;
  for (const Experiment& experiment : file.experiments) {
    const Outcome& outcome = work.perform(experiment, settings);
    if (!outcome.failure.empty())
      throw NumericalError("the experiment \"" + experiment.name + "\" breaks down: " + outcome.failure,
                           experiment.where, "");
    if (outcome.abscissa == "strain") curves.push_back(triaxialOf(outcome));
    result.outcomes.emplace_back(experiment.name, outcome);
  }
  if (!curves.empty()) result.cone = coneThrough(curves);
  const std::vector<double> model = work.model(result.value);
  for (std::size_t k = 0; k < model.size(); ++k)
    result.targets.push_back({&file.targets[k], file.targets[k].deviation(), model[k]});
}

}  // namespace

CalibrationResult calibrate(const Calibration& file, const CalibrationOptions& settings, std::ostream& log) {
  const auto begun = std::chrono::steady_clock::now();
  Laboratory laboratory(settings.folder);
  Calibrating work(file, laboratory, log);
  CalibrationResult result;
  result.value = work.starts();
  if (settings.rehearsals > 0 && file.parameters.empty())
    throw InputError("there are no parameters to recover", "--rehearse", "give the file parameters and targets");
  try {
    if (!file.parameters.empty()) work.requireStart();
    if (settings.rehearsals > 0) {
      result.rehearsal = work.rehearse(settings.rehearsals, settings.seed);
    } else if (file.search && !file.parameters.empty()) {
      result.optimum = work.search();
      result.value = result.optimum->value;
    } else if (!file.parameters.empty()) {
      std::vector<double> targets, deviations;
      for (const Target& target : file.targets) {
        targets.push_back(target.value.value);
        deviations.push_back(target.deviation());
      }
      result.fit = work.fitTo(targets, deviations, result.value);
      result.value = result.fit->value;
    }
    if (work.stops() && io::interruption() == 0 && !file.parameters.empty())
      result.whyStopped = "all " + std::to_string(file.evaluations) +
                          " evaluations are used up: raise \"evaluations\"; "
                          "what was evaluated is kept";
    if (!result.rehearsal && io::interruption() == 0) addOutcomes(work, file, result);
  } catch (const Error&) {
    laboratory.save();
    if (io::interruption() == 0) throw;
  }
  laboratory.save();
  result.interrupted = io::interruption() != 0;
  if (result.interrupted) result.whyStopped = io::nameOfInterruption() + ": the same command continues from here";
  result.simulated = laboratory.simulated;
  result.recalled = laboratory.recalled;
  result.simulatorSeconds = laboratory.seconds;
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  return result;
}

}  // namespace dovetail::calibration
