// Particles that enter and leave.
#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/setup/insertion.hpp"

namespace dovetail::dem {
namespace {

const InsertionSettings shower{.region = {{0, 0, 0}, {1, 1, 0.4}},
                               .sizes = UniformSizes{0.02, 0.05},
                               .density = {1000.0},
                               .velocity = {0, 0, -1},
                               .numberPerSecond = 300.0,
                               .seed = 3};

TEST(Insertion, LetsInTheRateAskedForWithoutOverlaps) {
  Insertion insertion = makeInsertion(shower);
  Particles particles;
  addParticle(particles, {0.5, 0.5, 0.2}, {}, 0.15, Density{1000.0});
  int entered = 0;
  for (int step = 0; step < 1000; ++step) {
    entered += insertParticles(insertion, particles, 1e-3);
    EXPECT_NEAR(static_cast<double>(insertion.inserted + insertion.refused), 0.3 * (step + 1), 1.0);
  }
  EXPECT_EQ(entered, insertion.inserted);
  EXPECT_EQ(particles.size(), static_cast<std::size_t>(entered) + 1);
  EXPECT_GT(entered, 250);
  double mass = 0.0;
  for (std::size_t i = 1; i < particles.size(); ++i) {
    mass += particles.mass[i];
    EXPECT_EQ(particles.v[i], (Vec3{0, 0, -1}));
    for (int k = 0; k < 3; ++k) {
      EXPECT_GE(particles.x[i][k] - particles.radius[i], shower.region.lower[k] - 1e-15);
      EXPECT_LE(particles.x[i][k] + particles.radius[i], shower.region.upper[k] + 1e-15);
    }
    for (std::size_t j = 0; j < i; ++j)
      ASSERT_GT(norm(particles.x[i] - particles.x[j]), particles.radius[i] + particles.radius[j]);
  }
  EXPECT_NEAR(mass, insertion.insertedMass, 1e-12 * mass);
}

TEST(Insertion, CountsThoseThatFindNoPlace) {
  InsertionSettings crowd = shower;
  crowd.region = {{0, 0, 0}, {0.3, 0.3, 0.3}};
  Insertion insertion = makeInsertion(crowd);
  Particles particles;
  insertParticles(insertion, particles, 2.0);
  EXPECT_EQ(insertion.inserted + insertion.refused, 600);
  EXPECT_GT(insertion.refused, 300);
  EXPECT_EQ(particles.size(), static_cast<std::size_t>(insertion.inserted));
}

TEST(Insertion, ByMassAndTheSameForTheSameSeed) {
  InsertionSettings settings = shower;
  settings.numberPerSecond = 0.0;
  settings.massPerSecond = 20.0;
  Insertion a = makeInsertion(settings), b = makeInsertion(settings);
  Particles first, second;
  switchOnRotation(first);
  for (int step = 0; step < 100; ++step) insertParticles(a, first, 1e-2);
  for (int step = 0; step < 100; ++step) insertParticles(b, second, 1e-2);
  EXPECT_EQ(first.x, second.x);
  const double heaviest = 1000.0 * 4.2 * 0.05 * 0.05 * 0.05;
  EXPECT_NEAR(a.insertedMass + a.refusedMass, 20.0, heaviest);
  EXPECT_GT(a.insertedMass, 15.0);
}

TEST(Insertion, BadSettingsAreRefused) {
  const auto refused = [](auto&& change) {
    InsertionSettings settings = shower;
    change(settings);
    EXPECT_THROW(makeInsertion(settings), InputError);
  };
  refused([](auto& s) { s.massPerSecond = 1.0; });
  refused([](auto& s) { s.numberPerSecond = 0.0; });
  refused([](auto& s) { s.numberPerSecond = -1.0; });
  refused([](auto& s) { s.density.value = 0.0; });
  refused([](auto& s) { s.region.upper.z = 0.09; });
  refused([](auto& s) { s.tries = 0; });
  refused([](auto& s) { s.velocity.x = std::nan(""); });
}

TEST(Removal, KeepsTheArraysTogether) {
  Particles particles;
  for (int i = 0; i < 10; ++i) addParticle(particles, {double(i), 0, 0}, {0, double(i), 0}, 0.1 + i, Mass{1.0 + i});
  switchOnRotation(particles);
  for (int i = 0; i < 10; ++i) particles.omega[i] = {0, 0, double(i)};
  const std::vector<int> list{7, 0, 7, 3};
  const std::vector<int> number = removeParticles(particles, list);
  EXPECT_EQ(number, (std::vector<int>{-1, 0, 1, -1, 2, 3, 4, -1, 5, 6}));
  validate(particles);
  ASSERT_EQ(particles.size(), 7u);
  for (int old = 0; old < 10; ++old) {
    if (number[old] < 0) continue;
    const auto i = static_cast<std::size_t>(number[old]);
    EXPECT_EQ(particles.x[i].x, old);
    EXPECT_EQ(particles.v[i].y, old);
    EXPECT_EQ(particles.omega[i].z, old);
    EXPECT_EQ(particles.radius[i], 0.1 + old);
    EXPECT_EQ(particles.mass[i], 1.0 + old);
    EXPECT_EQ(particles.id[i], old);
  }
  EXPECT_EQ(particlesInside(particles, {{4, 0, 0}, {6, 0, 0}}), (std::vector<int>{2, 3, 4}));
  EXPECT_EQ(particlesOutside(particles, {{2, -1, 0}, {8, 1, 0}}), (std::vector<int>{0, 6}));
  EXPECT_THROW(removeParticles(particles, std::vector<int>{0, 7}), InputError);
  EXPECT_EQ(particles.size(), 7u);
}

TEST(Removal, TakesWholeClumpsOutAndRenumbersTheRest) {
  Particles particles;
  Bodies bodies;
  Clumps clumps;
  const std::vector<Vec3> centre{{0, 0, 0}, {0.1, 0, 0}};
  const ClumpShape shape = makeClumpShape(centre, std::vector<double>{0.1, 0.1}, Density{1000.0});
  for (int i = 0; i < 4; ++i) {
    addClump(particles, bodies, clumps, shape, {double(i), 0, 0});
    addParticle(particles, {double(i), 5, 0}, {}, 0.1, Mass{1.0});
  }
  const std::vector<int> single = removeParticles(particles, std::vector<int>{2, 8});
  renumber(clumps, single);
  EXPECT_EQ(clumps.particle, (std::vector<int>{0, 1, 2, 3, 5, 6, 7, 8}));
  const std::vector<int> number = removeClumps(particles, bodies, clumps, std::vector<int>{1});
  EXPECT_EQ(number, (std::vector<int>{0, 1, -1, -1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(bodies.size(), 3u);
  EXPECT_EQ(clumps.body, (std::vector<int>{0, 0, 1, 1, 2, 2}));
  const std::vector<Vec3> before = particles.x;
  placeMembers(bodies, clumps, particles);
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_LE(norm(particles.x[i] - before[i]), 1e-15);
  const std::vector<int> broken = removeParticles(particles, std::vector<int>{0});
  EXPECT_THROW(renumber(clumps, broken), InputError);
}

}  // namespace
}  // namespace dovetail::dem
