// Solids that take over a bed: at the time of their state, and for any bed at rest.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "dovetail/arlequin/initial_equilibrium.hpp"
#include "dovetail/arlequin/weights.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/dem/laws/laws.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/dem/setup/relax.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/fem/terms/loads.hpp"

namespace dovetail::arlequin {
namespace {

constexpr double side = 0.4, diameter = 0.1;  // m

/// Grains of several sizes at rest in a box that is open below by now.
dem::Model bed() {
  dem::Model grains;
  dem::FrictionalLaw law;
  law.normal = {.stiffness = 5e4, .restitution = 0.3};
  law.tangential = {.stiffness = 2e4, .friction = 0.4};
  grains.laws = dem::makeContactLaws(law);
  grains.pairs.setSkin(0.01);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int k = 0; k < 8; ++k)
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i) {
        const double x = diameter * (i + 0.5) + 0.01 * any(random), y = diameter * (j + 0.5) + 0.01 * any(random);
        dem::addParticle(grains.particles, {x, y, diameter * (k + 0.5)}, {},
                         0.5 * diameter * (1.0 - 0.1 * std::abs(any(random))), dem::Density{2000});
      }
  dem::switchOnRotation(grains.particles);
  grains.gravity = {0.0, 0.0, -9.81};
  const Vec3 far{side, side, 0.0};
  for (const auto& [place, normal] : {std::pair{Vec3{}, Vec3{1, 0, 0}},
                                      {Vec3{}, Vec3{0, 1, 0}},
                                      {far, Vec3{-1, 0, 0}},
                                      {far, Vec3{0, -1, 0}},
                                      {Vec3{}, Vec3{0, 0, 1}}})
    dem::addWall(grains, dem::makePlane(place, normal));
  dem::relax(grains, {.tolerance = 1e-4, .steps = 60000});
  dem::removeWall(grains, dem::primitiveWall(grains, 4));
  return grains;
}

/// Soil below the bed and in its lower half.
struct Soil {
  fem::SolidMesh mesh;
  std::vector<double> weight;
  fem::Model model;

  Soil(int layers, double young)
      : mesh(fem::boxOf(fem::ElementShape::hex8, {2, 2, layers + 2}, {0, 0, -2 * side / layers}, {side, side, side})) {
    std::vector<double> place;
    for (const Vec3& X : mesh.X) place.push_back(X.z < -1e-9 ? beyondOverlap : std::clamp(1.0 - X.z / side, 0.0, 1.0));
    weight = nodalWeights(place, {.floor = 0.02});
    model = fem::makeModel(mesh);
    model.add(fem::makeSolid(mesh, fem::pointMaterial(fem::neoHookean(young, 0.2, 1100.0)),
                             {.fraction = solidWeights(weight)}));
    model.add(fem::gravity({0.0, 0.0, -9.81}));
    for (const char* set : {"x-", "x+"}) fem::fix(model.nodes, mesh.nodeSets.at(set), fem::componentX);
    for (const char* set : {"y-", "y+"}) fem::fix(model.nodes, mesh.nodeSets.at(set), fem::componentY);
  }
  void hold() { fem::fix(model.nodes, mesh.nodeSets.at("z-")); }
  int initialEquilibrium(const dem::Model& grains, double* change = nullptr) {
    return arlequin::initialEquilibrium(grains, mesh, model, weight, {.leastWeight = 0.02}, change);
  }
  double sunk() const {
    double least = 0.0;
    for (const Vec3& u : model.nodes.u) least = std::min(least, u.z);
    return -least;
  }
};

TEST(InitialEquilibriumTime, RampsAndPathsAreThoseOfTheState) {
  const dem::Model grains = bed();
  constexpr double time = 0.03, rate = -1e4, speed = -0.1;  // s, N/s, m/s
  const auto sunkUnder = [&](const std::function<double(double)>& load, const std::function<double(double)>& path,
                             double now) {
    Soil soil(2, 1e6);
    soil.model.add(fem::nodalForce(soil.mesh.nodeSets.at("z+"), {0.0, 0.0, 1.0}, fem::Amplitude(load)));
    soil.model.constraints.prescribe(soil.mesh.nodeSets.at("z-"), 2, path);
    soil.model.t = now;
    soil.initialEquilibrium(grains);
    EXPECT_EQ(soil.model.t, now);
    return soil.sunk();
  };
  const auto always = [](double value) { return [value](double) { return value; }; };
  const auto ramp = [](double slope) { return [slope](double t) { return slope * t; }; };
  const double still = sunkUnder(always(0.0), always(0.0), 0.0);
  EXPECT_NEAR(sunkUnder(ramp(rate), ramp(speed), 0.0), still, 1e-9 * still);
  const double moved = sunkUnder(always(rate * time), always(speed * time), 0.0);
  EXPECT_GT(moved, 1.1 * still);
  EXPECT_NEAR(sunkUnder(ramp(rate), ramp(speed), time), moved, 1e-9 * moved);
}

/// Of these moduli there are ones for which a grain gives now one, now another weight as it passes a face of an
/// element.
TEST(InitialEquilibriumEnds, ForEveryBedAtRest) {
  const dem::Model grains = bed();
  for (const int layers : {3, 4})
    for (int e = 0; e < 12; ++e) {
      Soil soil(layers, 3e4 * std::pow(1.12, e));
      soil.hold();
      double change = 1.0;
      EXPECT_NO_THROW(EXPECT_LT(soil.initialEquilibrium(grains, &change), 80)) << layers << ' ' << e;
      EXPECT_LT(change, 0.02);
    }
}

TEST(InitialEquilibriumEnds, OrTellsHowMuchChanged) {
  Soil soil(2, 1e6);
  soil.hold();
  try {
    initialEquilibrium(bed(), soil.mesh, soil.model, soil.weight,
                       {.tolerance = 1e-12, .rounds = 2, .leastWeight = 0.02});
    ADD_FAILURE();
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("after 2 rounds the load of the particles still changes by"),
              std::string::npos)
        << error.what();
  }
  EXPECT_EQ(soil.model.terms.size(), 2U);
}

}  // namespace
}  // namespace dovetail::arlequin
