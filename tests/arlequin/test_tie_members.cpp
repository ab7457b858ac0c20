// What a tie knows of its members one by one: sizes, newcomers, neighbours in other ties, and who is nobody's.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "dovetail/dem/bodies/body_term.hpp"
#include "dovetail/dem/setup/streams.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "tie_scenes.hpp"

namespace dovetail::arlequin {
namespace {

using namespace test;

/// Force at the held end of a bonded bar that is pulled at its grains' end by 4 %, with a loose grain in the overlap,
/// N.
double heldForce(double dust) {
  const double half = 0.25;
  TieRun run;
  run.grains.particles = lattice({-half, 0.0, -half}, {half, 2.5, half}, 2);
  run.grains.pairs.setSkin(0.02);
  dem::ElasticLaw law;
  law.normal.stiffness = modulus * 0.25;
  law.normal.bonded = true;
  run.grains.laws = dem::makeContactLaws(law);
  run.grains.sortEvery = 0;
  dem::findPairs(run.grains.particles, run.grains.pairs);
  if (dust > 0.0) {
    dem::addParticle(run.grains.particles, {0.0, 1.5, 0.0}, {}, dust, dem::Density{bulk});
    dem::findPairs(run.grains.particles, run.grains.pairs);
  }
  SceneOptions o;
  o.across = 1;
  const fem::SolidMesh mesh = barMesh(o);
  const std::vector<double> weight = barWeights(mesh, o);
  run.take(fem::makeModel(mesh));
  fem::fix(run.solid->nodes, fem::nodeSet(mesh, "y+"));
  const fem::StVenantKirchhoff law3{modulus, 0.0, bulk};
  run.solid->add(fem::makeSolid(mesh, fem::pointMaterial(fem::Material(law3)), {.fraction = solidWeights(weight)}));
  run.solid->add(fem::massDamping(40.0));
  run.couple(mesh, weight, {});
  const std::vector<std::int64_t> pulled(run.grains.particles.id.begin(), run.grains.particles.id.begin() + 4);
  constexpr double time = 0.4, way = 0.14;  // s, m
  run.grains.terms.add(dem::DriveTerm(
      pulled,
      [](double t) {
        return Vec3{0.0, -way * std::min(1.0, t / time), 0.0};
      },
      [](double t) {
        return Vec3{0.0, t < time ? -way / time : 0.0, 0.0};
      }));
  run.start(2.5e-4);
  run.run->advance(3200);
  double force = 0.0;
  constexpr int looks = 40;
  for (int k = 0; k < looks; ++k) {
    run.run->advance(20);
    for (const int n : fem::nodeSet(mesh, "y+")) force -= run.solid->nodes.f[static_cast<std::size_t>(n)].y / looks;
  }
  return force;
}

TEST(TieMembers, ASpeckOfDustDoesNotWeakenABar) {
  const double without = heldForce(0.0);
  EXPECT_GT(without, 5e3);
  for (const int part : {50, 100}) EXPECT_NEAR(heldForce(0.125 / part), without, 0.01 * without) << part;
}

/// Soil from −0.3 to its border within a box of 0.3 by 0.3 m, and grains in the lower part of the overlap.
struct Pit {
  coupling::CoupledRun run;
  fem::SolidMesh mesh;
  std::vector<double> weight;
  coupling::SolidSide* side = nullptr;
  ArlequinCoupling* tie = nullptr;

  explicit Pit(const Vec3& gravity, int layers) {
    constexpr double radius = 0.025, width = 0.3, top = 0.4;
    dem::Model& g = run.grains;
    dem::FrictionalLaw law;
    law.normal = {.stiffness = 5e4, .restitution = 0.3};
    law.tangential = {.stiffness = 2e4, .friction = 0.4};
    g.laws = dem::makeContactLaws(law);
    g.pairs.setSkin(0.005);
    g.gravity = gravity;
    for (int k = 0; k < layers; ++k)
      for (int j = 0; j < 6; ++j)
        for (int i = 0; i < 6; ++i)
          dem::addParticle(g.particles, {radius * (2 * i + 1), radius * (2 * j + 1), radius * (2 * k + 1)}, {},
                           0.999 * radius, dem::Density{2000});
    dem::switchOnRotation(g.particles);
    for (const auto& [place, normal] : {std::pair{Vec3{}, Vec3{1, 0, 0}},
                                        {Vec3{}, Vec3{0, 1, 0}},
                                        {Vec3{width, width, 0}, Vec3{-1, 0, 0}},
                                        {Vec3{width, width, 0}, Vec3{0, -1, 0}}})
      dem::addWall(g, dem::makePlane(place, normal));
    mesh = fem::boxOf(fem::ElementShape::hex8, {3, 3, 7}, {0, 0, -0.3}, {width, width, top});
    std::vector<double> place;
    for (const Vec3& X : mesh.X) place.push_back(X.z < -1e-9 ? beyondOverlap : std::clamp(1.0 - X.z / top, 0.0, 1.0));
    weight = nodalWeights(place, {});
    auto soil = std::make_unique<fem::Model>(fem::makeModel(mesh));
    soil->add(fem::makeSolid(mesh, fem::pointMaterial(fem::neoHookean(2e6, 0.2, 1100.0)),
                             {.fraction = solidWeights(weight)}));
    for (const char* set : {"x-", "x+", "y-", "y+", "z-"}) fem::fix(soil->nodes, mesh.nodeSets.at(set));
    side = &run.addSolid(std::move(soil), {.name = "soil"});
    tie = &g.terms.add(makeArlequinCoupling(g, mesh, weight, *side));
    g.refusesUnstableSteps = false;
  }
};

/// Σ of the forces on particles that all move by 1 m relative to the solid, N/m.
double stiffnessOf(const ArlequinCoupling& tie, const dem::Model& grains, std::size_t nodes) {
  std::vector<Vec3> moved(grains.particles.size(), Vec3{0, 0, 1}), still(nodes), f(moved.size()), onNodes(nodes);
  tie.addStiffness(grains, moved, still, f, onNodes);
  double sum = 0.0;
  for (const Vec3& force : f) sum += force.z;
  return sum;
}

TEST(TieMembers, PouredGrainsAtRestAreTiedAsOnesThatWereThere) {
  Pit pit({0.0, 0.0, -9.81}, 4);
  dem::Model& g = pit.run.grains;
  dem::addInsertion(g, {.region = {{0.03, 0.03, 0.3}, {0.27, 0.27, 0.5}},
                        .sizes = dem::UniformSizes{0.022, 0.025},
                        .density = {2000.0},
                        .velocity = {0.0, 0.0, -1.5},
                        .numberPerSecond = 900.0});
  pit.run.start(1e-4);
  pit.run.advance(3000);
  EXPECT_GT(pit.tie->state().admitted, 30);
  dem::Model copy = g;
  for (auto* tie : copy.terms.all<ArlequinCoupling>()) copy.terms.remove(*tie);
  copy.particles.weight.clear();
  dem::removeParticles(copy, particlesBeyond(copy, pit.mesh, pit.side->nodes(), pit.weight));
  coupling::SolidSide other;
  other.name = "soil";
  other.model = pit.side->model;
  other.mass = pit.side->mass;
  other.load = coupling::NodalLoad(pit.mesh.X.size());
  const auto fresh = makeArlequinCoupling(copy, pit.mesh, pit.weight, other);
  const double ratio = stiffnessOf(*pit.tie, g, pit.mesh.X.size()) / stiffnessOf(*fresh, copy, pit.mesh.X.size());
  EXPECT_GT(ratio, 0.95);
  EXPECT_LT(ratio, 1.1);
}

TEST(TieMembers, WhoIsNobodysWithinTheSolidIsCountedAndNamed) {
  Pit pit({}, 4);
  dem::Model& g = pit.run.grains;
  const std::vector<Vec3> ends{{-0.01, 0, 0}, {0.01, 0, 0}};
  const std::vector<double> radii{0.02, 0.02};
  dem::addClump(g, dem::makeClumpShape(ends, radii, {2000.0}), {0.15, 0.15, 0.45}, {}, {0, 0, -2.0});
  pit.run.start(1e-4);
  EXPECT_EQ(pit.tie->state().strangers, 0);
  const int added = dem::addParticle(g.particles, {0.15, 0.15, -0.15}, {}, 0.02, dem::Density{2000});
  const std::int64_t id = g.particles.id[static_cast<std::size_t>(added)];
  dem::admitParticles(g, static_cast<std::size_t>(added));
  pit.run.advance(2);
  EXPECT_EQ(pit.tie->state().strangers, 1);
  EXPECT_EQ(pit.tie->state().firstStranger, id);
  EXPECT_LT(norm(pit.tie->state().strangerAt - Vec3{0.15, 0.15, -0.15}), 1e-6);
  pit.run.advance(800);
  EXPECT_EQ(pit.tie->state().strangers, 3);  // both spheres of the clump
}

/// Two halves of one lattice, each tied to a solid of its own: pairs across have one weight, whoever is asked last.
TEST(TieMembers, PairsBetweenTwoTiesHaveTheMeanShare) {
  TieRun run;
  const double half = 0.25;
  run.grains.particles = lattice({-half, 0.0, -half}, {3 * half, 2.5, half}, 2);
  run.grains.pairs.setSkin(0.02);
  dem::ElasticLaw law;
  law.normal.stiffness = modulus * 0.25;
  run.grains.laws = dem::makeContactLaws(law);
  std::vector<ArlequinCoupling*> ties;
  SceneOptions o;
  o.across = 1;
  for (const double shift : {0.0, 0.5}) {
    fem::SolidMesh mesh = barMesh(o);
    for (Vec3& X : mesh.X) X += Vec3{shift, shift, 0.0};
    std::vector<double> weight;
    for (const Vec3& X : mesh.X) {
      const double place = (X.y - shift - solidStart(o)) / (o.overlapElements * edge);
      weight.push_back(place > 1.0 + 1e-9 ? beyondOverlap : place);
    }
    weight = nodalWeights(weight, {});
    auto model = std::make_unique<fem::Model>(fem::makeModel(mesh));
    const fem::StVenantKirchhoff law3{modulus, 0.0, bulk};
    model->add(fem::makeSolid(mesh, fem::pointMaterial(fem::Material(law3)), {.fraction = solidWeights(weight)}));
    coupling::SolidSide& side = run.run->addSolid(std::move(model), {.name = shift > 0.0 ? "right" : "left"});
    ties.push_back(&run.grains.terms.add(makeArlequinCoupling(run.grains, mesh, weight, side)));
  }
  run.grains.refusesUnstableSteps = false;
  run.run->start(1e-4);
  std::array<std::vector<std::uint8_t>, 2> tied;
  for (const std::size_t k : {0, 1}) {
    tied[k].assign(run.grains.particles.size(), 0);
    ties[k]->markTied(tied[k]);
  }
  std::size_t across = 0;
  for (const std::size_t last : {0, 1}) {
    ties[last]->neighbourListUpdated(run.grains);
    for (std::size_t p = 0; p < run.grains.pairs.size(); ++p) {
      const auto i = static_cast<std::size_t>(run.grains.pairs.pairs()[p][0]);
      const auto j = static_cast<std::size_t>(run.grains.pairs.pairs()[p][1]);
      const dem::Particles& g = run.grains.particles;
      if (!(tied[0][i] && tied[1][j]) && !(tied[1][i] && tied[0][j])) continue;
      ++across;
      EXPECT_EQ(run.grains.pairs.factors()[p], 0.5 * (g.weightOf(i) + g.weightOf(j)));
    }
  }
  EXPECT_GT(across, 20U);
}

}  // namespace
}  // namespace dovetail::arlequin
