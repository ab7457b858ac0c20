#include "idle_features.hpp"

#include "dem/scenes.hpp"
#include "dovetail/coupling/run.hpp"
#include "dovetail/dem/laws/laws.hpp"
#include "dovetail/dem/setup/streams.hpp"

namespace dovetail::atlas {

namespace {

using dem_benchmark::timeStep;

struct Scene {
  std::function<void(int)> advance;  ///< by so many steps
  double bytes = 0.0;                ///< allocated after a few steps
};

/// Makes a scene and lets it take its first steps, so that all it needs is there.
template <class Make>
Scene sceneOf(Make make) {
  const double before = allocated();
  Scene scene{make(), 0.0};
  scene.advance(20);
  scene.bytes = allocated() - before;
  return scene;
}

template <class Change>
Scene latticeWith(int edge, Change change) {
  return sceneOf([&]() -> std::function<void(int)> {
    const auto model = std::make_shared<dem::Model>(dem_benchmark::waveLattice(edge, edge, edge));
    change(*model);
    return [model](int steps) {
      for (int s = 0; s < steps; ++s) advance(*model, timeStep);
    };
  });
}

Scene inCoupledRun(int edge) {
  return sceneOf([&]() -> std::function<void(int)> {
    const auto run = std::make_shared<coupling::CoupledRun>(dem_benchmark::waveLattice(edge, edge, edge));
    run->start(timeStep);
    return [run](int steps) { run->advance(steps); };
  });
}

void addUnreachedOutlet(dem::Model& model, int edge) {
  const double beyond = 10.0 * edge;
  dem::addOutlet(model, geometry::Box{{beyond, beyond, beyond}, {beyond + 1.0, beyond + 1.0, beyond + 1.0}});
}

void addSecondMaterial(dem::Model& model) {
  const dem::ElasticLaw law{{dem_benchmark::stiffness}};
  model.laws = dem::makeContactLaws(dem::LawTable<dem::ElasticLaw>(2, law));
}

}  // namespace

std::vector<IdleFeature> idleFeatures(int edge, int steps, int turns) {
  const auto wall = [](dem::Model& m) {
    dem::addWall(m, dem::makeSphere({}, 0.1, false)).skin = dem_benchmark::listSkin;  // between the spheres
  };
  const std::vector<std::pair<std::string, std::function<Scene()>>> scenes{
      {"nothing", [&] { return latticeWith(edge, [](dem::Model&) {}); }},
      {"a wall that nobody touches", [&] { return latticeWith(edge, wall); }},
      {"an outlet that nobody reaches",
       [&] { return latticeWith(edge, [&](dem::Model& m) { addUnreachedOutlet(m, edge); }); }},
      {"a second contact material that nobody has", [&] { return latticeWith(edge, addSecondMaterial); }},
      {"the coupled run without solids", [&] { return inCoupledRun(edge); }}};
  const Scene bare = latticeWith(edge, [](dem::Model&) {});
  const double grains = static_cast<double>(edge) * edge * edge;
  std::vector<IdleFeature> features;
  for (const auto& [name, make] : scenes) {
    const Scene with = make();
    const Duel time = duel(
        turns, [&] { bare.advance(steps); }, [&] { with.advance(steps); });
    features.push_back({name, time, (with.bytes - bare.bytes) / grains});
  }
  return features;
}

}  // namespace dovetail::atlas
