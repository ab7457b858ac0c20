// Material points beside what else a run may hold.
#include <gtest/gtest.h>

#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/coupling/run.hpp"
#include "dovetail/dem/laws/laws.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/mesh/mesh_shapes.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "dovetail/mpm/point_contact.hpp"
#include "dovetail/surface/surface_contact.hpp"
#include "random_points.hpp"

namespace dovetail::mpm::test {
namespace {

using coupling::CoupledRun;

constexpr double spacing = 0.125;
const double stiff = 1.35e6 * spacing;

struct Body {
  std::shared_ptr<PointSolid> points;
  coupling::SolidSide* side = nullptr;
};

Body addBlock(CoupledRun& run, const Vec3& low, const Vec3& v, const Vec3& g,
              const std::vector<GridBorder>& borders = {}, Transfer transfer = Transfer::apic) {
  MaterialPoints points = block(low, {0.5, 0.5, 0.5}, spacing, false);
  for (Vec3& velocity : points.v) velocity = v;
  Body body{makePoints(
      points, elastic(),
      {.grid = {.spacing = 2.0 * spacing, .plane = false, .origin = low, .borders = borders}, .transfer = transfer})};
  auto model = std::make_unique<fem::Model>(makeModel(body.points));
  model->add(gravity(body.points, g));
  body.side = &run.addSolid(std::move(model), {.name = run.solids() == 0 ? "points" : "more points"});
  return body;
}

void expectBalance(CoupledRun& run, double books) {
  const coupling::Totals totals = run.totals();
  EXPECT_LE(norm(totals.residual.linear), 1e-12 * totals.turnedOver);
  EXPECT_LE(norm(totals.residual.angular), 1e-11 * totals.turnedOverAngular);
  EXPECT_LE(std::abs(run.ledger().residual()), books);
}

/// Points fall on the skin of a slab that is held below, whose grid of elements is finer, with grains in between.
TEST(PointsTogether, MeetSkinsOfElementsAndGrains) {
  for (const int K : {1, 3}) {
    CoupledRun run;
    const auto laws = dem::makeContactLaws(dem::FrictionalLaw{{stiff}, {0.8 * stiff, 0.3}});
    run.grains.laws = laws;
    run.grains.gravity = {0.0, 0.0, -9.81};
    const fem::SolidMesh mesh = fem::boxOf(fem::ElementShape::hex8, {6, 6, 2}, {-0.2, -0.2, -0.3}, {0.7, 0.7, 0.0});
    auto slab = std::make_unique<fem::Model>(fem::makeModel(mesh));
    slab->add(fem::makeSolid(mesh, fem::pointMaterial(fem::neoHookean(1e6, 0.3, 1000.0))));
    slab->add(fem::gravity({0.0, 0.0, -9.81}));
    slab->constraints.hold(fem::nodeSet(mesh, "z-"));
    auto& below = run.addSolid(std::move(slab), {.name = "slab"});
    run.grains.terms.add(surface::SurfaceContact(
        below, surface::SurfaceCoupler(surface::makeSkin(mesh.X, fem::faceSet(mesh, "z+"))), laws));
    const Body body = addBlock(run, {0.0, 0.0, 0.12}, {0.3, 0.0, -2.0}, run.grains.gravity);
    for (int i = 0; i < 3; ++i)
      dem::addParticle(run.grains.particles, {0.1 + 0.15 * i, 0.1 + 0.1 * i, 0.051}, {}, 0.05, dem::Density{2000.0});
    addSpheres(run.grains, *body.side, body.points, {.radius = 0.5 * spacing});
    run.start(3e-4 / K, {.stepsPerMacroStep = K});
    const double moved = run.kineticEnergy();
    run.advance(1000);
    EXPECT_GT(body.points->renewals(), 2);
    expectBalance(run, 2e-3 * moved);
  }
}

/// Two bodies fly at each other: the limit of the step is known before they touch, and points of one body, which never
/// meet, set none.
TEST(PointsTogether, KnowTheStepBeforeTwoBodiesMeet) {
  for (const bool both : {false, true}) {
    CoupledRun run;
    run.grains.laws = dem::makeContactLaws(dem::ElasticLaw{{20.0 * stiff}});
    const Body left = addBlock(run, {}, {2.0, 0.0, 0.0}, {});
    const Body right = addBlock(run, {0.64, 0.0, 0.0}, {-2.0, 0.0, 0.0}, {});
    addSpheres(run.grains, *left.side, left.points, {.radius = 0.5 * spacing});
    if (both) addSpheres(run.grains, *right.side, right.points, {.radius = 0.5 * spacing});
    run.start(1e-4);
    const StepLimit before = run.criticalStep();
    double least = before.dt;
    for (int k = 0; k < 40; ++k) {
      run.advance(15);
      least = std::min(least, run.criticalStep().dt);
    }
    EXPECT_LE(before.dt, 1.6 * least);
    EXPECT_EQ(before.owner.find("an impact") != std::string::npos, both) << before.owner;
  }
}

/// To rest on a rigid floor: the floor carries the weight. Nodes at edges, which weigh little, swing for long.
TEST(PointsTogether, ComeToRest) {
  for (const Transfer transfer : {Transfer::apic, Transfer::flip}) {
    CoupledRun run;
    run.grains.laws = dem::makeContactLaws(dem::ElasticLaw{{stiff}});
    dem::addWall(run.grains, dem::makePlane({}, {0.0, 0.0, 1.0}));
    const Body body = addBlock(run, {}, {}, {0.0, 0.0, -9.81}, {}, transfer);
    addSpheres(run.grains, *body.side, body.points, {.radius = 0.5 * spacing});
    run.start(1e-3);
    const RestReport report = coupling::relax(run, {.tolerance = 1e-4});
    EXPECT_TRUE(report.atRest);
    const double weight = 1000.0 * 0.125 * 9.81;
    EXPECT_NEAR(-dem::primitiveWall(run.grains, 0).force.z, weight, 1e-3 * weight);
    expectBalance(run, 1e-3 * weight * 0.01);
  }
}

TEST(PointsTogether, GoOnAfterLoadSteps) {
  CoupledRun run;
  run.grains.laws = dem::makeContactLaws(dem::ElasticLaw{{stiff}});
  const std::vector<GridBorder> borders{{.axis = 0}, {.axis = 1}, {.axis = 2}};
  const Body body = addBlock(run, {}, {}, {0.0, 0.0, -9.81}, borders);
  run.start(3e-4);
  for (int step = 0; step < 4; ++step) run.loadStep(step, 4, 0.0);
  const std::vector<Vec3> stood = body.points->places(body.side->nodes());
  run.advance(200);
  const std::vector<Vec3> stands = body.points->places(body.side->nodes());
  double worst = 0.0;
  for (std::size_t p = 0; p < stood.size(); ++p) worst = std::max(worst, norm(stands[p] - stood[p]));
  EXPECT_LE(worst, 1e-7);
  expectBalance(run, 1e-2);
}

/// Grains and spheres of points meet across a period, whose box knows nothing of the grid.
TEST(PointsTogether, CrossPeriods) {
  CoupledRun run;
  run.grains.laws = dem::makeContactLaws(dem::FrictionalLaw{{stiff}, {0.8 * stiff, 0.3}});
  run.grains.pairs.setPeriodicity({{{-0.1, -1.0, -1.0}, {1.1, 2.0, 2.0}}, {true, false, false}});
  const Body body = addBlock(run, {}, {6.0, 0.0, 0.0}, {});
  dem::addParticle(run.grains.particles, {0.9, 0.2, 0.3}, {}, 0.08, dem::Density{2000.0});
  addSpheres(run.grains, *body.side, body.points, {.radius = 0.5 * spacing});
  run.start(3e-4);
  run.advance(1500);
  const std::vector<Vec3> places = body.points->places(body.side->nodes());
  EXPECT_GT(places.front().x, 1.2);
  const coupling::Totals totals = run.totals();
  EXPECT_LT(totals.ontoSolids.x, 0.0);
  EXPECT_LE(norm(totals.residual.linear), 1e-12 * totals.turnedOver);
  EXPECT_LE(std::abs(run.ledger().residual()), 1.0);
}

}  // namespace
}  // namespace dovetail::mpm::test
