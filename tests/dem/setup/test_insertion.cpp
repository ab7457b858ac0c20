// Particles that enter and leave.
#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/setup/insertion.hpp"
#include "walls/wall_scenes.hpp"

namespace dovetail::dem {
namespace {

const InsertionOptions shower{.region = {{0, 0, 0}, {1, 1, 0.4}},
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
    entered += insertParticles(insertion, particles, {}, 1e-3);
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
  InsertionOptions crowd = shower;
  crowd.region = {{0, 0, 0}, {0.3, 0.3, 0.3}};
  Insertion insertion = makeInsertion(crowd);
  Particles particles;
  insertParticles(insertion, particles, {}, 2.0);
  EXPECT_EQ(insertion.inserted + insertion.refused, 600);
  EXPECT_GT(insertion.refused, 300);
  EXPECT_EQ(particles.size(), static_cast<std::size_t>(insertion.inserted));
}

TEST(Insertion, ByMassAndTheSameForTheSameSeed) {
  InsertionOptions settings = shower;
  settings.numberPerSecond = 0.0;
  settings.massPerSecond = 20.0;
  Insertion a = makeInsertion(settings), b = makeInsertion(settings);
  Particles first, second;
  switchOnRotation(first);
  for (int step = 0; step < 100; ++step) insertParticles(a, first, {}, 1e-2);
  for (int step = 0; step < 100; ++step) insertParticles(b, second, {}, 1e-2);
  EXPECT_EQ(first.x, second.x);
  const double heaviest = 1000.0 * 4.2 * 0.05 * 0.05 * 0.05;
  EXPECT_NEAR(a.insertedMass + a.refusedMass, 20.0, heaviest);
  EXPECT_GT(a.insertedMass, 15.0);
}

TEST(Insertion, EndsAtItsTotals) {
  InsertionOptions settings = shower;
  settings.totalNumber = 37;
  Insertion counted = makeInsertion(settings);
  Particles particles;
  for (int step = 0; step < 1000; ++step) insertParticles(counted, particles, {}, 1e-3);
  EXPECT_EQ(counted.inserted, 37);
  EXPECT_EQ(particles.size(), 37U);
  EXPECT_TRUE(isComplete(counted));
  settings.totalNumber = std::numeric_limits<std::int64_t>::max();
  for (std::uint64_t seed = 1; seed < 20; ++seed) {
    settings.totalMass = 5.0;
    settings.seed = seed;
    Insertion weighed = makeInsertion(settings);
    Particles others;
    insertParticles(weighed, others, {}, 2.0);
    double mass = 0.0;
    for (const double m : others.mass) mass += m;
    EXPECT_NEAR(mass, weighed.insertedMass, 1e-12);
    ASSERT_TRUE(isComplete(weighed));
    EXPECT_NEAR(mass, 5.0, 0.5 * 1000.0 * boundsOf(settings.sizes).largest * 4.189 * 0.05 * 0.05);
    const double r = weighed.nextRadius, next = 1000.0 * 4.0 / 3.0 * std::numbers::pi * r * r * r;
    EXPECT_GE(mass + next - 5.0, 5.0 - mass);  // which would not come closer
  }
}

TEST(Insertion, BadSettingsAreRefused) {
  const auto refused = [](auto&& change) {
    InsertionOptions settings = shower;
    change(settings);
    EXPECT_THROW(makeInsertion(settings), InputError);
  };
  refused([](auto& s) { s.massPerSecond = 1.0; });
  refused([](auto& s) { s.spin.y = INFINITY; });
  refused([](auto& s) { s.replacesLeavers = true; });
  refused([](auto& s) { s.numberPerSecond = 0.0; });
  refused([](auto& s) { s.material = 256; });
  refused([](auto& s) { s.interval = -1.0; });
  refused([](auto& s) { s.numberPerSecond = -1.0; });
  refused([](auto& s) { s.density.value = 0.0; });
  refused([](auto& s) { s.region.upper.z = 0.09; });
  refused([](auto& s) { s.tries = 0; });
  refused([](auto& s) { s.from = -1.0; });
  refused([](auto& s) { s.until = s.from; });
  refused([](auto& s) { s.totalNumber = 0; });
  refused([](auto& s) { s.totalMass = 0.0; });
  refused([](auto& s) { s.velocity.x = std::nan(""); });
}

/// Whether any two spheres overlap, images included; members of one body may.
bool overlap(const Particles& particles, const geometry::Periodicity& space, const Clumps& clumps = {}) {
  std::vector<int> body(particles.size(), -1);
  for (std::size_t m = 0; m < clumps.size(); ++m) body[static_cast<std::size_t>(clumps.particle[m])] = clumps.body[m];
  for (std::size_t i = 0; i < particles.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if ((body[i] < 0 || body[i] != body[j]) &&
          norm(space.minimumImage(particles.x[i] - particles.x[j])) <= particles.radius[i] + particles.radius[j])
        return true;
  return false;
}

TEST(Insertion, SeesImagesWhereverParticlesHaveDrifted) {
  const geometry::Periodicity space{{{0, 0, 0}, {1, 1, 1}}, {true, true, false}};
  InsertionOptions settings = shower;
  settings.numberPerSecond = 1000.0;
  Particles particles;
  for (int i = 0; i < 9; ++i)  // drifted by whole periods
    addParticle(particles, {0.3 * (i % 3) + i % 4 - 1.9, 0.3 * (i / 3) - i % 5 + 1.95, 0.2}, {}, 0.08, Density{1000.0});
  ASSERT_FALSE(overlap(particles, space));
  for (const double lower : {0.0, -0.4}) {  // the whole period, and a part of it across its face
    settings.region = {{lower, 0, 0}, {lower + (lower < 0.0 ? 0.9 : 1.0), 1, 0.4}};
    Insertion insertion = makeInsertion(settings);
    insertParticles(insertion, particles, {.space = space}, 0.3);
    EXPECT_GT(insertion.inserted, 20);
    EXPECT_FALSE(overlap(particles, space));
  }
  bool across = false;
  for (std::size_t i = 9; i < particles.size(); ++i)
    across = across || particles.x[i].y < particles.radius[i] || particles.x[i].y > 1.0 - particles.radius[i];
  EXPECT_TRUE(across);
}

TEST(Insertion, KeepsClearOfWallsOfAllKinds) {
  const PrimitiveWall plane = makePlane({0, 0, 0.1}, {0, 0.2, 1}), pipe = makeCylinder({0.5, 0.5, 0}, {0, 0, 1}, 0.5),
                      ball = makeSphere({1.0, 0.5, 0.2}, 0.2, false);
  TriangulatedWall sheet = makeWall({{0.5, 0, 0}, {0.5, 1, 0}, {0.5, 0, 1}}, {{0, 1, 2}});
  InsertionOptions settings = shower;
  settings.numberPerSecond = 1e4;
  Insertion insertion = makeInsertion(settings);
  Particles particles;
  const geometry::Periodicity space{{{0, 0, 0}, {1, 1, 1}}, {true, false, false}};
  insertParticles(insertion, particles, {.space = space, .walls = {&plane, &pipe, &ball}, .meshes = {&sheet}}, 0.1);
  EXPECT_GT(insertion.inserted, 20);
  bool nearImage = false;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const Vec3& x = particles.x[i];
    const double r = particles.radius[i];
    for (const PrimitiveWall* wall : {&plane, &pipe, &ball}) EXPECT_GE(distanceTo(*wall, x).distance, r);
    EXPECT_GE(distanceTo(ball, x + Vec3{1, 0, 0}).distance, r);
    nearImage = nearImage || distanceTo(ball, x + Vec3{1, 0, 0}).distance < 0.1;
    const bool beside = x.y + x.z < 1.0;  // of the sheet's slanted edge
    if (beside) {
      EXPECT_GE(std::abs(x.x - 0.5), r);
    }
  }
  EXPECT_TRUE(nearImage);
  EXPECT_FALSE(overlap(particles, space));
}

TEST(Insertion, GivesMaterialSpinAndAnInterval) {
  InsertionOptions settings = shower;
  settings.material = 2;
  settings.spin = {1, 2, 3};
  settings.interval = 0.1;
  Insertion insertion = makeInsertion(settings);
  Particles particles;
  addParticle(particles, {0.5, 0.5, 0.9}, {}, 0.05, Density{1000.0});
  EXPECT_THROW(insertParticles(insertion, particles, {}, 0.11), InputError);
  switchOnRotation(particles);
  int calls = 0;
  for (int step = 0; step < 100; ++step) calls += insertParticles(insertion, particles, {}, 0.01) > 0;
  EXPECT_LE(calls, 11);
  EXPECT_GT(insertion.inserted, 200);
  EXPECT_EQ(particles.material[0], 0);
  for (std::size_t i = 1; i < particles.size(); ++i) {
    EXPECT_EQ(particles.material[i], 2);
    EXPECT_EQ(particles.omega[i], (Vec3{1, 2, 3}));
  }
}

TEST(Insertion, LetsInClumpsOfSeveralShapesTurnedAtRandom) {
  const std::vector<Vec3> rod{{0, 0, 0}, {0.06, 0, 0}}, bent{{0, 0, 0}, {0.05, 0, 0}, {0.05, 0.05, 0}};
  InsertionOptions settings = shower;
  settings.shapes = {makeClumpShape(rod, std::vector<double>{0.03, 0.03}, Density{1000.0}),
                     makeClumpShape(bent, std::vector<double>{0.03, 0.02, 0.02}, Density{1000.0})};
  Insertion insertion = makeInsertion(settings);
  Particles particles;
  Bodies bodies;
  Clumps clumps;
  EXPECT_THROW(insertParticles(insertion, particles, {}, 1.0), InputError);
  insertParticles(insertion, particles, bodies, clumps, {}, 0.0);
  EXPECT_GT(bodies.size(), 60u);
  check(particles, bodies, clumps);
  EXPECT_FALSE(overlap(particles, {}, clumps));
  double mass = 0.0, flat = 0.0;
  for (const double m : bodies.mass) mass += m;
  EXPECT_NEAR(mass, insertion.insertedMass, 1e-12 * mass);
  for (std::size_t i = 0; i < particles.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      EXPECT_GE(particles.x[i][k], settings.region.lower[k] + particles.radius[i] - 1e-15);
      EXPECT_LE(particles.x[i][k], settings.region.upper[k] - particles.radius[i] + 1e-15);
    }
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const double up = rotate(bodies.orientation[b], {1, 0, 0}).z;
    flat += up * up / static_cast<double>(bodies.size());
  }
  EXPECT_NEAR(flat, 1.0 / 3.0, 0.1);
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
  renumber(bodies, clumps, single);
  EXPECT_EQ(clumps.particle, (std::vector<int>{0, 1, 2, 3, 5, 6, 7, 8}));
  const std::vector<int> number = removeClumps(particles, bodies, clumps, std::vector<int>{1});
  EXPECT_EQ(number, (std::vector<int>{0, 1, -1, -1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(bodies.size(), 3u);
  EXPECT_EQ(clumps.body, (std::vector<int>{0, 0, 1, 1, 2, 2}));
  const std::vector<Vec3> before = particles.x;
  placeMembers(bodies, clumps, {}, particles);
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_LE(norm(particles.x[i] - before[i]), 1e-15);
  const std::vector<int> broken = removeParticles(particles, std::vector<int>{0});
  EXPECT_THROW(renumber(bodies, clumps, broken), InputError);
}

}  // namespace
}  // namespace dovetail::dem
