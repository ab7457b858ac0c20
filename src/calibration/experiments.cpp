#include "dovetail/calibration/experiments.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/io/interruption.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/time_series.hpp"
#include "dovetail/scene/build.hpp"
#include "dovetail/scene/execute.hpp"
#include "dovetail/scene/files.hpp"
#include "dovetail/scene/read.hpp"
#include "evaluation_file.hpp"

namespace dovetail::calibration {

namespace {

double clockSeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::vector<double> ratiosOf(const TriaxialCurve& curve) {
  std::vector<double> ratios;
  for (std::size_t k = 0; k < curve.size(); ++k)
    ratios.push_back(3.0 * curve.deviator(k) / (curve.axial[k] + 2.0 * curve.lateral[k]));
  return ratios;
}

Outcome outcomeOf(const Moduli& m) {
  Outcome found;
  found.numbers = {{"density", m.density},
                   {"solid_fraction", m.solidFraction},
                   {"pressure", m.pressure},
                   {"bulk_modulus", m.bulk},
                   {"shear_modulus", m.shear},
                   {"youngs_modulus", m.youngsModulus},
                   {"poisson_ratio", m.poissonRatio},
                   {"anisotropy", m.anisotropy},
                   {"nonlinearity", m.nonlinearity},
                   {"p_wave_speed", m.pWaveSpeed},
                   {"s_wave_speed", m.sWaveSpeed}};
  return found;
}

Outcome outcomeOf(const TriaxialCurve& curve, double density) {
  const Strength strength = strengthOf(curve);
  Outcome found;
  found.numbers = {{"peak_friction_angle", strength.peakAngle},
                   {"peak_strain", strength.peakStrain},
                   {"residual_friction_angle", strength.residualAngle},
                   {"dilatancy_angle", strength.dilatancyAngle},
                   {"density", density}};
  found.abscissa = "strain";
  std::vector<double> deviator, angle;
  for (std::size_t k = 0; k < curve.size(); ++k) {
    deviator.push_back(curve.deviator(k));
    angle.push_back(curve.mobilisedAngle(k));
  }
  found.curves = {{"strain", curve.strain},          {"volumetric_strain", curve.volume},
                  {"axial_pressure", curve.axial},   {"lateral_pressure", curve.lateral},
                  {"deviator", std::move(deviator)}, {"friction_angle", std::move(angle)},
                  {"stress_ratio", ratiosOf(curve)}};
  return found;
}

Outcome outcomeOf(const io::TimeSeries& series) {
  Outcome found;
  found.abscissa = "time_s";
  for (std::size_t c = 0; c < series.names().size(); ++c) {
    const auto column = series.column(c);
    found.curves[series.names()[c]].assign(column.begin(), column.end());
  }
  return found;
}

/// With the experiment's own settings, and then the values sought, in place of the scene's.
scene::Scene sceneOf(const Experiment& experiment, const std::vector<std::string>& values) {
  std::vector<std::string> settings;
  for (const Setting& one : experiment.set) settings.push_back(one.key + "=" + one.value);
  settings.insert(settings.end(), values.begin(), values.end());
  return scene::readScene(experiment.scene, settings);
}

/// Nothing but grains and their contacts can be a cell.
void requireGrainsAlone(const scene::Scene& scene, const std::string& where) {
  const std::pair<bool, const char*> others[] = {
      {!scene.walls.empty(), "walls"},           {!scene.clumps.empty(), "clumps"},
      {!scene.bonds.empty(), "bonds"},           {!scene.drives.empty(), "drives"},
      {!scene.solids.empty(), "solids"},         {!scene.outlets.empty(), "outlets"},
      {!scene.insertions.empty(), "insertions"}, {norm(scene.gravity) > 0.0, "gravity"}};
  for (const auto& [there, name] : others)
    if (there)
      throw InputError(std::string("the scene of a cell has ") + name, where,
                       "probe a scene of grains alone in periodic space, or let the experiment \"do\": \"run\"");
  const bool repeats = scene.periodic && scene.periodic->axes == std::array{true, true, true};
  if (!repeats)
    throw InputError("the scene of a cell does not repeat along all axes", where,
                     "give it \"periodic\" with \"axes\": [\"x\", \"y\", \"z\"]");
}

}  // namespace

double Outcome::value(const std::string& quantity, const std::optional<double>& at, const std::string& where) const {
  const auto number = numbers.find(quantity);
  if (number != numbers.end() && !at) return number->second;
  const auto curve = curves.find(quantity);
  if (curve == curves.end()) {
    std::string names;
    for (const auto& [name, value] : curves) names += (names.empty() ? "" : ", ") + name;
    throw InputError(number != numbers.end() ? quantity + " is a single number, which has no curve for \"at\""
                                             : "the run's series has no column \"" + quantity + "\"",
                     where, number != numbers.end() ? "leave \"at\" out" : "write one of " + names);
  }
  const std::vector<double>&y = curve->second, &x = curves.at(abscissa);
  if (!at) return y.back();
  if (*at < x.front() || *at > x.back() + 1e-9 * std::abs(x.back()))
    throw InputError("there is nothing at " + formatNumber(*at) + " on the curve of " + quantity, where,
                     "take \"at\" from " + formatNumber(x.front()) + " to " + formatNumber(x.back()));
  if (x.size() == 1) return y.back();
  const auto above = static_cast<std::size_t>(std::upper_bound(x.begin() + 1, x.end() - 1, *at) - x.begin());
  const double fraction = (*at - x[above - 1]) / (x[above] - x[above - 1]);
  return y[above - 1] + fraction * (y[above] - y[above - 1]);
}

TriaxialCurve triaxialOf(const Outcome& outcome) {
  TriaxialCurve curve;
  if (outcome.abscissa != "strain")
    throw InputError("there is no curve of stresses over strain", "triaxial compression", "take a triaxial experiment");
  curve.strain = outcome.curves.at("strain");
  curve.volume = outcome.curves.at("volumetric_strain");
  curve.axial = outcome.curves.at("axial_pressure");
  curve.lateral = outcome.curves.at("lateral_pressure");
  return curve;
}

Laboratory::Laboratory(std::filesystem::path folder)
    : folder_(io::prepareOutputFolder(folder, {evaluationFileName})), known_(readEvaluations(folder_)) {}

Laboratory::~Laboratory() {
  try {
    save();
  } catch (const Error&) {  // a destructor tells nobody; save has been called where it counts
  }
}

void Laboratory::save() {
  if (unsaved_) writeEvaluations(folder_, known_);
  unsaved_ = false;
  savedAt_ = clockSeconds();
}

const dem::Model& Laboratory::prepared(const scene::Scene& scene, const Preparation& preparation) {
  constexpr std::size_t kept = 8;
  scene::Scene own = scene;
  if (preparation.friction) {
    if (!own.contact || !own.contacts.empty())
      throw InputError("a preparation has a friction of its own, but grains have several laws", "preparation_friction",
                       "give the scene one law in \"contact\", or leave preparation_friction out");
    own.contact->friction = *preparation.friction;
  }
  const std::string name = scene::hashOf(scene::sceneText(own) + formatNumber(preparation.pressure));
  for (const auto& [known, cell] : cells_)
    if (known == name) return cell;
  scene::Built built = scene::build(own);
  dem::Model cell;
  cell.particles = std::move(built.run->grains.particles);
  cell.pairs = std::move(built.run->grains.pairs);
  cell.laws = built.run->grains.laws;
  compressRve(cell, {.pressure = preparation.pressure});
  if (cells_.size() == kept) cells_.erase(cells_.begin());
  return cells_.emplace_back(name, std::move(cell)).second;
}

Outcome Laboratory::simulate(const Experiment& experiment, const scene::Scene& scene) {
  const auto cellFor = [&](const Preparation& preparation) {
    requireGrainsAlone(scene, experiment.where);
    dem::Model cell = prepared(scene, preparation);
    scene::Scene lawsAlone;
    lawsAlone.contact = scene.contact;
    lawsAlone.contacts = scene.contacts;
    cell.laws = scene::build(lawsAlone).run->grains.laws;
    return cell;
  };
  if (const auto* const probe = std::get_if<ModuliProbe>(&experiment.probe))
    return outcomeOf(smallStrainModuli(cellFor(probe->preparation), {.strain = probe->strain}));
  if (const auto* const probe = std::get_if<TriaxialProbe>(&experiment.probe)) {
    const dem::Model cell = cellFor(probe->preparation);
    return outcomeOf(triaxialCompression(cell, {.strain = probe->strain, .increments = probe->increments}),
                     cellDensity(cell));
  }
  if (!scene.output.series)
    throw InputError("the scene writes no series", experiment.where, "give it output.series, such as \"1 ms\"");
  const std::filesystem::path folder = folder_ / ("run_" + experiment.name);
  std::ostringstream log;
  if (!scene::run(scene, {.folder = folder, .progress = false}, log))
    throw NumericalError(io::nameOfInterruption(), experiment.name, "");
  return outcomeOf(io::readCsv(folder / "series.csv"));
}

const Outcome& Laboratory::perform(const Experiment& experiment, const std::vector<std::string>& values) {
  const scene::Scene scene = sceneOf(experiment, values);
  const std::string name = scene::hashOf(scene::sceneText(scene) + textOfProbe(experiment) + buildName());
  if (const auto found = known_.find(name); found != known_.end()) {
    ++recalled;
    return found->second;
  }
  const double begun = clockSeconds();
  Outcome outcome;
  try {
    outcome = simulate(experiment, scene);
  } catch (const Error& error) {  // broke down, or was refused with these values
    if (io::interruption() != 0) throw;
    outcome.failure = error.what();
  }
  outcome.seconds = clockSeconds() - begun;
  ++simulated;
  seconds += outcome.seconds;
  unsaved_ = true;
  const Outcome& kept = known_[name] = std::move(outcome);
  if (clockSeconds() - savedAt_ > 1.0) save();
  return kept;
}

}  // namespace dovetail::calibration
