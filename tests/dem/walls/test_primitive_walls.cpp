// Planes, cylinders and spheres: their search while they move, and under periods.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/laws/materials.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/dem/walls/primitive_wall.hpp"
#include "wall_scenes.hpp"

namespace dovetail::dem {
namespace {

Particles cloud(int n, double size, unsigned seed = 4) {
  Random random(seed);
  Particles particles;
  for (int i = 0; i < n; ++i)
    addParticle(particles, random.vector(size), random.vector(1.0), random(0.02, 0.05), Mass{1.0});
  switchOnRotation(particles);
  return particles;
}

/// Numbers of the particles that touch, by looking at all.
std::vector<int> touching(const Particles& particles, const PrimitiveWall& wall) {
  std::vector<int> list;
  for (std::size_t i = 0; i < particles.size(); ++i)
    if (distanceTo(wall, particles.x[i]).distance < particles.radius[i]) list.push_back(static_cast<int>(i));
  return list;
}

TEST(PrimitiveWalls, NoContactIsMissedWhileAllMoveAndTurn) {
  std::vector<PrimitiveWall> walls{makePlane({}, {0, 0, 1}), makeCylinder({}, {0, 0, 1}, 0.5),
                                   makeCylinder({}, {0, 0, 1}, 0.3, false), makeSphere({0.2, 0, 0}, 0.6),
                                   makeSphere({}, 0.4, false)};
  for (PrimitiveWall& wall : walls) {
    Particles particles = cloud(400, 1.0);
    wall.velocity = {0.3, 0.1, -0.2};
    wall.angularVelocity = {0.9, -0.4, 0.3};
    wall.skin = 0.05;
    for (int step = 0; step < 200; ++step) {
      const double dt = 1e-3;
      drift(particles, dt);
      drift(wall, dt);
      findContacts(particles, wall, movesOf(particles, dt));
      ASSERT_EQ(wall.contacts.particle, touching(particles, wall)) << step;
    }
    EXPECT_GT(wall.contacts.size(), 2u);
    EXPECT_LT(wall.search.builds, 60);
  }
}

TEST(PrimitiveWalls, ADrumThatSpinsAboutItsAxisIsNotSearchedAgain) {
  const Particles particles = cloud(50, 0.5);
  PrimitiveWall drum = makeCylinder({}, {0, 1, 0}, 0.6);
  drum.angularVelocity = {0, 20.0, 0};
  for (int step = 0; step < 100; ++step) {
    drift(drum, 1e-3);
    findContacts(particles, drum, {0.0});
  }
  EXPECT_EQ(drum.search.builds, 1);
  EXPECT_NEAR(drum.search.margin, defaultSkin(particles), 0.0);
}

TEST(PrimitiveWalls, TheSkinIsAShareOfTheDiameterUnlessSet) {
  const Particles particles = cloud(300, 0.5);
  double sum = 0.0;
  for (const double r : particles.radius) sum += 2.0 * r;
  EXPECT_NEAR(defaultSkin(particles), 0.15 * sum / 300.0, 1e-15);
  PrimitiveWall wall = makePlane({}, {0, 0, 1});
  for (int i = 0; i < 5; ++i) findContacts(particles, wall, {0.0});
  EXPECT_EQ(wall.search.builds, 1);
  wall.skin = 0.0;
  wall.search = {};
  for (int i = 0; i < 5; ++i) findContacts(particles, wall, {0.0});
  EXPECT_EQ(wall.search.builds, 5);
  wall.skin = -1.0;
  wall.search = {};
  EXPECT_THROW(findContacts(particles, wall, {0.0}), InputError);
}

TEST(PrimitiveWalls, EveryImageOfAParticleMeetsTheWallAlike) {
  const geometry::Periodicity periodicity{{{0, 0, 0}, {2, 2, 2}}, {true, true, false}};
  Random random(8);
  const Particles here = cloud(500, 1.0);
  Particles there = here;
  for (Vec3& x : there.x) x += Vec3{2.0 * std::round(random(-4, 4)), 2.0 * std::round(random(-4, 4)), 0.0};
  const std::vector<PrimitiveWall> walls{makePlane({}, {0, 0, 1}), makeCylinder({0.9, 0.9, 0}, {0, 0, 1}, 0.5, false),
                                         makeCylinder({0.9, 0, 0.9}, {0, 1, 0}, 0.9),
                                         makeSphere({0.9, -0.9, 0}, 0.6, false)};
  for (PrimitiveWall wall : walls) {
    wall.angularVelocity = wall.shape == PrimitiveWall::Shape::cylinder ? 3.0 * wall.axis : Vec3{};
    PrimitiveWall other = wall;
    Particles a = here, b = there;
    findContacts(a, wall, {}, periodicity);
    findContacts(b, other, {}, periodicity);
    EXPECT_EQ(wall.contacts.particle, other.contacts.particle);
    // All that are nearer to it through some image, and only those.
    std::vector<int> expected;
    for (std::size_t i = 0; i < a.size(); ++i) {
      double nearest = wall.inside ? -1e9 : 1e9;
      for (const double sx : {-2.0, 0.0, 2.0})
        for (const double sy : {-2.0, 0.0, 2.0}) {
          const double d = distanceTo(wall, a.x[i] + Vec3{sx, sy, 0}).distance;
          nearest = wall.inside ? std::max(nearest, d) : std::min(nearest, d);
        }
      if (nearest < a.radius[i]) expected.push_back(static_cast<int>(i));
    }
    EXPECT_EQ(wall.contacts.particle, expected);
    const FrictionalLaw law{{1e4, 0.5}, {3e3, 0.4}};
    sweepWall(law, a, wall, 1e-4);
    sweepWall(law, b, other, 1e-4);
    EXPECT_GT(wall.contacts.size(), 5u);
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_LT(norm(a.f[i] - b.f[i]), 1e-9);
      EXPECT_LT(norm(a.torque[i] - b.torque[i]), 1e-9);
    }
    EXPECT_LT(norm(wall.torque - other.torque), 1e-7);
  }
}

TEST(PrimitiveWalls, WhatDoesNotRepeatWithThePeriodsIsRefused) {
  const geometry::Periodicity periodicity{{{0, 0, 0}, {2, 2, 2}}, {true, false, false}};
  const Particles particles = cloud(5, 0.5);
  for (PrimitiveWall wall : {makePlane({}, {1, 0, 3}), makeCylinder({}, {1, 1, 0}, 0.1),
                             makeCylinder({}, {0, 0, 1}, 1.1), makeSphere({}, 0.99, false)})
    EXPECT_THROW(findContacts(particles, wall, {}, periodicity), InputError);
}

TEST(PrimitiveWalls, AStepThatCouldPassAParticleIsRefusedByName) {
  Particles particles;
  addParticle(particles, {0, 0, 0.5}, {}, 0.05, Mass{1.0});
  addParticle(particles, {0, 0, 3.0}, {}, 0.2, Mass{1.0});
  PrimitiveWall ball = makeSphere({}, 0.3, false);
  ball.velocity = {0, 0, 1.0};
  findContacts(particles, ball, {0.0});
  drift(ball, 0.04);
  EXPECT_NO_THROW(findContacts(particles, ball, {0.0}));
  drift(ball, 0.9);
  try {
    findContacts(particles, ball, {0.0});
    FAIL();
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("particle 0"), std::string::npos) << error.what();
  }
  PrimitiveWall astray = makePlane({}, {0, 0, 1});
  astray.velocity.x = std::numeric_limits<double>::quiet_NaN();
  drift(astray, 1e-3);
  EXPECT_THROW(findContacts(particles, astray, {0.0}), NumericalError);
}

/// What removing a particle of material 1 from a wall says it stored; nothing is left to be lost.
template <class Touch>
void expectLeaverIsBooked(const Touch& touch) {
  const auto law = [](int a, int b) { return FrictionalLaw{{1e4 * (1 + a + b), 1.0}, {3e3 * (1 + a + b), 10.0}}; };
  const auto laws = makeContactLaws(makeLawTable(2, law));
  Particles particles;
  for (const double x : {0.2, 0.5, 0.8}) addParticle(particles, {x, 0.5, 0.099}, {0.1, 0, 0}, 0.1, Mass{1.0});
  switchOnRotation(particles);
  particles.material = {0, 1, 0};
  const double dt = 1e-3;
  ContactWork work;
  for (int i = 0; i < 10; ++i) {
    drift(particles, dt);
    work = touch.sweep(*laws, particles, dt);
  }
  const double one = 0.5 * 1e4 * 1e-6;
  EXPECT_NEAR(work.elasticEnergy, 4.0 * one, 1e-12);
  const double side = work.tangentialEnergy / 4.0;
  EXPECT_GT(side, 0.0);
  const std::vector<int> number = numbersWithout(particles, std::vector<int>{1});
  EXPECT_NEAR(touch.renumbered(number), 2.0 * (one + side), 1e-12);
  renumber(particles, number);
  const ContactWork after = touch.sweep(*laws, particles, dt);
  EXPECT_EQ(after.frictionPower, 0.0);
  EXPECT_NEAR(after.elasticEnergy, 2.0 * one, 1e-12);
}

struct PlaneTouch {
  mutable PrimitiveWall wall = makePlane({}, {0, 0, 1});
  ContactWork sweep(const ContactLaws& laws, Particles& p, double dt) const {
    findContacts(p, wall, movesOf(p, dt));
    return laws.wall(p, wall, dt, Booking::on);
  }
  double renumbered(const std::vector<int>& number) const { return renumber(wall, number); }
};

struct MeshTouch {
  TriangulatedWall wall = squares(4, 4, 0.25);
  mutable WallCandidates candidates;
  mutable WallContacts contacts;
  ContactWork sweep(const ContactLaws& laws, Particles& p, double dt) const {
    updateWallCandidates(p, wall, candidates, movesOf(p, dt));
    findWallContacts(p, wall, candidates, EdgeRule::projected, contacts);
    return laws.wall(p, wall, contacts, dt, Booking::on);
  }
  double renumbered(const std::vector<int>& number) const { return renumber(contacts, number); }
};

/// A sphere of 2 kg rests on a plane under 10 m/s², which moves up and aside by v (1 − cos 2πt)/2 and stops.
double largestImbalance(double dt) {
  Model m;
  addParticle(m.particles, {0, 0, 0.1 - 2e-4}, {}, 0.1, Mass{2.0});
  FrictionalLaw law;
  law.normal.stiffness = 1e5;
  law.tangential = {.stiffness = 8e4, .friction = 0.3};
  m.laws = makeContactLaws(law);
  m.gravity = {0, 0, -10};
  addWall(m, makePlane({}, {0, 0, 1})).motion = [](double t, PrimitiveWall& wall) {
    wall.velocity = t < 1.0 ? 0.5 * (1.0 - std::cos(2.0 * std::numbers::pi * t)) * Vec3{0.05, 0, 0.1} : Vec3{};
  };
  run(m, dt, 1);
  const double start = energies(m).balance();
  double worst = 0.0;
  for (double t = 0.0; t < 1.2; t += 0.05) {
    run(m, dt, std::lround(0.05 / dt));
    worst = std::max(worst, std::abs(energies(m).balance() - start));
  }
  EXPECT_GT(energies(m).walls, 0.9);  // 20 N over 0.05 m
  return worst;
}

TEST(PrimitiveWalls, TheWorkOfAMotionThatChangesIsBookedAsItIsDone) {
  const double coarse = largestImbalance(5e-4), fine = largestImbalance(2.5e-4);
  EXPECT_LT(fine, 1e-6);
  EXPECT_GT(coarse / fine, 3.0) << "of second order in the step";
}

TEST(Walls, WhatALeaverStoredAndRememberedIsBooked) {
  expectLeaverIsBooked(PlaneTouch{});
  expectLeaverIsBooked(MeshTouch{});
}

}  // namespace
}  // namespace dovetail::dem
