#include "dovetail/scene/build.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/motion/stable_step.hpp"
#include "parts.hpp"

namespace dovetail::scene {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

void setLaws(dem::Model& grains, const Scene& scene) {
  if (scene.contact || !scene.contacts.empty()) {
    grains.laws = makeLaws(scene);
    return;
  }
  if (!scene.particles.empty() || !scene.clumps.empty() || !scene.insertions.empty())
    throw InputError("grains have no contact law", scene.steps.where, "give the scene a key \"contact\"");
  grains.laws = dem::makeContactLaws(dem::ElasticLaw{{.stiffness = 1.0}});  // of a scene without grains
}

std::vector<Limit> limitsOfSolids(Built& built, int stepsPerWindow) {
  std::vector<Limit> found;
  for (std::size_t s = 0; s < built.run->solids(); ++s) {
    coupling::SolidSide& side = built.run->solid(s);
    if (side.stepping == coupling::Stepping::implicitSteps) continue;
    const fem::ModelStableStep stable = fem::stableStep(*side.model);
    found.push_back(
        {"element " + std::to_string(stable.element) + " of \"" + side.name + "\"", stable.dt / stepsPerWindow});
  }
  return found;
}

}  // namespace

Built build(const Scene& scene) {
  if (scene.steps.threads > 0) setThreads(scene.steps.threads);
  Built built{std::make_unique<coupling::CoupledRun>(), {}, {}, {}};
  dem::Model& grains = built.run->grains;
  setLaws(grains, scene);
  grains.gravity = scene.gravity;
  if (scene.periodic) grains.pairs.setPeriodicity({scene.periodic->box, scene.periodic->axes});
  if (scene.domain)
    grains.domain =
        dem::Domain{scene.domain->box, scene.domain->removes ? dem::EscapePolicy::remove : dem::EscapePolicy::refuse};
  const Groups groups = addParticles(grains, scene, built.notes);
  if (std::isinf(grains.laws->reach())) dem::findPairs(grains.particles, grains.pairs);  // those that hold together
  addBondsAndDrives(grains, scene, groups, built.notes);
  addWalls(built, scene);
  addClumpsAndStreams(grains, scene);
  addSolids(built, scene);
  addCouplings(built, scene);
  return built;
}

void start(Built& built, const Scene& scene) {
  const coupling::RunOptions options{.stepsPerWindow = scene.steps.stepsPerWindow};
  atPlace(scene.steps.where, [&] {
    if (scene.steps.dt.word.empty()) return built.run->start(scene.steps.dt.number, options);
    built.run->start(1e-12, options);
    double smallest = infinity;
    for (const Limit& limit : limits(built, scene)) smallest = std::min(smallest, limit.dt);
    if (!std::isfinite(smallest))
      throw InputError("nothing in the scene tells a step", "", "give steps.dt a number, such as \"1e-4 s\"");
    built.run->start(scene.steps.safety * smallest, options);
  });
}

std::vector<Limit> limits(Built& built, const Scene& scene) {
  std::vector<Limit> found = limitsOfSolids(built, scene.steps.stepsPerWindow);
  found.push_back({"an impact of the smallest grains", impactLimit(scene, built.run->grains.particles)});
  const coupling::StepLimit now = built.run->criticalStep();
  found.push_back({"the whole as it is now (" + now.owner + ")", now.dt});
  return found;
}

}  // namespace dovetail::scene
