// Models brought to rest, friction and all.
#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/bodies/body_term.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/dem/setup/relax.hpp"
#include "walls/wall_scenes.hpp"

namespace dovetail::dem {
namespace {

/// Grains above the floor of a box, one layer upon the other.
Model heap(double friction, double sizeRatio) {
  Model model;
  model.laws =
      makeContactLaws(FrictionalLaw{{.stiffness = 1e5, .restitution = 0.8}, {.stiffness = 7e4, .friction = friction}});
  model.gravity = {0, 0, -9.81};
  model.pairs.setSkin(0.02);
  for (const auto& [point, normal] :
       {std::pair{Vec3{0, 0, 0}, Vec3{0, 0, 1}}, std::pair{Vec3{0, 0, 0}, Vec3{1, 0, 0}},
        std::pair{Vec3{0.5, 0, 0}, Vec3{-1, 0, 0}}, std::pair{Vec3{0, 0, 0}, Vec3{0, 1, 0}},
        std::pair{Vec3{0, 0.5, 0}, Vec3{0, -1, 0}}})
    addWall(model, makePlane(point, normal));
  Random random(7);
  for (int i = 0; i < 80; ++i)
    addParticle(model.particles,
                Vec3{0.06 + 0.12 * (i % 4), 0.06 + 0.12 * (i / 4 % 4), 0.055 + 0.105 * (i / 16)} + random.vector(0.004),
                {}, i % 2 == 0 ? 0.05 : 0.05 * sizeRatio, Density{2000.0});
  return model;
}

TEST(Relax, GrainsOfOneSizeAndOfTwoComeToRestOnTheirWeightWithFriction) {
  for (const double ratio : {1.0, 0.6}) {
    Model model = heap(0.5, ratio);
    const RelaxationReport report = relax(model, {.tolerance = 1e-3});
    ASSERT_TRUE(report.atRest) << report.residual << " after " << report.steps;
    EXPECT_LE(restOf(model).residual, 1.1e-3);
    EXPECT_EQ(report.rattlers, 0);
    double weight = 0.0;
    for (const double mass : model.particles.mass) weight += 9.81 * mass;
    Vec3 onWalls;
    for (const PrimitiveWallTerm* wall : model.terms.all<PrimitiveWallTerm>()) onWalls += wall->wall.force;
    EXPECT_LE(norm(onWalls + Vec3{0, 0, weight}), 2e-2 * weight);
    EXPECT_GT(model.work.tangentialEnergy, 1e-4 * model.work.elasticEnergy);
    EXPECT_EQ(kineticEnergy(model.particles), 0.0);
    const double held = model.work.storedEnergy();
    run(model, 0.1 * criticalStep(model).dt, 300);  // left alone, it stays
    EXPECT_LT(kineticEnergy(model.particles), 1e-2 * held);
  }
}

TEST(Relax, ClumpsComeToRestAmongGrains) {
  Model model = heap(0.5, 1.0);
  const ClumpShape rod = makeClumpShape(std::vector<Vec3>{{0, 0, 0}, {0.06, 0, 0}, {0.12, 0.02, 0}},
                                        std::vector<double>{0.05, 0.04, 0.05}, Density{2000.0});
  for (int k = 0; k < 8; ++k)
    addClump(model, rod, {0.12 + 0.25 * (k % 2), 0.1 + 0.09 * k / 2, 0.58 + 0.11 * (k % 3)}, {0.9, 0.05 * k, 0.2, 0.3});
  const double before = energies(model).balance();
  const RelaxationReport report = relax(model, {.tolerance = 1e-3});
  ASSERT_TRUE(report.atRest) << report.residual << " after " << report.steps;
  const Bodies& rods = bodies(model).bodies;
  double weight = 0.0;
  for (const double mass : rods.mass) weight += 9.81 * mass;
  for (std::size_t i = 0; i < model.particles.size(); ++i)
    if (!model.particles.isMember(i)) weight += 9.81 * model.particles.mass[i];
  Vec3 onWalls;
  for (const PrimitiveWallTerm* wall : model.terms.all<PrimitiveWallTerm>()) onWalls += wall->wall.force;
  EXPECT_LE(norm(onWalls + Vec3{0, 0, weight}), 2e-2 * weight);
  for (std::size_t b = 0; b < rods.size(); ++b) EXPECT_LE(norm(rods.f[b]), 0.05 * 9.81 * rods.mass[b]) << b;
  EXPECT_EQ(energies(model).kinetic, 0.0);
  EXPECT_NEAR(energies(model).balance(), before, 0.02 * std::abs(before));
  const double held = model.work.storedEnergy();
  run(model, 0.1 * criticalStep(model).dt, 300);  // left alone, they stay
  EXPECT_LT(energies(model).kinetic, 1e-2 * held);
}

TEST(Relax, FallingGrainsAreNotAtRest) {
  Model model = heap(0.5, 1.0);
  for (Vec3& x : model.particles.x) x.z = 1.0 + 2.0 * x.z;  // nobody touches anybody
  const RelaxationReport report = relax(model, {.tolerance = 1e-3, .steps = 3});
  EXPECT_FALSE(report.atRest);
  EXPECT_EQ(report.steps, 3);
  EXPECT_GT(report.residual, 1.0);
}

TEST(Relax, BadRequestsAreRefused) {
  Model model = heap(0.5, 1.0);
  EXPECT_THROW(relax(model, {.tolerance = 0.0}), InputError);
  EXPECT_THROW(relax(model, {}, {.stepFraction = 1.0}), InputError);
  EXPECT_THROW(relax(model, {}, {.lookEvery = 0}), InputError);
  primitiveWall(model, 0).velocity = {0, 0, 1};
  EXPECT_THROW(relax(model), InputError);
}

}  // namespace
}  // namespace dovetail::dem
