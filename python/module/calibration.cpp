// Parameters fitted to measurements.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <ostream>

#include "callbacks.hpp"
#include "dovetail/calibration/calibrate.hpp"
#include "dovetail/io/output_folder.hpp"
#include "scene_run.hpp"

namespace dovetail::python {

namespace fs = std::filesystem;
using namespace calibration;

namespace {

/// A model of Python's, which is evaluated once for the same parameters.
class Model {
public:
  /// @param function  list of parameters → residuals, (n)
  Model(py::function function, std::int64_t most) : function_(std::move(function)), most_(most) {}

  /// @return nothing where the model breaks down or refuses
  const std::vector<double>& at(std::span<const double> parameters) {
    const std::vector<double> key(parameters.begin(), parameters.end());
    const auto [place, isNew] = known_.try_emplace(key);
    if (!isNew) return place->second;
    ++evaluations;
    const auto begun = std::chrono::steady_clock::now();
    try {
      place->second = residualsAt(key);
    } catch (const Error& error) {
      failure = error.what();
    } catch (...) {
      known_.erase(place);
      throw;
    }
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    return place->second;
  }

  bool isUsedUp() const { return evaluations >= most_; }

  std::int64_t evaluations = 0;
  double seconds = 0.0;
  std::string failure;  ///< of the last that broke down

private:
  std::vector<double> residualsAt(const std::vector<double>& parameters) const {
    const Numbers answer = callOurs([&] { return py::cast<Numbers>(function_(parameters)); });
    if (answer.ndim() != 1 || answer.size() == 0)
      throw py::value_error("residuals of " + std::to_string(answer.ndim()) +
                            " dimensions [model]: give an array of one, a number for each target");
    std::vector<double> residuals(answer.data(), answer.data() + answer.size());
    for (const double r : residuals)
      if (!std::isfinite(r)) throw NumericalError("a residual is not finite", "model", "");
    return residuals;
  }

  py::function function_;
  std::int64_t most_;
  std::map<std::vector<double>, std::vector<double>> known_;
};

py::dict dictOf(const FitResult& fit) {
  py::dict all;
  all["value"] = fit.value;
  all["uncertainty"] = fit.uncertainty;
  all["correlation"] = fit.correlation;
  all["residual"] = arrayOf(fit.residual);
  all["at_bound"] = fit.atBound;
  all["chi_squared"] = fit.chiSquared;
  all["freedom"] = fit.freedom;
  all["iterations"] = fit.iterations;
  all["converged"] = fit.converged;
  all["message"] = fit.message;
  return all;
}

/// @param parameters  name, start, least, most, step of differences
py::dict fitModel(const std::vector<std::tuple<std::string, double, double, double, double>>& parameters,
                  const py::function& function, double tolerance, int iterations, std::int64_t evaluations,
                  const std::string& title) {
  const auto begun = std::chrono::steady_clock::now();
  std::vector<FitParameter> sought;
  std::vector<double> start;
  Calibration file;
  file.title = title;
  for (const auto& [name, from, least, most, step] : parameters) {
    sought.push_back({name, from, least, most, step});
    start.push_back(from);
    file.parameters.emplace_back().key = name;
  }
  Model model(function, evaluations);
  const std::size_t residuals = model.at(start).size();
  if (residuals == 0)
    throw InputError("the model cannot be evaluated where the parameters start: " + model.failure, "model",
                     "begin where it can be");
  CalibrationResult result;
  result.fit = fit(sought, static_cast<int>(residuals),
                   [&](std::span<const double> values, std::span<double> to) {
                     const std::vector<double>& now = model.at(values);
                     if (!now.empty() && now.size() != to.size())
                       throw InputError(
                           "there are " + std::to_string(now.size()) + " residuals after " + std::to_string(to.size()),
                           "model", "give the same number always");
                     std::ranges::copy(now, to.begin());
                     return !now.empty();
                   },
                   {.tolerance = tolerance, .iterations = iterations, .stop = [&] { return model.isUsedUp(); }});
  FitResult& found = *result.fit;
  if (found.stopped) {
    found.message = "the evaluations are used up";
    found.uncertainty.assign(sought.size(), std::numeric_limits<double>::infinity());
    found.atBound.assign(sought.size(), false);
    result.whyStopped = found.message;
  }
  result.simulated = model.evaluations;
  result.simulatorSeconds = model.seconds;
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  py::dict all = dictOf(found);
  all["evaluations"] = model.evaluations;
  all["text"] = reportOf(file, result);
  return all;
}

/// As dovetail calibrate does. @return whether it is done and has converged
bool calibrateFile(const fs::path& file, const std::vector<std::string>& settings, const fs::path& folder,
                   int rehearsals, std::uint64_t seed, const py::function& write) {
  const io::InterruptionGuard guard;
  Lines lines(write);
  std::ostream log(&lines);
  const Calibration plan = readCalibration(file, settings);
  io::prepareOutputFolder(folder, {"calibration.txt", "calibration.json"});
  const CalibrationResult result = [&] {
    const py::gil_scoped_release free;
    return calibration::calibrate(plan, {.folder = folder, .rehearsals = rehearsals, .seed = seed}, log);
  }();
  writeReports(folder, plan, result);
  log << reportOf(plan, result);
  endAs(!result.interrupted);
  return result.whyStopped.empty() && (!result.fit || result.fit->converged);
}

}  // namespace

void bindCalibration(py::module_& m) {
  m.def("fit_model", &fitModel);
  m.def("calibrate_file", &calibrateFile);
}

}  // namespace dovetail::python
