// What a calibration found, as text and as JSON.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "dovetail/calibration/calibrate.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/provenance.hpp"

namespace dovetail::calibration {

namespace {

using Json = nlohmann::ordered_json;

template <class... Values>
std::string line(const char* format, Values... values) {
  char text[400];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

std::string withUnit(const std::string& name, const scene::Dimension& dimension) {
  const std::string unit = scene::siName(dimension);
  return unit.empty() ? name : name + ", " + unit;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n % 2 == 1 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
}

std::string textOf(const Calibration& file, const FitResult& fit) {
  std::string text = line("%-34s %14s %14s\n", "parameter", "estimate", "uncertainty");
  for (std::size_t k = 0; k < fit.value.size() && k < fit.uncertainty.size(); ++k)
    text +=
        line("%-34s %14.6g %14.3g%s\n", withUnit(file.parameters[k].key, file.parameters[k].start.dimension).c_str(),
             fit.value[k], fit.uncertainty[k], fit.atBound[k] ? "  at its bound" : "");
  text += line("\nchi squared %.4g with %d degrees of freedom: %.3g each; %d iterations, %s\n", fit.chiSquared,
               fit.freedom, fit.reducedChiSquared(), fit.iterations, fit.converged ? "converged" : "NOT converged");
  if (fit.correlation.size() > 1) {
    text += "\ncorrelation\n";
    for (const std::vector<double>& row : fit.correlation) {
      for (const double value : row) text += line(" %7.3f", value);
      text += "\n";
    }
  }
  return text;
}

std::string textOf(const Calibration& file, const Optimum& optimum) {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < optimum.profiles.size(); ++k)
    names.push_back(withUnit(file.parameters[k].key, file.parameters[k].start.dimension));
  std::string text = line("least measure %.6g\n\n", optimum.measure) + optimaText(names, optimum.profiles);
  for (std::size_t k = 0; k < optimum.profiles.size(); ++k) {
    text += line("\n%-20s %14s\n", file.parameters[k].key.c_str(), "measure");
    for (std::size_t s = 0; s < optimum.profiles[k].at.size(); ++s)
      text += line("%-20.6g %14.6g\n", optimum.profiles[k].at[s], optimum.profiles[k].measure[s]);
  }
  return text;
}

/// Of one parameter in a rehearsal, relative to the truth.
struct Recovery {
  double medianError, bias, scatter, stated;
};
Recovery recoveryOf(const Rehearsal& rehearsal, std::size_t k) {
  std::vector<double> errors, sizes, stated;
  double squares = 0.0;
  for (std::size_t d = 0; d < rehearsal.estimate.size(); ++d) {
    errors.push_back(rehearsal.estimate[d][k] / rehearsal.truth[k] - 1.0);
    sizes.push_back(std::abs(errors.back()));
    stated.push_back(rehearsal.uncertainty[d][k] / std::abs(rehearsal.truth[k]));
    squares += errors.back() * errors.back();
  }
  return {median(sizes), median(errors), std::sqrt(squares / static_cast<double>(errors.size())), median(stated)};
}

std::string textOf(const Calibration& file, const Rehearsal& rehearsal) {
  std::string text = line("%zu of %d draws, seed %llu; relative to the truth:\n%-34s %12s %12s %12s %12s %12s\n",
                          rehearsal.estimate.size(), rehearsal.draws, static_cast<unsigned long long>(rehearsal.seed),
                          "parameter", "truth", "median error", "bias", "scatter", "stated");
  for (std::size_t k = 0; !rehearsal.estimate.empty() && k < rehearsal.truth.size(); ++k) {
    const Recovery r = recoveryOf(rehearsal, k);
    text += line("%-34s %12.6g %12.4g %12.4g %12.4g %12.4g\n",
                 withUnit(file.parameters[k].key, file.parameters[k].start.dimension).c_str(), rehearsal.truth[k],
                 r.medianError, r.bias, r.scatter, r.stated);
  }
  return text;
}

std::string textOf(const std::string& name, const Outcome& outcome) {
  std::string text = name + "\n";
  for (const auto& [quantity, value] : outcome.numbers) {
    text += line("  %-32s %14.6g\n", quantity.c_str(), value);
    if (quantity.ends_with("_angle"))
      text.insert(text.size() - 1, line("  (%.4g deg)", value * 180.0 / 3.14159265358979324));
  }
  if (!outcome.curves.empty() && !outcome.abscissa.empty())
    text +=
        line("  a curve of %zu points over %s\n", outcome.curves.at(outcome.abscissa).size(), outcome.abscissa.c_str());
  return text;
}

Json numberOrNull(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json jsonOf(const FitResult& fit) {
  Json json{{"converged", fit.converged},        {"iterations", fit.iterations}, {"chi_squared", fit.chiSquared},
            {"degrees_of_freedom", fit.freedom}, {"message", fit.message},       {"correlation", fit.correlation}};
  json["uncertainty"] = Json::array();
  for (const double u : fit.uncertainty) json["uncertainty"].push_back(numberOrNull(u));
  json["at_bound"] = fit.atBound;
  return json;
}

Json jsonOf(const Optimum& optimum) {
  Json json{{"measure", optimum.measure}, {"profiles", Json::array()}};
  for (const MeasureCurve& p : optimum.profiles)
    json["profiles"].push_back({{"best", p.best},
                                {"within_5_percent", {p.lower, p.upper}},
                                {"open", {p.lowerOpen, p.upperOpen}},
                                {"curvature", p.curvature},
                                {"at", p.at},
                                {"measure", p.measure}});
  return json;
}

Json jsonOf(const Calibration& file, const CalibrationResult& result) {
  Json json;
  for (const auto& [key, value] : io::provenance()) json[key] = value;
  json["title"] = file.title;
  json["finished"] = result.whyStopped.empty();
  json["evaluations"] = {{"simulated", result.simulated}, {"recalled", result.recalled}};
  json["seconds"] = result.seconds;
  json["simulator_seconds"] = result.simulatorSeconds;
  json["parameters"] = Json::object();
  for (std::size_t k = 0; k < file.parameters.size() && !result.rehearsal; ++k)
    json["parameters"][file.parameters[k].key] = result.value[k];
  if (result.fit) json["fit"] = jsonOf(*result.fit);
  if (result.optimum) json["search"] = jsonOf(*result.optimum);
  if (result.rehearsal)
    json["rehearsal"] = {{"draws", result.rehearsal->draws},
                         {"seed", result.rehearsal->seed},
                         {"truth", result.rehearsal->truth},
                         {"estimates", result.rehearsal->estimate},
                         {"uncertainties", result.rehearsal->uncertainty}};
  for (const Comparison& c : result.targets)
    json["targets"].push_back({{"of", c.target->of},
                               {"quantity", c.target->quantity},
                               {"at", c.target->at ? Json(*c.target->at) : Json(nullptr)},
                               {"value", c.target->value.value},
                               {"deviation", c.deviation},
                               {"model", c.model}});
  for (const auto& [name, outcome] : result.outcomes) json["experiments"][name] = outcome.numbers;
  if (result.cone)
    json["drucker_prager"] = {{"friction_angle", result.cone->frictionAngle},
                              {"cohesion", result.cone->cohesion},
                              {"dilatancy_angle", result.cone->dilatancyAngle},
                              {"misfit", result.cone->misfit}};
  return json;
}

}  // namespace

std::string reportOf(const Calibration& file, const CalibrationResult& result) {
  std::string text = file.title.empty() ? "" : file.title + "\n\n";
  if (result.fit) text += textOf(file, *result.fit) + "\n";
  if (result.optimum) text += textOf(file, *result.optimum) + "\n";
  if (result.rehearsal) text += textOf(file, *result.rehearsal) + "\n";
  if (!result.targets.empty())
    text += line("%-40s %12s %12s %12s %10s\n", "target", "value", "deviation", "model", "residual");
  for (const Comparison& c : result.targets) {
    std::string name = c.target->of + ": " + c.target->quantity;
    if (c.target->at) name += line(" at %g", *c.target->at);
    text += line("%-40s %12.6g %12.4g %12.6g %10.3f\n", name.c_str(), c.target->value.value, c.deviation, c.model,
                 (c.model - c.target->value.value) / c.deviation);
  }
  if (!result.targets.empty()) text += "\n";
  for (const auto& [name, outcome] : result.outcomes) text += textOf(name, outcome);
  if (result.cone)
    text += line(
        "cone of Drucker and Prager: friction angle %.4g deg, cohesion %.4g Pa, dilatancy angle %.4g deg, misfit "
        "%.3g\n",
        result.cone->frictionAngle * 180.0 / 3.14159265358979324, result.cone->cohesion,
        result.cone->dilatancyAngle * 180.0 / 3.14159265358979324, result.cone->misfit);
  text += line("\n%lld experiments done in %.2f s, %lld remembered; %.2f s in all\n",
               static_cast<long long>(result.simulated), result.simulatorSeconds,
               static_cast<long long>(result.recalled), result.seconds);
  return text + (result.whyStopped.empty() ? "" : result.whyStopped + "\n");
}

void writeReports(const std::filesystem::path& folder, const Calibration& file, const CalibrationResult& result) {
  io::writeFileAtomically(folder / "calibration.txt",
                          io::provenanceLines(io::provenance(), "# ") + "\n" + reportOf(file, result));
  io::writeFileAtomically(folder / "calibration.json", jsonOf(file, result).dump(1) + "\n");
}

}  // namespace dovetail::calibration
