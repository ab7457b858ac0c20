// The surface of a solid that goes on as a mesh wall.
#include <gtest/gtest.h>

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
  Case windows{"", Stepping::explicitSteps, 1};
};

fem::SolidMesh brick() { return fem::boxOf(fem::CellShape::hex8, {4, 4, 2}, {0, 0, -0.2}, {0.6, 0.6, 0}); }

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
  SolidSide& side = run->addSolid(std::move(model), {.name = "brick", .stepping = ground.windows.stepping});
  std::vector<std::vector<fem::Face>> parts(static_cast<std::size_t>(ground.parts));
  for (const fem::Face& face : mesh.faceSets.at("z+"))
    parts[ground.parts == 1 || mesh.X[static_cast<std::size_t>(face.node[0])].y < 0.29 ? 0 : 1].push_back(face);
  for (const auto& faces : parts) {
    surface::Skin skin = surface::makeSkin(mesh.X, faces);
    surface::coarseGrain(skin, {{.width = ground.kernel}, cg::KernelCorrection::symmetric});
    run->grains.terms.add(surface::SurfaceContact(side, surface::Coupling(std::move(skin)), laws));
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

class SkinBesideWallInWindows : public testing::TestWithParam<Case> {};

std::unique_ptr<CoupledRun> softRun(const Case& windows, int refined) {
  auto run = groundOf({.parts = 2, .held = false, .windows = windows}, frictionalLaws());
  addRollers(*run);
  run->start(dt / refined, {.stepsPerWindow = windows.K});
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
    EXPECT_LT(residual, 1e-5 * turnedOver);
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

INSTANTIATE_TEST_SUITE_P(Windows, SkinBesideWallInWindows, windowCases,
                         [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace dovetail::coupling
