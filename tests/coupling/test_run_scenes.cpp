// Scenes as users make them: grains with friction, walls, clumps and insertion on a deformable block, and what is left
// of such a scene when parts are missing, come late or leave.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "dovetail/core/error.hpp"
#include "full_scene.hpp"

namespace dovetail::coupling {
namespace {

class Scenes : public testing::TestWithParam<Case> {
protected:
  static std::unique_ptr<CoupledRun> started(double step = dt) {
    auto run = fullRun({.name = "block", .stepping = GetParam().stepping});
    run->start(step, {.stepsPerMacroStep = GetParam().K});
    return run;
  }
};
INSTANTIATE_TEST_SUITE_P(MacroSteps, Scenes, macroCases, [](const auto& c) { return c.param.name; });

/// Energy that has been lost or stored since, which a residual is small against.
double turnedOver(CoupledRun& run) {
  const EnergyLedger& ledger = run.ledger();
  return ledger.joules("particles: dashpots") + ledger.joules("particles: friction") +
         ledger.joules("particles: rolling");
}

TEST_P(Scenes, TheBooksOfEverythingClose) {
  const auto run = started();
  const double mass = run->totals().mass;
  run->advance(2000 / GetParam().K);
  EXPECT_GT(turnedOver(*run), 0.5);
  EXPECT_LT(std::abs(run->ledger().residual()), 1e-2 * turnedOver(*run)) << run->ledger();
  EXPECT_GT(run->grains.entered.count, 20);
  EXPECT_GT(run->grains.left.count, 0);
  EXPECT_NEAR(run->totals().mass, mass + run->grains.entered.mass - run->grains.left.mass, 1e-12 * mass);
}

TEST_P(Scenes, GoOnFromAStateWithTheSameDigits) {
  const auto whole = started(), parted = started();
  whole->advance(1000 / GetParam().K);
  const std::vector<char> state = whole->save();
  parted->load(state);
  EXPECT_EQ(parted->save(), state);
  for (CoupledRun* run : {whole.get(), parted.get()}) run->advance(1000 / GetParam().K);
  EXPECT_EQ(whole->save(), parted->save());
  EXPECT_EQ(whole->ledger().residual(), parted->ledger().residual());
}

TEST_P(Scenes, AStateOfAnotherSceneIsRefusedAndNothingChanges) {
  const auto run = started();
  const auto other = emptyRun();
  addBlock(*other, {.name = "block", .stepping = GetParam().stepping});
  other->start(dt, {.stepsPerMacroStep = GetParam().K});
  run->advance(10);
  const std::vector<char> before = run->save();
  std::vector<char> cut = before;
  cut.resize(cut.size() / 2);
  EXPECT_THROW(run->load(other->save()), InputError);
  EXPECT_THROW(run->load(cut), InputError);
  EXPECT_EQ(run->save(), before);
}

TEST_P(Scenes, AreEmptiedAndFilledAgain) {
  const auto run = started();
  run->advance(800 / GetParam().K);
  const EnergyLedger& ledger = run->ledger();
  std::vector<int> all(run->grains.particles.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  dem::removeParticles(run->grains, all);
  EXPECT_EQ(run->grains.particles.size(), 0u);
  run->advance(400 / GetParam().K);
  const auto refilled = run->grains.particles.size();
  EXPECT_GT(refilled, 4u) << "the insertion goes on";
  run->advance(800 / GetParam().K);
  EXPECT_LT(std::abs(run->ledger().residual()), 1e-2 * turnedOver(*run)) << ledger;
}

TEST_P(Scenes, ABrokenRunGoesOnFromItsLastState) {
  const auto run = started();
  run->advance(100);
  const std::vector<char> state = run->save();
  for (const bool solid : {false, true}) {
    (solid ? run->solid(0).nodes().v[30] : run->grains.particles.v[3]).x = std::nan("");
    EXPECT_THROW(run->advance(3), NumericalError);
    run->load(state);
    EXPECT_EQ(run->save(), state);
    run->advance(100);
    EXPECT_LT(std::abs(run->ledger().residual()), 1e-2 * turnedOver(*run));
  }
}

/// Half of the step from here on: losses so far stay in the ledger.
TEST_P(Scenes, StepsAndWindowsChangeInFlight) {
  const auto run = started();
  run->advance(1000 / GetParam().K);
  const double before = run->ledger().residual();
  run->start(0.5 * dt, {.stepsPerMacroStep = GetParam().K == 1 ? 3 : 1});
  EXPECT_NEAR(run->ledger().residual(), before, 2e-3 * turnedOver(*run));
  run->advance(1000 / GetParam().K);
  EXPECT_LT(std::abs(run->ledger().residual()), 1e-2 * turnedOver(*run)) << run->ledger();
}

TEST(Scene, OfGrainsAloneIsTheModelsOwnRun) {
  const auto run = emptyRun();
  addLayer(*run, 12);
  dem::addWall(run->grains, dem::makePlane({}, {0, 0, 1}));
  dem::Model alone = run->grains;
  run->start(dt);
  run->advance(500);
  dem::run(alone, dt, 500);
  EXPECT_EQ(run->grains.particles.x, alone.particles.x);
  EXPECT_EQ(run->grains.particles.omega, alone.particles.omega);
  EXPECT_EQ(run->solids(), 0u);
}

TEST(Scene, OfASolidAloneMovesItself) {
  CoupledRun run;
  SolidSide& side = run.addSolid(block(tetBlock(), true), {.name = "block"});
  for (Vec3& v : side.nodes().v) v.z = -0.1;
  fem::fix(side.nodes(), tetBlock().nodeSets.at("z-"));
  run.start(dt);
  run.advance(200);
  EXPECT_GT(run.ledger().joules("block: elastic"), 0.05 * run.ledger().storedAtOpening());
  EXPECT_LT(std::abs(run.ledger().residual()), 1e-2 * run.ledger().storedAtOpening());
}

TEST(Scene, ReportsWhatItHoldsAndHasComeTo) {
  const auto run = emptyRun();
  addBlock(*run);
  addLayer(*run, 12);
  run->profile = Profile(true);
  run->grains.profile = &run->profile;
  run->start(dt);
  run->advance(50);
  std::ostringstream out;
  report(*run, out);
  for (const char* word : {"12 particles", "\"block\" of", "set by", "block: elastic", "residual", "momentum", "pairs"})
    EXPECT_NE(out.str().find(word), std::string::npos) << word << " in\n" << out.str();
}

TEST(Scene, OfNothingPassesTheTime) {
  CoupledRun run;
  run.start(dt);
  run.advance(10);
  EXPECT_NEAR(run.time(), 10 * dt, 1e-15);
  EXPECT_EQ(run.ledger().residual(), 0.0);
}

/// Newcomers lie outside solids as these are now, pressed down and swung aside, and bring no energy of contact.
TEST(Scene, NewcomersKeepClearOfSolids) {
  for (const bool smooth : {false, true}) {
    const auto run = std::make_unique<CoupledRun>();
    run->grains.laws = dem::makeContactLaws(dem::ElasticLaw{{.stiffness = 2e4}});
    const fem::SolidMesh mesh = fem::boxOf(fem::ElementShape::hex8, {3, 3, 1}, {0, 0, -0.2}, {0.6, 0.6, 0});
    SolidSide& side = run->addSolid(block(mesh, false), {.name = "block"});
    const auto faces = mesh.faceSets.at("skin");
    const surface::Skin skin = surface::makeSkin(mesh.X, faces);
    run->grains.terms.add(surface::SurfaceContact(
        side, smooth ? surface::SurfaceCoupler(surface::makeSmoothSurface(skin)) : surface::SurfaceCoupler(skin),
        run->grains.laws, "contacts"));
    dem::InsertionTerm& insertion = dem::addInsertion(run->grains, {.region = {{0.1, 0.1, -0.3}, {0.5, 0.5, 0.1}},
                                                                    .sizes = dem::UniformSizes{0.01, 0.02},
                                                                    .density = {2000.0},
                                                                    .numberPerSecond = 3e4});
    run->grains.sortEvery = 0;
    for (Vec3& v : side.nodes().v) v = {0.0, 0.0, 8.0};
    run->start(dt);
    const dem::Particles& p = run->grains.particles;
    for (int w = 0; w < 60; ++w) {
      const std::size_t before = p.size();
      run->advance();
      const double top = 8.0 * run->time();
      for (std::size_t i = before; i < p.size(); ++i)
        EXPECT_TRUE(p.x[i].z - p.radius[i] > top - 2e-3 || p.x[i].z + p.radius[i] < top - 0.2 + 2e-3)
            << p.x[i].z << " within the block below " << top << ", smooth: " << smooth;
    }
    EXPECT_GT(insertion.insertion.inserted, 50);
    EXPECT_LT(std::abs(run->ledger().residual()), 2e-3 * run->ledger().storedAtOpening()) << run->ledger();
  }
}

TEST(Scene, MayReplaceItsGrainsBeforeItStarts) {
  dem::Model settled = emptyRun()->grains;
  const auto run = std::make_unique<CoupledRun>();
  run->grains = settled;
  addBlock(*run);
  addLayer(*run, 12);
  run->start(dt);
  run->advance(300);
  EXPECT_GT(run->ledger().joules("block: elastic"), 0.0);
  EXPECT_LT(std::abs(run->ledger().residual()), 1e-2 * turnedOver(*run));
  run->grains = settled;
  EXPECT_THROW(run->advance(), InputError) << "solids would stand still";
}

TEST(Scene, RefusesWhatWouldBeMixedUp) {
  const auto run = emptyRun(), other = emptyRun();
  addBlock(*run);
  SolidSide& theirs = addBlock(*other);
  EXPECT_THROW(addBlock(*run), InputError) << "two solids of one name";
  EXPECT_THROW(run->addSolid(block(tetBlock(), true), {.name = "particles"}), InputError);
  run->grains.terms.add(
      surface::SurfaceContact(theirs, surface::SurfaceCoupler(topOf(tetBlock())), frictionalLaws(), "far"));
  EXPECT_THROW(run->start(dt), InputError) << "a solid of another run";
}

/// Two blocks, and grains between them that touch both.
TEST(Scene, MayHaveSeveralSolids) {
  const auto run = std::make_unique<CoupledRun>();
  run->grains.laws = frictionalLaws();
  addBlock(*run);
  const fem::SolidMesh mesh = fem::boxOf(fem::ElementShape::hex20, {2, 2, 1}, {0, 0, 0.06}, {0.6, 0.6, 0.16});
  SolidSide& lid = run->addSolid(block(mesh, false), {.name = "lid", .stepping = Stepping::implicitSteps});
  run->grains.terms.add(
      surface::SurfaceContact(lid, surface::SurfaceCoupler(topOf(mesh)), frictionalLaws(), "contacts"));
  for (Vec3& v : lid.nodes().v) v = {0.1, 0.0, -0.3};
  addLayer(*run, 12);
  run->start(0.5 * dt);
  run->advance(1000);
  EXPECT_GT(run->ledger().joules("lid: elastic"), 0.0);
  EXPECT_LT(std::abs(run->ledger().residual()), 1e-2 * turnedOver(*run)) << run->ledger();
}

TEST(Scene, AnUnstableStepIsRefusedAtEveryStart) {
  const auto run = emptyRun();
  addBlock(*run);
  addLayer(*run, 12);
  run->start(dt);
  run->advance(100);
  EXPECT_TRUE(run->grains.refusesUnstableSteps);
  EXPECT_THROW(run->start(0.1), InputError);
  EXPECT_EQ(run->dt(), dt);
  run->advance(100);
  EXPECT_LT(std::abs(run->ledger().residual()), 1e-2 * turnedOver(*run));
}

}  // namespace
}  // namespace dovetail::coupling
