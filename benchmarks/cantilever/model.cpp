#include "model.hpp"

#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/fem/motion/stable_step.hpp"
#include "dovetail/scene/read.hpp"
#include "texts.hpp"

namespace dovetail::cantilever {

Model makeModel(const Settings& settings) {
  const double radius = 0.5 * Case{}.particleDiameter;
  if (const double overlap = particleMass() * Case{}.gravity / settings.contactStiffness(); overlap >= radius)
    throw InputError("the particles sink by " + formatNumber(overlap) + " m under their own weight",
                     "--stiffness-ratio",
                     "give at least " + formatNumber(2.0 * overlap / radius * settings.stiffnessRatio));
  Model model;
  model.scene = scene::sceneFromText(sceneText, "scenes/cantilever.json", ".", changesOfScene(settings));
  model.built = scene::build(model.scene);
  dem::Model& grains = model.run().grains;
  grains.sortEvery = 0;                 // particle 0 is the one in the tables
  grains.refusesUnstableSteps = false;  // chooseStep refuses them, wherever on the skin the particles will be
  model.beam = &model.run().solid(0);
  model.contact = grains.terms.all<surface::SurfaceContact>().front();
  return model;
}

StepLimit criticalStep(const Settings& settings, const Model& model) {
  const std::vector<double> inverseMass = [&] {
    const fem::Nodes& nodes = model.beam->nodes();
    std::vector<double> inverse(nodes.mass.size(), 0.0);
    for (std::size_t i = 0; i < inverse.size(); ++i)
      if (nodes.fixed[i] != fem::allComponents) inverse[i] = 1.0 / nodes.mass[i];
    return inverse;
  }();
  const double mobility = model.contact->coupling().largestMobility(inverseMass);
  const double contact = std::sqrt(settings.contactStiffness() * (1.0 / particleMass() + mobility));
  if (settings.implicit()) return {2.0 / contact, "contact of a particle with the skin"};
  const fem::StableStep solid = fem::stableStep(*model.beam->model);
  const std::string name = "element " + std::to_string(solid.element);
  const int K = settings.femEvery;
  if (K == 1) return {2.0 / std::hypot(contact, 2.0 / solid.dt), name + " with a contact on it"};
  if (2.0 / contact < solid.dt / K) return {2.0 / contact, "contact of a particle with the skin"};
  return {solid.dt / K, name + " (stepped every " + std::to_string(K) + ")"};
}

double chooseStep(const Settings& settings, const StepLimit& limit) {
  if (settings.dtAuto) return 0.9 * limit.dt;
  if (settings.dtCapped) return std::min(settings.dtFactor * contactTime(), limit.dt / 3.0);
  const double dt =
      settings.fractionOfCritical ? *settings.fractionOfCritical * limit.dt : settings.dtFactor * contactTime();
  if (dt > limit.dt && !settings.beyondCritical)
    throw InputError(
        "the time step " + formatNumber(dt) + " s is above the critical step " + formatNumber(limit.dt) +
            " s, set by " + limit.owner,
        "--dt-factor " + formatNumber(dt / contactTime()),
        "give at most " + formatNumber(std::floor(1e4 * limit.dt / contactTime()) / 1e4) + ", or --dt auto");
  return dt;
}

void requireFeasible(const Settings& settings, double dt) {
  constexpr double mostSteps = 1e10;
  const double steps = settings.until.value_or(longestRun) / dt;
  if (steps > mostSteps)
    throw InputError("up to " + formatNumber(std::round(steps)) + " steps are too many", "--until and the time step",
                     "give a softer contact (--stiffness-ratio), a larger step (--dt-factor) or an earlier end");
}

BeamCase beamCase(const Settings& settings) {
  BeamCase beam;
  beam.contactStiffness = settings.contactStiffness();
  return beam;
}

double lockingFactor(const Settings& settings) {
  if (settings.element != "hex8") return 1.0;
  const auto counts = settings.elements();
  const double hy = Case{}.length / counts[1], hz = Case{}.side / counts[2];
  return 1.0 + hy * hy / (hz * hz) / (2.0 * counts[2] * counts[2]);
}

}  // namespace dovetail::cantilever
