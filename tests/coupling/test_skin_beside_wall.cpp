// The surface of a solid that goes on as a mesh wall.
#include <gtest/gtest.h>

#include <array>
#include <numeric>
#include <random>

#include "full_scene.hpp"

namespace dovetail::coupling {
namespace {

struct Ground {
  int parts = 1;        ///< couplings on the top of the brick
  double kernel = 0.0;  ///< m, width of theirs
  double gap = 0.0;     ///< m, between brick and wall; < 0: a lap
  bool held = true;     ///< all nodes of the brick, else its bottom
  bool wall = true;
  Case macroSteps{"", Stepping::explicitSteps, 1};
};

fem::SolidMesh brick() { return fem::boxOf(fem::ElementShape::hex8, {4, 4, 2}, {0, 0, -0.2}, {0.6, 0.6, 0}); }

/// A brick with its top at z = 0 up to x = 0.6, from where a wall goes on to x = 1.2.
std::unique_ptr<CoupledRun> groundOf(const Ground& ground, std::shared_ptr<const dem::ContactLaws> laws) {
  auto run = std::make_unique<CoupledRun>();
  run->grains.laws = laws;
  run->grains.sortEvery = 0;
  run->grains.pairs.setSkin(0.002);
  const fem::SolidMesh mesh = brick();
  auto model = block(mesh, true);
  std::vector<int> all(mesh.X.size());
  std::iota(all.begin(), all.end(), 0);
  if (ground.held) fem::fix(model->nodes, all);
  SolidSide& side = run->addSolid(std::move(model), {.name = "brick", .stepping = ground.macroSteps.stepping});
  std::vector<std::vector<fem::Face>> parts(static_cast<std::size_t>(ground.parts));
  for (const fem::Face& face : mesh.faceSets.at("z+"))
    parts[ground.parts == 1 || mesh.X[static_cast<std::size_t>(face.node[0])].y < 0.29 ? 0 : 1].push_back(face);
  for (const auto& faces : parts) {
    surface::Skin skin = surface::makeSkin(mesh.X, faces);
    surface::coarseGrain(skin, {{.width = ground.kernel}, cg::KernelCorrection::symmetric});
    run->grains.terms.add(surface::SurfaceContact(side, surface::SurfaceCoupler(std::move(skin)), laws));
  }
  const double x = 0.6 + ground.gap;
  if (ground.wall)
    dem::addWall(run->grains, dem::MeshWall{}).wall =
        dem::makeWall({{x, -0.1, 0}, {1.2, -0.1, 0}, {1.2, 0.7, 0}, {x, 0.7, 0}}, {{0, 1, 2}, {0, 2, 3}});
  return run;
}

TEST(SkinBesideWall, PushesOnceAtTheSeam) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> part(-1.0, 1.0);
  for (const Ground& ground : {Ground{}, Ground{.parts = 2}, Ground{.kernel = 0.2}, Ground{.parts = 2, .kernel = 0.2},
                               Ground{.gap = 1e-9}, Ground{.gap = -1e-3}}) {
    auto run = groundOf(ground, dem::makeContactLaws(dem::ElasticLaw{{2e4}}));
    for (int k = 0; k < 40; ++k)
      dem::addParticle(run->grains.particles, {0.6 + 0.01 * part(random), 0.05 + 0.0125 * k, 0.0048}, {}, 0.005,
                       dem::Mass{1.0});
    run->start(1e-6);
    for (const Vec3& f : run->grains.particles.f)
      EXPECT_LT(norm(f - Vec3{0, 0, 2e4 * 2e-4}), 1e-9) << ground.parts << ' ' << ground.kernel << ' ' << ground.gap;
  }
}

/// Between a solid and a lid, each pushes; at a step down to the wall, its edge does.
TEST(SkinBesideWall, EachPushesFromItsSide) {
  for (const bool oneSided : {false, true}) {
    auto run = groundOf({.wall = false}, dem::makeContactLaws(dem::ElasticLaw{{2e4}}));
    dem::addWall(run->grains, dem::MeshWall{}).wall = dem::makeWall(
        {{0, 0, 0.0097}, {0.6, 0, 0.0097}, {0.6, 0.6, 0.0097}, {0, 0.6, 0.0097}}, {{0, 2, 1}, {0, 3, 2}}, oneSided);
    dem::addParticle(run->grains.particles, {0.31, 0.33, 0.0048}, {}, 0.005, dem::Mass{1.0});
    run->start(1e-6);
    EXPECT_NEAR(run->grains.work.elasticEnergy, 0.5 * 2e4 * (4e-8 + 1e-8), 1e-12);
    EXPECT_NEAR(run->grains.particles.f[0].z, 2e4 * 1e-4, 1e-9);
  }
}

/// Balls that slide, then roll, over the seam in both directions, and along it.
void addRollers(CoupledRun& run) {
  dem::Particles& p = run.grains.particles;
  for (int k = 0; k < 8; ++k) {
    const double x = k % 2 == 0 ? 0.57 : 0.63, towards = k % 2 == 0 ? 0.8 : -0.8;
    dem::addParticle(p, {x, 0.08 + 0.06 * k, 0.0248}, {towards, 0.03 * k, -0.02}, 0.025, dem::Density{2000.0});
  }
  run.grains.gravity = {0.0, 0.0, -9.81};
  dem::switchOnRotation(p);
}

TEST(SkinBesideWall, BallsRollOverTheSeamAsOverAPlane) {
  auto plane = std::make_unique<CoupledRun>();
  plane->grains.laws = frictionalLaws();
  plane->grains.sortEvery = 0;
  dem::addWall(plane->grains, dem::makePlane({}, {0, 0, 1}));
  addRollers(*plane);
  plane->start(dt);
  plane->advance(1200);
  for (const Ground& ground : {Ground{}, Ground{.parts = 2}, Ground{.gap = 1e-10}}) {
    auto run = groundOf(ground, frictionalLaws());
    addRollers(*run);
    run->start(dt);
    run->advance(1200);
    for (std::size_t i = 0; i < run->grains.particles.size(); ++i) {
      EXPECT_LT(norm(run->grains.particles.v[i] - plane->grains.particles.v[i]), 1e-9) << i;
      EXPECT_LT(norm(run->grains.particles.omega[i] - plane->grains.particles.omega[i]), 1e-8) << i;
    }
    EXPECT_NEAR(run->ledger().residual(), plane->ledger().residual(), 1e-10);
  }
}

/// The seam, and the balls on it, go over a periodic side; the solid ends there with its periods.
TEST(SkinBesideWall, GoesOnOverPeriodicSides) {
  const auto moved = [](CoupledRun& run) {
    run.grains.pairs.setPeriodicity({{{-1, 0, -1}, {2, 0.6, 1}}, {false, true, false}});
    dem::Particles& p = run.grains.particles;
    for (int k = 0; k < 4; ++k)
      dem::addParticle(p, {k % 2 == 0 ? 0.57 : 0.63, 0.12 * k + 0.13, 0.0248}, {k % 2 == 0 ? 0.8 : -0.8, 4.0, -0.02},
                       0.025, dem::Density{2000.0});
    run.grains.gravity = {0.0, 0.0, -9.81};
    dem::switchOnRotation(p);
    run.start(dt);
    run.advance(1200);
  };
  auto plane = std::make_unique<CoupledRun>();
  plane->grains.laws = frictionalLaws();
  plane->grains.sortEvery = 0;
  dem::addWall(plane->grains, dem::makePlane({}, {0, 0, 1}));
  moved(*plane);
  auto run = groundOf({.wall = false}, frictionalLaws());
  dem::addWall(run->grains, dem::MeshWall{}).wall =
      dem::makeWall({{0.6, 0, 0}, {1.2, 0, 0}, {1.2, 0.6, 0}, {0.6, 0.6, 0}}, {{0, 1, 2}, {0, 2, 3}});
  moved(*run);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_LT(norm(run->grains.particles.v[i] - plane->grains.particles.v[i]), 1e-9) << i;
    EXPECT_LT(norm(run->grains.particles.omega[i] - plane->grains.particles.omega[i]), 1e-7) << i;
  }
}

/// A wall does not share a place with a surface that a particle does not meet, as it is tied to the solid.
TEST(SkinBesideWall, PushesInFullWhereTheOtherIsAbsent) {
  dem::Particles particles;
  dem::addParticle(particles, {0.0, 0.5, 0.0098}, {}, 0.01, dem::Mass{1.0});
  std::array<dem::MeshWall, 2> halves;
  for (std::size_t h = 0; h < 2; ++h) {
    const double from = h == 0 ? -1.0 : 0.0;
    halves[h].wall =
        dem::makeWall({{from, 0, 0}, {from + 1, 0, 0}, {from + 1, 1, 0}, {from, 1, 0}}, {{0, 1, 2}, {0, 2, 3}});
    dem::findContacts(particles, halves[h], {});
  }
  const auto joined = [&](std::uint8_t absent) {
    std::array<dem::WallContacts, 2> contacts{halves[0].contacts, halves[1].contacts};
    const std::vector<std::uint8_t> away{absent};
    const std::vector<dem::WallAtSeam> walls{{&halves[0].wall, &halves[0].candidates, &contacts[0], {}},
                                             {&halves[1].wall, &halves[1].candidates, &contacts[1], {}, nullptr, away}};
    dem::joinAtSeams(particles, walls);
    std::array<double, 2> engaged{};
    for (std::size_t h = 0; h < 2; ++h)
      for (const double part : contacts[h].engagement) engaged[h] += part;
    return engaged;
  };
  const auto both = joined(0), alone = joined(1);
  EXPECT_NEAR(both[0] + both[1], 1.0, 1e-12);
  EXPECT_NEAR(alone[0], 1.0, 1e-12);
  EXPECT_NEAR(alone[1], 1.0, 1e-12) << "which whoever ties it takes away";
}

TEST(SkinBesideWall, HasTheSameDigitsForAnyNumberOfThreads) {
  std::vector<std::vector<char>> states;
  for (const int threads : {1, 2, 3}) {
    setThreads(threads);
    auto run = groundOf({.parts = 2, .held = false}, frictionalLaws());
    addRollers(*run);
    run->start(dt);
    run->advance(400);
    states.push_back(run->save());
  }
  setThreads(1);
  EXPECT_EQ(states[0], states[1]);
  EXPECT_EQ(states[0], states[2]);
}

class SkinBesideWallInWindows : public testing::TestWithParam<Case> {};

std::unique_ptr<CoupledRun> softRun(const Case& macroSteps, int refined) {
  auto run = groundOf({.parts = 2, .held = false, .macroSteps = macroSteps}, frictionalLaws());
  addRollers(*run);
  run->start(dt / refined, {.stepsPerMacroStep = macroSteps.K});
  return run;
}

/// The solid gives way below the balls: both sides of the seam are one surface all the same.
TEST_P(SkinBesideWallInWindows, ClosesTheBooks) {
  double last = 0.0;
  for (const int refined : {2, 4, 8}) {
    auto run = softRun(GetParam(), refined);
    const double start = run->ledger().residual(), turnedOver = dem::energies(run->grains).kinetic;
    run->advance(1200 * refined / GetParam().K);
    const double residual = std::abs(run->ledger().residual() - start);
    EXPECT_LT(residual, 3e-5 * turnedOver);
    if (refined > 2) {
      EXPECT_LT(residual, last);
    }
    last = residual;
  }
}

TEST_P(SkinBesideWallInWindows, GoesOnBitForBit) {
  auto whole = softRun(GetParam(), 1), rest = softRun(GetParam(), 1);
  whole->advance(480 / GetParam().K);
  rest->load(whole->save());
  whole->advance(720 / GetParam().K);
  rest->advance(720 / GetParam().K);
  EXPECT_EQ(whole->save(), rest->save());
}

INSTANTIATE_TEST_SUITE_P(MacroSteps, SkinBesideWallInWindows, macroCases,
                         [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace dovetail::coupling
