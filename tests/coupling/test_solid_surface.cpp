// Several couplings on one solid: one surface.
#include <gtest/gtest.h>

#include <random>

#include "full_scene.hpp"

namespace dovetail::coupling {
namespace {

fem::SolidMesh brick() { return fem::boxOf(fem::ElementShape::hex8, {4, 4, 2}, {0, 0, -0.2}, {0.6, 0.6, 0}); }

/// Faces of the top in so many parts, and those of the sides x = 0.6 and y = 0 behind them, if wanted.
std::vector<std::vector<fem::Face>> partsOf(const fem::SolidMesh& mesh, int count, bool sides) {
  std::vector<std::vector<fem::Face>> parts(static_cast<std::size_t>(count));
  for (const fem::Face& face : mesh.faceSets.at("z+")) {
    Vec3 centre;
    for (int k = 0; k < 4; ++k)
      centre += 0.25 * mesh.X[static_cast<std::size_t>(face.node[static_cast<std::size_t>(k)])];
    const int part = count == 1 ? 0 : (centre.x > 0.3) + (count == 4 ? 2 * (centre.y > 0.3) : 0);
    parts[static_cast<std::size_t>(part)].push_back(face);
  }
  if (sides) parts.push_back(mesh.faceSets.at("x+"));
  if (sides) parts.push_back(mesh.faceSets.at("y-"));
  return parts;
}

std::vector<std::vector<fem::Face>> together(const std::vector<std::vector<fem::Face>>& parts) {
  std::vector<fem::Face> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return {all};
}

using Laws = std::shared_ptr<const dem::ContactLaws>;

std::vector<surface::SurfaceContact*> couple(CoupledRun& run, SolidSide& side, const fem::SolidMesh& mesh,
                                             const std::vector<std::vector<fem::Face>>& parts, const Laws& laws,
                                             double width = 0.0) {
  std::vector<surface::SurfaceContact*> contacts;
  for (const auto& faces : parts) {
    surface::Skin skin = surface::makeSkin(mesh.X, faces);
    surface::coarseGrain(skin, {{.width = width}, cg::KernelCorrection::symmetric});
    contacts.push_back(&run.grains.terms.add(surface::SurfaceContact(side, surface::SurfaceCoupler(std::move(skin)),
                                                                     laws, "part " + std::to_string(contacts.size()))));
  }
  return contacts;
}

std::unique_ptr<CoupledRun> brickRun(const std::vector<std::vector<fem::Face>>& parts, const Laws& laws,
                                     const SolidOptions& options = {}) {
  auto run = std::make_unique<CoupledRun>();
  run->grains.laws = laws;
  run->grains.sortEvery = 0;
  run->grains.pairs.setSkin(0.002);
  const fem::SolidMesh mesh = brick();
  couple(*run, run->addSolid(block(mesh, true), options), mesh, parts, laws);
  return run;
}

Laws elastic(double stiffness = 2e4) { return dem::makeContactLaws(dem::ElasticLaw{{.stiffness = stiffness}}); }

/// Grains over the seams of the top, and around its edges and corners.
std::vector<Vec3> places() {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> part(-1.0, 1.0);
  std::vector<Vec3> all;
  for (int k = 0; k < 30; ++k) all.push_back({0.3 + 0.03 * part(random), 0.3 + 0.25 * part(random), 0.022});
  for (int k = 0; k < 30; ++k) {
    const double angle = (0.25 + 0.3 * part(random)) * std::numbers::pi;
    all.push_back({0.6 + 0.022 * std::cos(angle), 0.3 + 0.35 * part(random), 0.022 * std::sin(angle)});
  }
  for (int k = 0; k < 30; ++k)
    all.push_back(Vec3{0.6, 0.0, 0.0} +
                  0.022 * normalized(Vec3{1.0 + part(random), -1.0 - part(random), 1.0 + part(random)}));
  return all;
}

/// Forces on grains that meet one another nowhere, one at a time.
std::vector<Vec3> forcesAt(const std::vector<std::vector<fem::Face>>& parts) {
  std::vector<Vec3> forces;
  auto run = brickRun(parts, elastic());
  SolidSide& side = run->solid(0);
  for (std::size_t i = 0; i < side.nodes().u.size(); ++i)
    side.nodes().u[i] = 0.003 * Vec3{std::sin(3.0 * double(i)), std::cos(2.0 * double(i)), std::sin(5.0 * double(i))};
  dem::addParticle(run->grains.particles, places()[0], {}, 0.025, dem::Mass{1.0});
  run->grains.refusesUnstableSteps = false;
  run->start(1e-6);
  for (const Vec3& place : places()) {
    run->grains.particles.x[0] = place;
    ++run->grains.particles.revision;
    side.load.clear();
    dem::findForces(run->grains);
    Vec3 sum = run->grains.particles.f[0];
    forces.push_back(sum);
    for (const auto* contact : run->grains.terms.all<surface::SurfaceContact>())
      for (const int node : contact->coupling().load().touched)
        sum += contact->coupling().load().force[static_cast<std::size_t>(node)];
    EXPECT_LT(norm(sum), 1e-12);
  }
  return forces;
}

TEST(SolidSurface, PushesOnceAtAnyPlaceInHowManyPartsSoever) {
  const fem::SolidMesh mesh = brick();
  for (const bool sides : {false, true}) {
    const std::vector<Vec3> once = forcesAt(together(partsOf(mesh, 1, sides)));
    ASSERT_GT(std::ranges::count_if(once, [](const Vec3& f) { return norm(f) > 1.0; }), sides ? 60 : 40);
    for (const int count : {1, 2, 4}) {
      const std::vector<Vec3> inParts = forcesAt(partsOf(mesh, count, sides));
      for (std::size_t k = 0; k < once.size(); ++k)
        EXPECT_LT(norm(inParts[k] - once[k]), 1e-12 * 500.0) << count << " parts, place " << k;
    }
  }
}

/// Six couplings on six faces are a closed skin, which pushes out who has sunk in.
TEST(SolidSurface, OfAllSidesIsClosed) {
  const fem::SolidMesh mesh = brick();
  std::vector<std::vector<fem::Face>> parts;
  for (const char* side : {"x-", "x+", "y-", "y+", "z-", "z+"}) parts.push_back(mesh.faceSets.at(side));
  auto run = brickRun(parts, elastic());
  dem::addParticle(run->grains.particles, {0.3, 0.3, -0.005}, {}, 0.025, dem::Mass{1.0});
  run->start(1e-5);
  EXPECT_NEAR(run->grains.particles.f[0].z, 2e4 * 0.03, 1e-9);
}

/// Frictional grains that slide and roll over seams and round edges: what contacts remember goes with them.
class SurfaceInParts : public testing::TestWithParam<Case> {};

std::unique_ptr<CoupledRun> slidingRun(const std::vector<std::vector<fem::Face>>& parts, const Case& c) {
  // Digits beyond the solver's tolerance are not the surface's.
  auto run = brickRun(parts, frictionalLaws(),
                      {.name = "block",
                       .stepping = c.stepping,
                       .implicitOptions = {.scheme = fem::newmark(), .relativeTolerance = 1e-15}});
  dem::Particles& p = run->grains.particles;
  for (int k = 0; k < 10; ++k)
    dem::addParticle(p, {0.28 + 0.002 * k, 0.03 + 0.06 * k, 0.0248}, {0.5, 0.02 * k, -0.05}, 0.025,
                     dem::Density{2000.0});
  for (int k = 0; k < 5; ++k)
    dem::addParticle(p, {0.59, 0.11 + 0.1 * k, 0.0249}, {0.3, 0.0, -0.1}, 0.025, dem::Density{2000.0});
  run->grains.gravity = {0.0, 0.0, -9.81};
  dem::switchOnRotation(p);
  run->start(dt, {.stepsPerMacroStep = c.K});
  return run;
}

TEST_P(SurfaceInParts, MovesGrainsAndSolidAsOneCouplingDoes) {
  const fem::SolidMesh mesh = brick();
  auto once = slidingRun(together(partsOf(mesh, 1, true)), GetParam());
  once->advance(800 / GetParam().K);
  for (const int count : {1, 2, 4}) {
    auto inParts = slidingRun(partsOf(mesh, count, true), GetParam());
    inParts->advance(800 / GetParam().K);
    for (std::size_t i = 0; i < 15; ++i) {
      EXPECT_LT(norm(inParts->grains.particles.x[i] - once->grains.particles.x[i]), 1e-12) << count;
      EXPECT_LT(norm(inParts->grains.particles.omega[i] - once->grains.particles.omega[i]), 1e-8) << count;
    }
    EXPECT_NEAR(inParts->ledger().residual(), once->ledger().residual(), 1e-11);
  }
}

TEST_P(SurfaceInParts, GoesOnBitForBit) {
  const auto parts = partsOf(brick(), 4, true);
  auto whole = slidingRun(parts, GetParam()), rest = slidingRun(parts, GetParam());
  whole->advance(240 / GetParam().K);
  rest->load(whole->save());
  whole->advance(240 / GetParam().K);
  rest->advance(240 / GetParam().K);
  EXPECT_EQ(whole->save(), rest->save());
}

INSTANTIATE_TEST_SUITE_P(MacroSteps, SurfaceInParts,
                         testing::Values(Case{"explicit1", Stepping::explicitSteps, 1},
                                         Case{"explicit4", Stepping::explicitSteps, 4},
                                         Case{"implicit1", Stepping::implicitSteps, 1},
                                         Case{"implicit4", Stepping::implicitSteps, 4},
                                         Case{"implicit16", Stepping::implicitSteps, 16}),
                         [](const auto& one) { return std::string(one.param.name); });

TEST(SolidSurface, HasALawForEachPart) {
  const fem::SolidMesh mesh = brick();
  auto run = std::make_unique<CoupledRun>();
  run->grains.laws = elastic();
  SolidSide& side = run->addSolid(block(mesh, true));
  const auto parts = partsOf(mesh, 2, false);
  couple(*run, side, mesh, {parts[0]}, elastic(1e4));
  couple(*run, side, mesh, {parts[1]}, frictionalLaws());
  dem::addParticle(run->grains.particles, {0.2, 0.3, 0.024}, {}, 0.025, dem::Mass{1.0});
  dem::addParticle(run->grains.particles, {0.4, 0.3, 0.024}, {}, 0.025, dem::Mass{1.0});
  dem::switchOnRotation(run->grains.particles);
  run->start(1e-5);
  EXPECT_NEAR(run->grains.particles.f[0].z, 1e4 * 0.001, 1e-9);
  EXPECT_NEAR(run->grains.particles.f[1].z, 2e4 * 0.001, 1e-9);
}

/// Kernels end where parts with kernels end; there the skin is whole all the same.
TEST(SolidSurface, PushesOnceWhereKernelsEnd) {
  const fem::SolidMesh mesh = brick();
  for (const int count : {1, 2, 4}) {
    auto run = std::make_unique<CoupledRun>();
    run->grains.laws = elastic();
    couple(*run, run->addSolid(block(mesh, true)), mesh, partsOf(mesh, count, true), elastic(), 0.2);
    double y = 0.0;
    for (const double x : {0.28, 0.3, 0.31, 0.35, 0.05, 0.59, 0.6, 0.45})
      dem::addParticle(run->grains.particles, {x, y += 0.06, 0.024}, {}, 0.025, dem::Mass{1.0});
    run->start(1e-6);
    for (const Vec3& f : run->grains.particles.f) EXPECT_LT(norm(f - Vec3{0, 0, 20.0}), 1e-9) << count;
  }
}

/// Parts of one kernel that goes on from part to part are as one coupling.
TEST(SolidSurface, OfOneKernelInPartsMovesAsOneCouplingDoes) {
  const fem::SolidMesh mesh = brick();
  const auto moved = [&](const std::vector<std::vector<fem::Face>>& parts) {
    auto run = std::make_unique<CoupledRun>();
    run->grains.laws = frictionalLaws();
    run->grains.sortEvery = 0;
    SolidSide& side = run->addSolid(block(mesh, true));
    surface::Skin whole = surface::makeSkin(mesh.X, together(parts).front());
    surface::coarseGrain(whole, {{.width = 0.2}, cg::KernelCorrection::symmetric});
    std::size_t first = 0;
    for (const auto& faces : parts) {
      const std::size_t end = first + faces.size();
      run->grains.terms.add(surface::SurfaceContact(
          side, surface::SurfaceCoupler(parts.size() == 1 ? whole : surface::partOf(whole, first, end)),
          frictionalLaws()));
      first = end;
    }
    for (int k = 0; k < 10; ++k)
      dem::addParticle(run->grains.particles, {0.28 + 0.002 * k, 0.03 + 0.06 * k, 0.0248}, {0.5, 0.02 * k, -0.05},
                       0.025, dem::Density{2000.0});
    run->grains.gravity = {0.0, 0.0, -9.81};
    dem::switchOnRotation(run->grains.particles);
    run->start(dt);
    run->advance(500);
    return run->grains.particles.x;
  };
  for (const int count : {2, 4}) {
    const auto parts = partsOf(mesh, count, true);
    const std::vector<Vec3> once = moved(together(parts)), inParts = moved(parts);
    for (std::size_t i = 0; i < once.size(); ++i) EXPECT_LT(norm(inParts[i] - once[i]), 1e-12) << count;
  }
}

TEST(SolidSurface, RefusesAFaceThatTwoCouplingsHave) {
  const fem::SolidMesh mesh = brick();
  auto run = brickRun({mesh.faceSets.at("skin"), mesh.faceSets.at("z+")}, elastic());
  dem::addParticle(run->grains.particles, {0.3, 0.3, 0.1}, {}, 0.025, dem::Mass{1.0});
  EXPECT_THROW(run->start(1e-5), InputError);
}

TEST(SolidSurface, RefusesASmoothSurfaceBesideAnother) {
  const fem::SolidMesh mesh = brick();
  auto run = brickRun({mesh.faceSets.at("x+")}, elastic());
  run->grains.terms.add(surface::SurfaceContact(
      run->solid(0),
      surface::SurfaceCoupler(surface::makeSmoothSurface(surface::makeSkin(mesh.X, mesh.faceSets.at("z+")))),
      elastic()));
  dem::addParticle(run->grains.particles, {0.3, 0.3, 0.1}, {}, 0.025, dem::Mass{1.0});
  EXPECT_THROW(run->start(1e-5), InputError);
}

TEST(SolidSurface, RefusesASkinThatIsNotItsSolids) {
  const fem::SolidMesh mesh = brick();
  fem::SolidMesh other = mesh;
  for (Vec3& X : other.X) X.x += 0.1;
  CoupledRun run;
  SolidSide& side = run.addSolid(block(mesh, true));
  EXPECT_THROW(surface::SurfaceContact(
                   side, surface::SurfaceCoupler(surface::makeSkin(other.X, other.faceSets.at("z+"))), elastic()),
               InputError);
}

/// Below a face a closed skin reaches one radius far: who gets deeper does not vanish.
TEST(SolidSurface, NamesAGrainThatSinksThrough) {
  const fem::SolidMesh mesh = brick();
  auto run = brickRun({mesh.faceSets.at("skin")}, elastic(1.0));
  dem::addParticle(run->grains.particles, {0.1, 0.1, 0.026}, {0.0, 0.0, -1.0}, 0.025, dem::Mass{1.0});
  run->start(1e-3);
  try {
    run->advance(120);
    FAIL() << "it has come through";
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("particle 0"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace dovetail::coupling
