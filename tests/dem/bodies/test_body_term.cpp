// Clumps inside a model: they fall, roll, rest, go through periods, are sorted, saved and removed; each counts once.
#include <gtest/gtest.h>

#include "../../io/scratch_folder.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/bodies/body_term.hpp"
#include "dovetail/dem/model/checkpoint.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/dem/setup/streams.hpp"
#include "walls/wall_scenes.hpp"

namespace dovetail::dem {
namespace {

const ClumpShape& rod() {
  static const ClumpShape shape = makeClumpShape(std::vector<Vec3>{{0, 0, 0}, {0.06, 0, 0}, {0.12, 0.02, 0}},
                                                 std::vector<double>{0.05, 0.04, 0.05}, Density{1000.0});
  return shape;
}

const FrictionalLaw frictional{{.stiffness = 2e4, .restitution = 0.7}, {.stiffness = 6e3, .friction = 0.4}};

TEST(BodyTerm, AClumpFallsAsASphereDoesWithAndWithoutDamping) {
  for (const double rate : {0.0, 0.7}) {
    Model model;
    model.laws = makeContactLaws(frictional);
    model.gravity = {0, 0, -9.81};
    addClump(model, rod(), {0, 0, 0}, {0.9, 0.1, 0.3, 0.2}, {1, 0, 2}, {3, -1, 2});
    addParticle(model.particles, {5, 0, 0}, {1, 0, 2}, 0.1, Mass{2.0});
    damping(model).viscousRate = rate;
    const double before = energies(model).balance();
    run(model, 1e-3, 500);
    const Bodies& b = bodies(model).bodies;
    const auto sphere = static_cast<std::size_t>(find(model.particles, 3));
    EXPECT_LE(norm(b.v[0] - model.particles.v[sphere]), 1e-12);
    EXPECT_LE(norm(b.x[0] + Vec3{5, 0, 0} - model.particles.x[sphere]), 1e-12);
    if (rate == 0.0) {
      EXPECT_NEAR(b.v[0].z, 2.0 - 9.81 * 0.5, 1e-12);
      EXPECT_NEAR(b.x[0].z, 1.0 - 0.5 * 9.81 * 0.25, 1e-12);
    }
    EXPECT_NEAR(energies(model).balance(), before, 2e-5 * std::abs(before));
    EXPECT_EQ(rate > 0.0, energies(model).damping > 1.0);
  }
}

TEST(BodyTerm, AClumpOfOneSphereRollsDownASlopeAsTheSphere) {
  const ClumpShape ball = makeClumpShape(std::vector<Vec3>{{0, 0, 0}}, std::vector<double>{0.05}, Density{1000.0});
  Model model;
  model.laws = makeContactLaws(frictional);
  const double tilt = 0.2, g = 9.81;
  model.gravity = {g * std::sin(tilt), 0, -g * std::cos(tilt)};
  addWall(model, makePlane({}, {0, 0, 1}));
  addClump(model, ball, {0, 0, 0.05}, {0.3, 0.5, -0.1, 0.9});
  addParticle(model.particles, {0, 1, 0.05}, {}, 0.05, Density{1000.0});
  run(model, 1e-4, 5000);
  const Bodies& b = bodies(model).bodies;
  EXPECT_NEAR(b.v[0].x, 5.0 / 7.0 * g * std::sin(tilt) * model.time, 0.02 * b.v[0].x);
  const auto sphere = static_cast<std::size_t>(find(model.particles, 1));
  EXPECT_LE(norm(b.v[0] - model.particles.v[sphere]), 1e-9);
  EXPECT_LE(norm(angularVelocity(b, 0) - model.particles.omega[sphere]), 1e-7);
}

TEST(BodyTerm, ADroppedRodComesToRestOnItsWeightAndTheLedgerCloses) {
  const auto residual = [](double dt) {
    Model model;
    model.laws = makeContactLaws(frictional);
    model.gravity = {0, 0, -9.81};
    const PrimitiveWall& floor = addWall(model, makePlane({}, {0, 0, 1}));
    addClump(model, rod(), {0, 0, 0.25}, {0.8, 0.4, 0.1, 0.2}, {0.3, 0, 0}, {1, 2, 0});
    addClump(model, rod(), {0.01, 0.02, 0.5}, {0.2, 0.4, -0.1, 0.7}, {}, {0, 2, 1});
    const double start = energies(model).balance();
    run(model, dt, static_cast<std::int64_t>(1.5 / dt));
    const Energies e = energies(model);
    const Bodies& b = bodies(model).bodies;
    EXPECT_LT(e.kinetic, 1e-3 * e.lost.lostPower());
    EXPECT_NEAR(floor.force.z, -9.81 * (b.mass[0] + b.mass[1]), 0.05 * 9.81 * b.mass[0]);
    return std::abs(e.balance() - start) / e.lost.lostPower();
  };
  EXPECT_LE(residual(1e-4), 2e-2);
}

/// Rods and spheres in a periodic box, sorted at every list update.
Model gas(bool friction) {
  Model model;
  model.laws = friction ? makeContactLaws(frictional) : makeContactLaws(ElasticLaw{{.stiffness = 2e4}});
  model.pairs.setSkin(0.02);
  model.pairs.setPeriodicity({{{0, 0, 0}, {1, 1, 1}}, {true, true, true}});
  model.sortEvery = 1;
  Random random(8);
  for (int i = 0; i < 64; ++i) {
    const Vec3 x{0.25 * (i % 4), 0.25 * (i / 4 % 4), 0.25 * (i / 16)}, v = random.vector(2.0);
    if (i % 3 == 0)
      addParticle(model.particles, x, v, 0.05, Density{1000.0});
    else
      addClump(model, rod(), x, fromRotationVector(random.vector(3.0)), v, random.vector(5.0));
  }
  return model;
}

TEST(BodyTerm, AGasThroughPeriodsKeepsEnergyAndMomentumWhileItIsSorted) {
  Model model = gas(false);
  const Energies start = energies(model);
  EXPECT_NEAR(start.kinetic, kineticEnergy(model.particles, bodies(model).bodies), 1e-12 * start.kinetic);
  const Vec3 push = momenta(model).linear;
  run(model, 2e-5, 4000);
  EXPECT_GT(model.listUpdates, 10);
  EXPECT_NEAR(energies(model).balance(), start.balance(), 1e-3 * start.balance());
  EXPECT_LE(norm(momenta(model).linear - push), 1e-11);
  for (const Vec3& x : bodies(model).bodies.x)
    for (int k = 0; k < 3; ++k) EXPECT_TRUE(x[k] > -0.1 && x[k] < 1.1);
}

TEST(BodyTerm, RunsAreTheSameForAnyThreadsAndFromACheckpoint) {
  const io::test::ScratchFolder scratch;
  const auto path = scratch / "dovetail_bodies.ckp";
  std::vector<Vec3> once;
  for (const int count : {1, 2, 3}) {
    setThreads(count);
    Model model = gas(true);
    damping(model).viscousRate = 0.1;
    for (int s = 0; s < 701; ++s) {
      advance(model, 4e-5);
      if (count != 3 || s != 350) continue;
      writeCheckpoint(path, model);
      Model other;
      other.laws = model.laws;
      readCheckpoint(path, other);
      model = other;
    }
    close(model);
    if (once.empty()) once = model.particles.x;
    EXPECT_TRUE(model.particles.x == once) << count;
  }
  setThreads(1);
}

TEST(BodyTerm, AMemberInAnOutletTakesItsWholeClumpAlongAndTheLedgerStays) {
  Model model;
  model.laws = makeContactLaws(frictional);
  model.gravity = {0, 0, -9.81};
  model.pairs.setSkin(0.02);
  for (int i = 0; i < 5; ++i) {
    addClump(model, rod(), {0.3 * i, 0, 0.1 * i}, {0.9, 0.1, 0.3, 0.2}, {0.1, 0, 0}, {0, 2, 1});
    addParticle(model.particles, {0.3 * i, 1, 0.1 * i}, {}, 0.05, Density{1000.0});
  }
  const OutletTerm& outlet = addOutlet(model, HalfSpace{{0, 0, -0.3}, {0, 0, -1}});
  const double start = energies(model).balance(), mass = rod().properties.mass;
  run(model, 1e-4, 3000);
  EXPECT_GT(outlet.passed.count, 3);
  EXPECT_LT(outlet.passed.count, 10);
  const std::size_t left = bodies(model).bodies.size();
  EXPECT_EQ(model.particles.size() - bodies(model).clumps.size() + left + static_cast<std::size_t>(outlet.passed.count),
            10u);
  EXPECT_EQ(bodies(model).clumps.size(), 3 * left);
  const auto spheres = static_cast<double>(outlet.passed.count) - static_cast<double>(5 - left);
  EXPECT_NEAR(outlet.passed.mass, static_cast<double>(5 - left) * mass + spheres * 4.0 / 3.0 * 3.14159265358979 * 0.125,
              1e-9);
  EXPECT_NEAR(energies(model).balance(), start, 1e-3 * std::abs(model.booked.left) + 1e-9);
  EXPECT_NO_THROW(check(model));
}

TEST(BodyTerm, StepsKnowLeverArmsAndBrokenClumpsAreRefused) {
  Model model;
  model.laws = makeContactLaws(ElasticLaw{{.stiffness = 2e4}});
  addWall(model, makePlane({}, {0, 0, 1}));
  addClump(model, rod(), {0, 0, 0.049}, {}, {});
  findForces(model);
  const double mass = rod().properties.mass;
  EXPECT_LT(criticalStep(model).dt, 0.9 * 2.0 / std::sqrt(3.0 * 2e4 / mass));
  EXPECT_GT(criticalStep(model).dt, 0.2 * 2.0 / std::sqrt(3.0 * 2e4 / mass));
  bodies(model).clumps.particle[1] = 77;
  EXPECT_THROW(check(model), InputError);
}

}  // namespace
}  // namespace dovetail::dem
