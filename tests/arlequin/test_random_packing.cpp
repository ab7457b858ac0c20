// A random packing with friction under gravity, periodic sideways, whose lower part is handed over to a solid.
#include <gtest/gtest.h>

#include "dovetail/arlequin/arlequin_coupling.hpp"
#include "dovetail/arlequin/initial_equilibrium.hpp"
#include "dovetail/coupling/run.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/dem/pairs/contact_sample.hpp"
#include "dovetail/dem/setup/packing.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/fem/model/ties.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "scenes.hpp"

namespace dovetail::arlequin {
namespace {

using namespace test;

constexpr double side = 0.5, tall = 1.4, size = 0.25, grainDensity = 2500.0, fall = 9.81;  // m, m, m, kg/m³, m/s²
constexpr int layers = 3, below = 2;  // of elements within the overlap, and under it
/// At rest on a floor.
std::unique_ptr<coupling::CoupledRun> makePacking() {
  auto run = std::make_unique<coupling::CoupledRun>();
  dem::Model& grains = run->grains;
  const geometry::Periodicity space{{{0, 0, 0}, {side, side, tall}}, {true, true, false}};
  dem::PackingReport report;
  dem::addPacking(grains.particles,
                  dem::growPacking(dem::UniformSizes{0.04, 0.06}, space, {.solidFraction = 0.6}, report),
                  {grainDensity});
  grains.pairs.setPeriodicity(space);
  dem::FrictionalLaw law;
  law.normal = {.stiffness = 1e6, .restitution = 0.5};
  law.tangential = {.stiffness = 8e5, .friction = 0.5};
  grains.laws = dem::makeContactLaws(law);
  grains.gravity = {0, 0, -fall};
  grains.sortEvery = 0;
  dem::addWall(grains, dem::makePlane({0, 0, 0}, {0, 0, 1}));
  run->start(1e-4);
  EXPECT_TRUE(coupling::relax(*run, {.tolerance = 1e-10}).atRest);
  return run;
}

/// Mass of the grains between two heights over the volume there, kg/m³.
double bulkDensity(const dem::Particles& p, double lower, double upper) {
  double mass = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double r = p.radius[i];
    const auto under = [&](double z) {
      const double h = std::clamp(z - (p.x[i].z - r), 0.0, 2.0 * r);
      return h * h * (3.0 * r - h) / (4.0 * r * r * r);
    };
    mass += p.mass[i] * (under(upper) - under(lower));
  }
  return mass / (side * side * (upper - lower));
}

struct Scene {
  coupling::CoupledRun run;
  fem::SolidMesh mesh;
  std::vector<double> weight;
  ArlequinCoupling* tie = nullptr;
};

/// The packing without its floor, on a solid that carries what is handed over.
std::unique_ptr<Scene> handOver(const dem::Model& packing, ConstraintKind kind) {
  auto scene = std::make_unique<Scene>();
  dem::Model& grains = scene->run.grains;
  grains.particles = packing.particles;
  grains.pairs = packing.pairs;
  grains.laws = packing.laws;
  grains.gravity = packing.gravity;
  grains.sortEvery = 0;
  const double density = bulkDensity(grains.particles, 0.1, layers * size);
  scene->mesh =
      fem::boxOf(fem::ElementShape::hex8, {2, 2, layers + below}, {0, 0, -below * size}, {side, side, layers * size});
  std::vector<double> s;
  for (const Vec3& X : scene->mesh.X)
    s.push_back(X.z < -1e-9 ? beyondOverlap : std::clamp(1.0 - X.z / (layers * size), 0.0, 1.0));
  scene->weight = nodalWeights(s, {.floor = 0.01});
  auto solid = std::make_unique<fem::Model>(fem::makeModel(scene->mesh));
  fem::fix(solid->nodes, fem::nodeSet(scene->mesh, "z-"));
  const auto still = [](double) { return std::array<double, 9>{1, 0, 0, 0, 1, 0, 0, 0, 1}; };
  for (fem::Tie& tie : fem::periodicTies(scene->mesh, still, {true, true, false}).ties)
    if (solid->nodes.fixed[static_cast<std::size_t>(tie.node)] == 0) solid->constraints.ties.push_back(std::move(tie));
  solid->add(fem::makeSolid(scene->mesh, fem::pointMaterial(fem::Material(fem::StVenantKirchhoff{2e6, 0.2, density})),
                            {.fraction = solidWeights(scene->weight)}));
  solid->add(fem::gravity({0, 0, -fall}));
  fem::addMass(*solid);
  EXPECT_LT(initialEquilibrium(grains, scene->mesh, *solid, scene->weight), 10);
  coupling::SolidSide& partner = scene->run.addSolid(std::move(solid));
  CouplingOptions options;
  options.constraint = kind;
  auto tie = makeArlequinCoupling(grains, scene->mesh, scene->weight, partner, options);
  scene->tie = tie.get();
  grains.terms.add(std::unique_ptr<dem::Term>(std::move(tie)));
  scene->run.start(2e-5);
  scene->run.start(0.5 * scene->run.criticalStep().dt);
  return scene;
}

/// Through a layer of elements, by both models together, N.
struct Load {
  double carried;       ///< mean vertical force
  double above;         ///< weight of what the vertex shape function that rises from 0 to 1 over the layer holds
  double lower, upper;  ///< ends of the layer, m
};
Load loadThrough(const Scene& scene, int layer) {
  const double lower = layer * size;
  const coupling::SolidSide& solid = scene.run.solid(0);
  const dem::Particles& p = scene.run.grains.particles;
  const Overlap& overlap = scene.tie->overlap();
  const auto vertexShape = [&](double z) { return std::clamp((z - lower) / size, 0.0, 1.0); };
  std::vector<double> atNode, atParticle(p.size(), 1.0);
  for (const Vec3& X : scene.mesh.X) atNode.push_back(vertexShape(X.z));
  for (std::size_t k = 0; k < overlap.size(); ++k) {
    const Cell cell = cellOf(scene.mesh, overlap.place[k].element);
    double& value = atParticle[static_cast<std::size_t>(overlap.particle[k])] = 0.0;
    for (std::size_t a = 0; a < cell.node.size(); ++a)
      value += overlap.place[k].shape[a] * atNode[static_cast<std::size_t>(cell.node[a])];
  }
  Load load{};
  const dem::ContactSample contacts = scene.run.grains.laws->sample(p, scene.run.grains.pairs);
  for (std::size_t c = 0; c < contacts.size(); ++c)
    load.carried += contacts.force[c].z * (atParticle[static_cast<std::size_t>(contacts.first[c])] -
                                           atParticle[static_cast<std::size_t>(contacts.second[c])]);
  for (std::size_t i = 0; i < p.size(); ++i) load.above += fall * p.weightOf(i) * p.mass[i] * atParticle[i];
  std::vector<Vec3> force(atNode.size());
  solid.model->terms.front()->addForces(solid.nodes(), {}, force);
  for (std::size_t n = 0; n < force.size(); ++n) {
    load.carried += force[n].z * atNode[n];
    load.above += fall * solid.nodes().mass[n] * atNode[n];
    const double X = scene.mesh.X[n].z, x = X + solid.nodes().u[n].z;
    if (std::abs(X - lower) < 0.01 * size) load.lower = x;
    if (std::abs(X - lower - size) < 0.01 * size) load.upper = x;
  }
  return load;
}

class HandedOver : public testing::TestWithParam<ConstraintKind> {
protected:
  static void SetUpTestSuite() { packing_ = makePacking(); }
  static void TearDownTestSuite() { packing_.reset(); }
  static std::unique_ptr<coupling::CoupledRun> packing_;
};
std::unique_ptr<coupling::CoupledRun> HandedOver::packing_;

TEST_P(HandedOver, APackingStaysAtRestAndItsWeightGoesThrough) {
  const auto scene = handOver(packing_->grains, GetParam());
  for (int layer = 0; layer < layers; ++layer) {
    const Load load = loadThrough(*scene, layer);
    EXPECT_NEAR(load.carried / load.above, 1.0, 1e-3) << "the solid has taken over, layer " << layer;
  }
  // Elements balance the particles' loads together; one by one they find their balance by themselves.
  EXPECT_TRUE(coupling::relax(scene->run, {.tolerance = 1e-7}).atRest);
  scene->run.advance(500);
  const EnergyLedger& ledger = scene->run.ledger();
  const double elastic = ledger.joules("particles: contacts") + ledger.joules("solid: elastic");
  EXPECT_LT(scene->run.kineticEnergy(), 1e-6 * elastic);
  // What the packing carried there on its floor, averaged over the layer in the same way.
  const dem::Particles& p = packing_->grains.particles;
  for (int layer = 0; layer < layers; ++layer) {
    const Load load = loadThrough(*scene, layer);
    EXPECT_NEAR(load.carried / load.above, 1.0, 1e-4) << "layer " << layer;
    double weight = 0.0;
    for (std::size_t i = 0; i < p.size(); ++i)
      weight += fall * p.mass[i] * std::clamp((p.x[i].z - load.lower) / (load.upper - load.lower), 0.0, 1.0);
    EXPECT_NEAR(load.carried / weight, 1.0, 0.02) << "layer " << layer;
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, HandedOver, testing::Values(ConstraintKind::penalty, ConstraintKind::multiplier),
                         [](const auto& kind) {
                           return kind.param == ConstraintKind::penalty ? "penalty" : "multipliers";
                         });

}  // namespace
}  // namespace dovetail::arlequin
