// Particles that are sorted, come and go, and copies of the particles' model, while solids are there.
#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
#include "spring_scene.hpp"

namespace dovetail::coupling {
namespace {

TEST(RunEvents, RemovedParticlesTakeTheirEnergyAlong) {
  const auto run = springRun({.held = true});
  dem::addParticle(run->grains.particles, {0.1, 0.1, 1.0}, {0.0, 0.0, 1.0}, 0.03, dem::Mass{0.3});
  run->start(1e-4);
  run->advance(10);
  dem::removeParticles(run->grains, std::vector<int>{4});
  run->advance(10);
  EXPECT_LT(std::abs(run->ledger().residual()), 1e-3 * run->ledger().storedAtOpening());
}

TEST(RunEvents, ACopyOfTheParticlesLoadsNobody) {
  const auto run = springRun({});
  run->start(1e-4);
  run->advance(5);
  const std::vector<Vec3> before = run->solid(0).load.force;
  dem::Model copy = run->grains;
  dem::run(copy, 1e-4, 5);
  EXPECT_EQ(before, run->solid(0).load.force);
  run->advance(5);
}

TEST(RunEvents, SettlesAndBooksWhatThatTook) {
  for (const Stepping stepping : {Stepping::explicitSteps, Stepping::implicitSteps}) {
    const auto run = springRun({.stepping = stepping, .held = true});
    run->grains.gravity = {0.0, 0.0, -9.81};
    run->start(2e-4);
    const RestReport report = settle(*run);
    EXPECT_TRUE(report.atRest) << report.kinetic;
    const dem::Particles& p = run->grains.particles;
    for (std::size_t i = 0; i < p.size(); ++i) EXPECT_LT(norm(p.f[i]), 2e-3 * 9.81 * p.mass[i]);
    const double booked = run->ledger().joules("brought to rest");
    EXPECT_GT(booked, 0.0);
    EXPECT_LT(std::abs(run->ledger().residual()), 1e-2 * booked);
  }
  const auto run = springRun({});
  run->start(1e-4);
  EXPECT_THROW(settle(*run, {.kinetic = 0.0}), InputError);
  EXPECT_FALSE(settle(*run, {.windows = 1}).atRest);
}

TEST(RunEvents, SortingChangesNothingButTheOrder) {
  const auto sorted = springRun({}), plain = springRun({});
  sorted->grains.sortEvery = 1;
  plain->grains.sortEvery = 0;
  for (CoupledRun* run : {sorted.get(), plain.get()}) {
    run->grains.pairs.setSkin(1e-4);
    run->start(1e-4);
    run->advance(300);
  }
  for (std::int64_t id = 0; id < 4; ++id) {
    const auto i = static_cast<std::size_t>(dem::find(sorted->grains.particles, id));
    const auto j = static_cast<std::size_t>(dem::find(plain->grains.particles, id));
    EXPECT_LT(norm(sorted->grains.particles.x[i] - plain->grains.particles.x[j]), 1e-13);
  }
}

}  // namespace
}  // namespace dovetail::coupling
