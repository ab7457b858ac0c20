// Walls that move as rigid bodies, along a given motion or freely.
#include <gtest/gtest.h>

#include "box_wall.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/dem/walls/rigid_wall.hpp"
#include "wall_scenes.hpp"

namespace dovetail::dem {
namespace {

/// Balls that fly at a free box.
struct Billiard {
  TriangulatedWall wall = boxWall({-0.2, -0.15, -0.1}, {0.4, 0.3, 0.2});
  Bodies bodies;
  WallOnBody carrier = addWallBody(bodies, wall, Density{500.0}, {}, {0.5, 1.0, -2.0});
  Particles balls;
  WallCandidates candidates;
  WallContacts contacts;

  Billiard() {
    Random random(5);
    for (int i = 0; i < 30; ++i) {
      const Vec3 way = normalized(random.vector(1.0));
      addParticle(balls, (0.35 + 0.06 * i) * way, -2.0 * way + random.vector(0.1), 0.05, Density{1000.0});
    }
    findWallCandidates(balls, wall, 0.03, candidates);
  }

  /// Returns the stored energy.
  double step(const ElasticLaw& law, double dt) {
    kick(balls, 0.5 * dt);
    kickBodies(bodies, 0.5 * dt);
    drift(balls, dt);
    driftBodies(bodies, dt);
    placeWall(bodies, carrier, wall);
    updateWallCandidates(balls, wall, candidates, movesOf(balls, dt));
    findWallContacts(balls, wall, candidates, EdgeRule::projected, contacts);
    clearForces(balls);
    clearForces(bodies);
    clearForces(wall);
    const double stored = sweepWall(law, balls, wall, contacts).storedEnergy();
    addWallForces(contacts, wall);
    gatherForces(wall, carrier, bodies);
    return stored;
  }
  void finish(double dt) {
    kick(balls, 0.5 * dt);
    kickBodies(bodies, 0.5 * dt);
    placeWall(bodies, carrier, wall);
  }
  double kinetic() const { return kineticEnergy(bodies) + kineticEnergy(balls); }
};

TEST(RigidWall, AFreeBoxHitByBallsKeepsMomentumAndEnergy) {
  Billiard game;
  EXPECT_NEAR(game.bodies.mass[0], 12.0, 1e-12);
  const auto linear = [&] { return momentum(game.bodies) + momentum(game.balls); };
  const auto spin = [&] { return angularMomentum(game.bodies) + angularMomentum(game.balls); };
  const Vec3 linearBefore = linear(), spinBefore = spin();
  const double energy = game.kinetic(), dt = 2e-5;
  double worst = 0.0, mostStored = 0.0;
  for (int k = 0; k < 40000; ++k) {
    const double stored = game.step({{.stiffness = 1e5}}, dt);
    ASSERT_NEAR(forcePower(game.wall),
                dot(game.bodies.f[0], game.bodies.v[0]) + dot(game.bodies.torque[0], angularVelocity(game.bodies, 0)),
                1e-9);
    game.finish(dt);
    mostStored = std::max(mostStored, stored);
    worst = std::max(worst, std::abs(game.kinetic() + stored - energy));
  }
  EXPECT_GT(mostStored, 0.01 * energy);
  EXPECT_LE(worst, 2e-4 * energy);
  EXPECT_LE(norm(linear() - linearBefore), 1e-10);
  EXPECT_LE(norm(spin() - spinBefore), 1e-10);
  EXPECT_GT(norm(game.bodies.v[0]), 0.01);
}

TEST(RigidWall, PrescribedMotionsGiveVelocitiesThatAreTheirRates) {
  TriangulatedWall wall = boxWall({0, 0, 0}, {1, 2, 3});
  const std::vector<Vec3> offset = vertexOffsets(wall, {0.5, 0.5, 0.5});
  const RigidMotion start{{1, 0, 0}, normalized(Quaternion{1, 0.3, 0, 0}), {0.4, 0, -0.2}, {0.3, 2.0, 1.0}};
  for (const PrescribedMotion& motion : {steadyMotion(start), vibration(start, {0.1, 0, 0.2}, 3.0, 0.4)}) {
    const double h = 1e-6, t = 0.7;
    placeWall(motion(t - h), offset, wall);
    const std::vector<Vec3> before = wall.x;
    placeWall(motion(t + h), offset, wall);
    const std::vector<Vec3> after = wall.x;
    placeWall(motion(t), offset, wall);
    for (std::size_t k = 0; k < 8; ++k)
      EXPECT_LE(norm((after[k] - before[k]) / (2.0 * h) - wall.v[k]), 1e-8 * (1.0 + norm(wall.v[k])));
    EXPECT_NEAR(norm(wall.x[7] - wall.x[0]), std::sqrt(14.0), 1e-14);
  }
  EXPECT_THROW(placeWall(start, {}, wall), InputError);
}

}  // namespace
}  // namespace dovetail::dem
