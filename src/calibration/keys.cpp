// Keys of calibration files.
#include <algorithm>
#include <cmath>
#include <set>

#include "dovetail/calibration/calibration.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/io/names.hpp"
#include "dovetail/scene/files.hpp"
#include "quantities.hpp"

namespace dovetail::calibration {

using scene::Fields;
namespace unit = scene::unit;

namespace {
void preparation(Fields& f, Preparation& v) {
  f.number({"pressure", "of the cell at rest, before the experiment"}, v.pressure, scene::positive(unit::pressure));
  f.number({"preparation_friction",
            "of the grains until the pressure is reached, the lower the denser; their own if not given"},
           v.friction, scene::notNegative(unit::none));
}
}  // namespace

void describe(Fields& f, Setting& v) {
  f.text({"key", "a parameter of \"let\", or a path such as particles.0.seed"}, v.key, true);
  f.text({"value", "as in the scene, in quotes"}, v.value, true);
}
void describe(Fields& f, ModuliProbe& v) {
  preparation(f, v.preparation);
  f.number({"strain", "of the probes, along each axis to both sides"}, v.strain, scene::between(0.0, 0.01, true));
}
void describe(Fields& f, TriaxialProbe& v) {
  preparation(f, v.preparation);
  f.number({"strain", "logarithmic, along z, at the end"}, v.strain, scene::between(0.0, 1.0, true));
  f.integer({"increments", "of the strain, with rest after each"}, v.increments, 10, 1000000);
}
void describe(Fields&, RunProbe&) {}
void describe(Fields& f, Experiment& v) {
  static constexpr const char* probes[] = {"moduli", "triaxial", "run"};
  f.where(v.where);
  f.text({"name", "for targets"}, v.name, true);
  f.file({"scene", "file of the scene: a periodic packing, or with \"run\" any"}, v.scene);
  f.list({"set", "other values of the scene's keys, in this experiment"}, v.set);
  f.oneOf({"do", "small strains, drained triaxial compression, or a run of the scene as it is"}, v.probe, probes);
}
void describe(Fields& f, Parameter& v) {
  f.where(v.where);
  f.text({"key", "of the scenes: a parameter of \"let\", or a path such as contact.friction"}, v.key, true);
  f.quantity({"start", "initial value of the fit"}, v.start);
  f.quantity({"least", "lower bound"}, v.least);
  f.quantity({"most", "upper bound"}, v.most);
  f.number({"step", "of finite differences, over most - least; take it above the noise of the simulation"}, v.step,
           scene::between(0.0, 0.25, true));
}
void describe(Fields& f, Target& v) {
  f.where(v.where);
  f.text({"of", "an experiment, by its name"}, v.of, true);
  f.text({"quantity", "of the experiment"}, v.quantity, true);
  f.number({"at", "strain or time (s) on a curve; its end if not given"}, v.at, scene::notNegative(unit::none));
  f.quantity({"value", "measured or wanted value"}, v.value);
  f.quantity({"uncertainty", "standard deviation; 1 % of the value if not given"}, v.uncertainty);
}
void describe(Fields& f, Search& v) {
  f.integer({"samples", "along each parameter from least to most"}, v.samples, 3, 1000);
  f.integer({"refinements", "number of times that the samples are refined about the best one"}, v.refinements, 0, 20);
}
void describe(Fields& f, Calibration& v) {
  f.includes({"include", "other files, whose keys come first"});
  f.text({"title", "for reports"}, v.title, false);
  f.parameters({"let", "parameters of expressions in this file"}, v.let);
  f.list({"experiments", "what is simulated"}, v.experiments, true);
  f.list({"parameters", "of the scenes, to be fitted; none: experiments are only run"}, v.parameters);
  f.list({"targets", "values that experiments should give"}, v.targets);
  f.object({"search", "samples the measure of all targets in place of fitting, and reports how flat its optimum is"},
           v.search);
  f.integer({"evaluations", "of the simulator at most; those in the cache are free"}, v.evaluations, 1, 1000000);
  f.number({"tolerance", "a fit ends when parameters, over most - least, or the sum of squares change by less"},
           v.tolerance, scene::between(0.0, 0.1, true));
}

double Target::deviation() const { return uncertainty.value > 0.0 ? uncertainty.value : 0.01 * std::abs(value.value); }

namespace {

void check(const Parameter& p) {
  if (!(p.least.value < p.most.value) || !(p.start.value >= p.least.value) || !(p.start.value <= p.most.value))
    throw InputError("\"start\" of " + p.key + " is " + formatNumber(p.start.value) + ", with bounds " +
                         formatNumber(p.least.value) + " and " + formatNumber(p.most.value),
                     p.where, "write least < most, and start between the two");
  for (const scene::Quantity& bound : {p.least, p.most})
    if (bound.dimension != p.start.dimension)
      throw InputError("bounds and start of " + p.key + " have different units", p.where, "give all the same unit");
}

void check(const Target& target, const Calibration& all) {
  const auto experiment = std::find_if(all.experiments.begin(), all.experiments.end(),
                                       [&](const Experiment& one) { return one.name == target.of; });
  if (experiment == all.experiments.end())
    throw InputError("there is no experiment \"" + target.of + "\"", target.where, "write the name of one");
  const auto wanted = dimensionOf(*experiment, target.quantity, target.where);
  for (const scene::Quantity& value : {target.value, target.uncertainty})
    if (wanted && value.dimension != unit::none && value.dimension != *wanted) {
      const std::string own = scene::siName(*wanted);
      throw InputError(target.quantity + " is given in " + scene::siName(value.dimension), target.where,
                       own.empty() ? "write a number without a unit" : "write it in " + own);
    }
  if (target.uncertainty.value < 0.0 || target.deviation() == 0.0)
    throw InputError("the uncertainty of " + target.quantity + " is " + formatNumber(target.uncertainty.value),
                     target.where, "give one above 0: a target of 0 has no percentage");
}

void check(const Calibration& all) {
  std::set<std::string> names;
  for (const Experiment& experiment : all.experiments) {
    io::requirePlainName(experiment.name, experiment.where);
    if (!names.insert(experiment.name).second)
      throw InputError("there are two experiments \"" + experiment.name + "\"", experiment.where,
                       "give them other names");
  }
  for (const Parameter& parameter : all.parameters) check(parameter);
  for (const Target& target : all.targets) check(target, all);
  if (all.parameters.empty()) return;
  if (all.targets.empty())
    throw InputError("there are parameters and no targets", all.parameters.front().where, "add targets");
  if (!all.search && all.targets.size() < all.parameters.size())
    throw InputError("there are " + std::to_string(all.parameters.size()) + " parameters and " +
                         std::to_string(all.targets.size()) + " targets",
                     all.parameters.front().where, "give as many targets as parameters at least");
}

void describeFile(Fields& f) {
  Calibration fresh;
  describe(f, fresh);
}

}  // namespace

Calibration readCalibration(const std::filesystem::path& file, const std::vector<std::string>& settings) {
  Calibration read;
  scene::readFields(scene::textOfFile(file), settings, [&](Fields& f) {
    read = {};
    describe(f, read);
  });
  check(read);
  return read;
}

std::string schemaText() { return scene::schemaText("calibration", describeFile); }
std::string referenceText() { return scene::referenceText("calibration", describeFile); }

}  // namespace dovetail::calibration
