// The limit of the step: all connectors of a solid ask the same nodes, in steps and in macro steps.
#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
#include "dovetail/coupling/run.hpp"
#include "dovetail/dem/laws/laws.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/fem/terms/contact_plane.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "dovetail/surface/surface_contact.hpp"

namespace dovetail::coupling {
namespace {

struct Top {
  int couplings = 1;  ///< 1, 2 (an edge between them) or 4 (a corner)
  int K = 1;
  Stepping stepping = Stepping::explicitSteps;
};

/// Four heavy grains about the middle node of the top of a soft block, whose faces are shared out among couplings.
std::unique_ptr<CoupledRun> fourGrains(const Top& top) {
  auto run = std::make_unique<CoupledRun>();
  dem::ElasticLaw law;
  law.normal.stiffness = 1e7;
  run->grains.laws = dem::makeContactLaws(law);
  run->grains.pairs.setSkin(0.002);
  run->grains.gravity = {0, 0, -9.81};
  const fem::SolidMesh mesh = fem::boxOf(fem::ElementShape::hex8, {4, 4, 2}, {0.2, 0.2, -0.2}, {0.6, 0.6, 0});
  auto model = std::make_unique<fem::Model>(fem::makeModel(mesh));
  model->add(fem::makeSolid(mesh, fem::pointMaterial(fem::neoHookean(1e6, 0.3, 1000.0))));
  fem::addMass(*model);
  fem::fix(model->nodes, mesh.nodeSets.at("z-"));
  SolidSide& side = run->addSolid(std::move(model), {.name = "block", .stepping = top.stepping});
  std::vector<std::vector<fem::Face>> part(static_cast<std::size_t>(top.couplings));
  for (const fem::Face& face : mesh.faceSets.at("z+")) {
    Vec3 middle;
    for (std::size_t k = 0; k < 4; ++k) middle += 0.25 * mesh.X[static_cast<std::size_t>(face.node[k])];
    const std::size_t quarter = (middle.x > 0.4 ? 1U : 0U) + (middle.y > 0.4 ? 2U : 0U);
    part[quarter % part.size()].push_back(face);
  }
  for (const auto& faces : part)
    run->grains.terms.add(surface::SurfaceContact(
        side, surface::SurfaceCoupler(surface::makeSkin(mesh.X, faces, surface::QuadSplit::two)), run->grains.laws));
  for (const int a : {-1, 1})
    for (const int b : {-1, 1})
      dem::addParticle(run->grains.particles, {0.4 + 0.0125 * a, 0.4 + 0.0125 * b, 0.012 - 1e-5}, {}, 0.012,
                       dem::Mass{10.0});
  return run;
}

double elasticEnergy(CoupledRun& run) {
  return run.ledger().joules("particles: contacts") + run.ledger().joules("block: elastic");
}

struct Settled {
  double limit;
  std::vector<char> state;
};
/// At rest, with the limit there.
Settled settled(const Top& top) {
  const auto run = fourGrains(top);
  run->start(1e-5);
  run->start(0.5 * run->criticalStep().dt);
  EXPECT_TRUE(relax(*run, {.tolerance = 1e-12}).atRest);
  run->start(1e-5, {.stepsPerMacroStep = top.K});
  return {run->criticalStep().dt, run->save()};
}

/// Kinetic over elastic energy of a state that has come to rest at this step, after more of its steps.
double unrest(const Top& top, const Settled& from, double fraction, std::int64_t macroSteps) {
  const auto run = fourGrains(top);
  run->start(1e-5, {.stepsPerMacroStep = top.K});
  run->load(from.state);
  run->grains.refusesUnstableSteps = fraction < 1.0;
  run->start(fraction * from.limit, {.stepsPerMacroStep = top.K});
  try {
    relax(*run, {.tolerance = 1e-12, .steps = 500});
    run->advance(macroSteps);
  } catch (const NumericalError&) {
    return 1e30;
  }
  return run->kineticEnergy() / elasticEnergy(*run);
}

class Limits : public testing::TestWithParam<Top> {};

TEST_P(Limits, HoldAndAreNotFarFromWhereMotionGrows) {
  const Settled start = settled(GetParam());
  EXPECT_LT(unrest(GetParam(), start, 0.95, 500), 1e-8);
  EXPECT_GT(unrest(GetParam(), start, 1.0 / 0.7, 500), 1e-3);
  const auto run = fourGrains(GetParam());
  run->start(1e-5, {.stepsPerMacroStep = GetParam().K});
  run->load(start.state);
  EXPECT_THROW(run->start(1.05 * start.limit, {.stepsPerMacroStep = GetParam().K}), InputError);
}
INSTANTIATE_TEST_SUITE_P(MacroSteps, Limits,
                         testing::Values(Top{1, 1, Stepping::explicitSteps}, Top{4, 1, Stepping::explicitSteps},
                                         Top{2, 4, Stepping::explicitSteps}, Top{1, 1, Stepping::implicitSteps},
                                         Top{2, 4, Stepping::implicitSteps}, Top{4, 16, Stepping::implicitSteps}),
                         [](const auto& c) {
                           return std::string(c.param.stepping == Stepping::explicitSteps ? "explicit" : "implicit") +
                                  std::to_string(c.param.K) + "of" + std::to_string(c.param.couplings);
                         });

TEST(Limits, AreTheSameForAnyNumberOfCouplingsOnOneTop) {
  for (const Stepping stepping : {Stepping::explicitSteps, Stepping::implicitSteps})
    for (const int K : {1, 4, 16}) {
      const auto limitOf = [&](int couplings) {
        const auto run = fourGrains({couplings, K, stepping});
        run->start(1e-6, {.stepsPerMacroStep = K});
        return run->criticalStep().dt;
      };
      const double whole = limitOf(1);
      for (const int couplings : {2, 4}) EXPECT_NEAR(limitOf(couplings), whole, 1e-9 * whole) << K;
    }
}

/// Nobody touches the block at the start.
TEST(Limits, CountWhatIsYetToHitASolid) {
  for (const Stepping stepping : {Stepping::explicitSteps, Stepping::implicitSteps})
    for (const int K : {1, 4}) {
      const Top top{1, K, stepping};
      const auto touching = fourGrains(top), above = fourGrains(top);
      for (Vec3& x : above->grains.particles.x) x.z += 0.1;
      touching->start(1e-6, {.stepsPerMacroStep = K});
      above->start(1e-6, {.stepsPerMacroStep = K});
      const StepLimit limit = above->criticalStep();
      EXPECT_NE(limit.owner.find("an impact of particle"), std::string::npos) << limit.owner;
      // One at the lightest place of the surface, a corner, and four about the node in the middle of the top.
      EXPECT_NEAR(limit.dt / touching->criticalStep().dt, 0.85, 0.02);
      EXPECT_THROW(above->start(1.01 * limit.dt, {.stepsPerMacroStep = K}), InputError);
    }
}

TEST(Limits, AreLookedAtWhileARunGoesOn) {
  const Settled rest = settled({});
  for (const double fraction : {0.95, 1.05}) {
    const auto run = fourGrains({});
    run->start(1e-5);
    run->load(rest.state);
    run->grains.refusesUnstableSteps = false;
    run->start(fraction * rest.limit);
    run->grains.refusesUnstableSteps = true;
    run->advance(2048);
    EXPECT_EQ(run->grains.passed.has_value(), fraction > 1.0);
  }
}

/// Springs and planes that act on the nodes of an explicit solid, before anything touches.
TEST(Limits, CountSpringsAndPlanesOnSolids) {
  const auto limitWith = [](double springs, double penalty) {
    CoupledRun run;
    const fem::SolidMesh mesh = fem::boxOf(fem::ElementShape::hex8, {2, 2, 2}, {0, 0, 0}, {0.2, 0.2, 0.2});
    auto model = std::make_unique<fem::Model>(fem::makeModel(mesh));
    model->add(fem::makeSolid(mesh, fem::pointMaterial(fem::neoHookean(1e6, 0.3, 1000.0))));
    if (springs > 0.0) model->add(fem::groundSprings(mesh.nodeSets.at("z-"), {0, 0, springs}));
    if (penalty > 0.0)
      model->add(fem::makeContactPlane(mesh, mesh.faceSets.at("z-"), {{0, 0, -0.1}, {0, 0, 1}}, {.penalty = penalty}));
    fem::addMass(*model);
    run.addSolid(std::move(model), {.name = "block"});
    run.start(1e-9);
    return run.criticalStep();
  };
  const double free = limitWith(0.0, 0.0).dt, corner = 0.125;  // s, kg
  const StepLimit sprung = limitWith(1e6, 0.0), planed = limitWith(0.0, 1e9);
  EXPECT_NEAR(sprung.dt, 2.0 / std::sqrt(4.0 / (free * free) + 1e6 / corner), 1e-9 * free);
  EXPECT_NE(sprung.owner.find("ground springs"), std::string::npos) << sprung.owner;
  EXPECT_LT(planed.dt, 0.5 * free);
  EXPECT_NE(planed.owner.find("contact plane"), std::string::npos) << planed.owner;
}

}  // namespace
}  // namespace dovetail::coupling
