// The C++ of the documents compiles, runs, and does what they say.
#include <gtest/gtest.h>

#include <cmath>

#include "dovetail/arlequin/arlequin_coupling.hpp"
#include "dovetail/arlequin/initial_equilibrium.hpp"
#include "dovetail/arlequin/weights.hpp"
#include "dovetail/cg/fields.hpp"
#include "dovetail/coupling/run.hpp"
#include "dovetail/dem/laws/contact_laws.hpp"
#include "dovetail/dem/laws/hertz_mindlin.hpp"
#include "dovetail/dem/laws/law_table.hpp"
#include "dovetail/dem/laws/materials.hpp"
#include "dovetail/dem/model/snapshot.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/dem/setup/packing.hpp"
#include "dovetail/dem/setup/relax.hpp"
#include "dovetail/dem/setup/streams.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/point_law.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/fem/solve/statics.hpp"
#include "dovetail/fem/terms/gradient_energy.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "dovetail/surface/surface_contact.hpp"

namespace dovetail {
namespace {

constexpr double width = 0.06, top = 0.04, depth = 0.02;  // m

/// Grains in a pit on a plane z = 0.
void fillPit(dem::Model& grains) {
  grains.laws = dem::makeContactLaws(dem::ElasticLaw{{.stiffness = 1e5, .restitution = 0.5}});
  grains.gravity = {0.0, 0.0, -9.81};
  dem::addPacking(grains.particles,
                  dem::fillWithLattice(dem::Lattice::simpleCubic, {{0, 0, 0}, {width, width, 0.06}}, 0.005, 0.01),
                  {2500.0});
  dem::addWall(grains, dem::makePlane({}, {0.0, 0.0, 1.0}));
}

fem::SolidMesh soilMesh() {
  return fem::boxOf(fem::ElementShape::hex8, {3, 3, 6}, {0, 0, -depth}, {width, width, top});
}

std::unique_ptr<fem::Model> soilOf(const fem::SolidMesh& mesh) {
  auto model = std::make_unique<fem::Model>(fem::makeModel(mesh));
  fem::fix(model->nodes, mesh.nodeSets.at("z-"));
  for (const char* side : {"x-", "x+"}) fem::fix(model->nodes, mesh.nodeSets.at(side), fem::componentX);
  for (const char* side : {"y-", "y+"}) fem::fix(model->nodes, mesh.nodeSets.at(side), fem::componentY);
  model->add(fem::gravity({0.0, 0.0, -9.81}));
  return model;
}

TEST(Recipes, ContactsOnASurfaceAndGrainsAddedByHand) {
  coupling::CoupledRun run;
  const dem::ElasticLaw one{{.stiffness = 1e4, .restitution = 0.5}};
  run.grains.laws = dem::makeContactLaws(dem::makeLawTable(2, [&](int, int) { return one; }));
  const fem::SolidMesh mesh = soilMesh();
  auto model = soilOf(mesh);
  model->add(fem::makeSolid(mesh, fem::pointMaterial(fem::neoHookean(5e6, 0.25, 1450.0))));
#include "coupling/surface.inc"
  EXPECT_EQ(run.solids(), 1U);
#include "coupling/step.inc"
  const Vec3 x{0.03, 0.03, 0.045}, v{0.0, 0.0, -0.1};
  const double radius = 0.004;
#include "coupling/insertion.inc"
  EXPECT_EQ(first, 0);
  run.advance(200);
  EXPECT_LT(std::abs(run.totals().massResidual), 1e-12);
}

TEST(Recipes, Overlap) {
  coupling::CoupledRun run;
  fillPit(run.grains);
  dem::removeWall(run.grains, dem::primitiveWall(run.grains, 0));
  const fem::SolidMesh mesh = soilMesh();
  auto model = soilOf(mesh);
  const auto law = fem::pointMaterial(fem::neoHookean(5e6, 0.25, 1450.0));
#include "coupling/overlap.inc"
  EXPECT_GT(run.grains.terms.all<arlequin::ArlequinCoupling>()[0]->state().members, 50U);
}

TEST(Recipes, EquilibriumAtTheStart) {
  coupling::CoupledRun run;
  fillPit(run.grains);
  const fem::SolidMesh mesh = soilMesh();
  auto model = soilOf(mesh);
  std::vector<double> place;
  for (const Vec3& X : mesh.X) place.push_back(X.z < -1e-9 ? arlequin::beyondOverlap : 1.0 - X.z / top);
  const std::vector<double> weight = arlequin::nodalWeights(place, {});
  model->add(fem::makeSolid(mesh, fem::pointMaterial(fem::neoHookean(5e6, 0.25, 1450.0)),
                            {.fraction = arlequin::solidWeights(weight)}));
#include "coupling/equilibrium.inc"
  EXPECT_TRUE(rest.atRest) << rest.residual;
  EXPECT_EQ(&side, &run.solid(0));
  run.advance(10);
  const coupling::Totals totals = run.totals();
  EXPECT_LT(norm(totals.residual.linear), 1e-11 * totals.turnedOver);
}

TEST(Recipes, ACantileverInPlaneStrain) {
#include "solid-meshes/mesh.inc"
  EXPECT_EQ(model.t, 1.0);
}

TEST(Recipes, BandsWithAWidth) {
  const auto soil = fem::pointMaterial(fem::neoHookean(5e6, 0.25, 1450.0));
#include "solid-meshes/bands.inc"
  EXPECT_EQ(model.terms.back()->name(), "gradient of F");
}

TEST(Recipes, ATableOfMaterials) {
  using namespace dem;
  Model model;
#include "contact-laws/table.inc"
  addParticle(model.particles, {}, {}, 1e-3, Density{glass.density});
  addParticle(model.particles, {1.99e-3, 0.0, 0.0}, {}, 1e-3, Density{steel.density});
  model.particles.material = {0, 1};
  findForces(model);
  EXPECT_LT(model.particles.f[0].x, 0.0);
}

TEST(Recipes, FieldsOfGrains) {
  dem::Model model;
  fillPit(model);
  dem::findForces(model);
  constexpr double diameter = 0.01;
  constexpr std::size_t p = 0;
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-result"  // it shows what there is
#include "coarse-graining/fields.inc"
#pragma GCC diagnostic pop
  EXPECT_GT(fields.density[p], 0.0);
}

TEST(Recipes, MaterialsByTheirEnergy) {
  const fem::SolidMesh mesh = soilMesh();
  {
#include "material-laws/material.inc"
    EXPECT_EQ(solid->size(), mesh.elementCount());
  }
}

namespace fibres {
#include "material-laws/fibres.inc"
}

TEST(Recipes, FibresPullBack) {
  const fem::SolidMesh mesh = fem::boxOf(fem::ElementShape::hex8, {1, 1, 1}, {}, {1.0, 1.0, 1.0});
  fem::Model model = fem::makeModel(mesh);
  model.add(fem::makeSolid(mesh, fibres::material));
  for (std::size_t n = 0; n < mesh.X.size(); ++n) model.nodes.u[n].x = 0.1 * mesh.X[n].x;
  fem::evaluateForces(model, {});
  double pull = 0.0;
  for (std::size_t n = 0; n < mesh.X.size(); ++n)
    if (mesh.X[n].x > 0.5) pull -= model.nodes.f[n].x;
  EXPECT_GT(pull, 4.0 * 5e6 * 0.21 * 1.1 * 0.99);
}

}  // namespace
}  // namespace dovetail
