#include "features.hpp"

#include "dem/scenes.hpp"
#include "dovetail/coupling/run.hpp"
#include "dovetail/dem/laws/laws.hpp"
#include "dovetail/dem/laws/rolling.hpp"
#include "dovetail/dem/setup/streams.hpp"

namespace dovetail::overhead {

namespace {

using dem_benchmark::timeStep, dem_benchmark::stiffness;

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

using Change = std::function<void(dem::Model&)>;

Scene latticeWith(int edge, const Change& change) {
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

void addUntouchedWall(dem::Model& m) {
  dem::addWall(m, dem::makeSphere({}, 0.1, false)).skin = dem_benchmark::listSkin;  // between the spheres
}

void addSecondMaterial(dem::Model& m) {
  m.laws = dem::makeContactLaws(dem::LawTable<dem::ElasticLaw>(2, dem::ElasticLaw{{stiffness}}));
}

constexpr dem::LinearSpringDashpot dashpot{.stiffness = stiffness, .restitution = 0.5};
constexpr dem::TangentialSpring friction{.stiffness = 2.0 / 7.0 * stiffness, .friction = 0.5};

void addFriction(dem::Model& m) { m.laws = dem::makeContactLaws(dem::FrictionalLaw{dashpot, friction}); }

void addRolling(dem::Model& m) {
  dem::ContactLaw<dem::LinearSpringDashpot, dem::TangentialSpring, dem::RollingAndTwisting> law{dashpot, friction};
  law.rolling = {{.friction = 0.1, .stiffnessRatio = 0.2}, {.friction = 0.1, .stiffnessRatio = 0.1}};
  m.laws = dem::makeContactLaws(law);
}

void layBetweenWalls(dem::Model& m) {
  geometry::Periodicity sideways = m.pairs.periodicity();
  sideways.axes[2] = false;
  m.pairs.setPeriodicity(sideways);
  m.gravity = {0, 0, -1e-3};
  dem::addWall(m, dem::makePlane(sideways.box.lower, {0, 0, 1})).skin = dem_benchmark::listSkin;
  dem::addWall(m, dem::makePlane(sideways.box.upper, {0, 0, -1})).skin = dem_benchmark::listSkin;
}

}  // namespace

std::vector<Feature> featuresOf(int edge, int steps, int turns) {
  const double beyond = 10.0 * edge;
  const Change nothing = [](dem::Model&) {};
  const Change outlet = [&](dem::Model& m) {
    dem::addOutlet(m, geometry::Box{{beyond, beyond, beyond}, {beyond + 1.0, beyond + 1.0, beyond + 1.0}});
  };
  const Change booking = [](dem::Model& m) { m.booking = dem::Booking::on; };
  const Scene bare = latticeWith(edge, nothing);
  const double grains = static_cast<double>(edge) * edge * edge;
  std::vector<Feature> features;
  const auto compare = [&](const char* name, bool used, const Scene& with) {
    const Duel time = duel(
        turns, [&] { bare.advance(steps); }, [&] { with.advance(steps); });
    features.push_back({name, used, time, (with.bytes - bare.bytes) / grains});
  };
  compare("nothing", false, latticeWith(edge, nothing));
  compare("a wall that nobody touches", false, latticeWith(edge, addUntouchedWall));
  compare("an outlet that nobody reaches", false, latticeWith(edge, outlet));
  compare("a second contact material that nobody has", false, latticeWith(edge, addSecondMaterial));
  compare("the coupled run without solids", false, inCoupledRun(edge));
  compare("energies booked", true, latticeWith(edge, booking));
  compare("friction, spins, dashpots", true, latticeWith(edge, addFriction));
  compare("the same with rolling and twisting", true, latticeWith(edge, addRolling));
  compare("gravity, between two walls", true, latticeWith(edge, layBetweenWalls));
  return features;
}

}  // namespace dovetail::overhead
