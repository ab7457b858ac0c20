// Triangulated walls of a scene: seen through periods, moved by a function, a body or others.
#include <gtest/gtest.h>

#include <numbers>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/pairs/pairs.hpp"
#include "dovetail/dem/walls/mesh_wall.hpp"
#include "dovetail/dem/walls/primitive_wall.hpp"
#include "wall_scenes.hpp"

namespace dovetail::dem {
namespace {

/// Particles over one wall under gravity; they do not meet each other.
template <class Wall>
struct Ground {
  Particles particles;
  Wall wall;
  geometry::Periodicity periodicity{};
  Vec3 g{0, 0, -10};
  double time = 0.0;
  ContactWork work{};

  template <class Law>
  void step(const Law& law, double dt) {
    time += dt;
    kick(particles, 0.5 * dt);
    drift(particles, dt);
    const Moves moves = movesOf(particles, dt);
    startForces(particles, g);
    if constexpr (std::is_same_v<Wall, MeshWall>) {
      moveWall(wall, time, dt);
      findContacts(particles, wall, moves, periodicity);
      work = sweepWall(law, particles, wall.wall, wall.contacts, dt);
      gatherForces(wall);
    } else {
      drift(wall, dt);
      findContacts(particles, wall, moves, periodicity);
      work = sweepWall(law, particles, wall, dt);
    }
    kick(particles, 0.5 * dt);
  }
};

MeshWall meshOf(TriangulatedWall wall) {
  MeshWall mesh;
  mesh.wall = std::move(wall);
  return mesh;
}

Particles oneBall(const Vec3& x, const Vec3& v, double radius = 0.1) {
  Particles particles;
  addParticle(particles, x, v, radius, Mass{1.0});
  switchOnRotation(particles);
  return particles;
}

const FrictionalLaw rough{{1e4, 0.6}, {4e3, 0.5}};
const geometry::Periodicity square{{{0, 0, 0}, {1, 1, 1}}, {true, true, false}};

/// Where a ball with this start is after 3 s, during which it rolls over several periods.
template <class Wall>
Particles rollOver(Wall wall, const Vec3& v, bool wrap) {
  Ground<Wall> scene{oneBall({0.3, 0.4, 0.0995}, v), std::move(wall), square};
  for (int i = 0; i < 6000; ++i) {
    scene.step(rough, 5e-4);
    if (wrap && i % 37 == 0) wrapPositions(scene.particles, square);
  }
  return scene.particles;
}

TEST(MeshWalls, AFloorUnderPeriodsCarriesWhoRollsOverTheirBorders) {
  const Vec3 v{1.3, -0.9, 0};
  const Particles plane = rollOver(makePlane({}, {0, 0, 1}), v, false);
  EXPECT_GT(plane.x[0].x, 3.0);
  const auto twoTriangles = makeWall({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}});
  for (const bool wrap : {false, true})
    for (const TriangulatedWall& floor : {squares(4, 4, 0.25), twoTriangles, squares(3, 3, 1.0 / 3.0, true)}) {
      const Particles mesh = rollOver(meshOf(floor), v, wrap);
      EXPECT_LT(norm(square.minimumImage(mesh.x[0] - plane.x[0])), 1e-9);
      EXPECT_NEAR(mesh.x[0].z, plane.x[0].z, 1e-10);
      EXPECT_LT(norm(mesh.v[0] - plane.v[0]) + norm(mesh.omega[0] - plane.omega[0]), 1e-8);
    }
}

TEST(MeshWalls, AWaveThatRepeatsConservesEnergyAcrossItsBorders) {
  const auto drift = [](double dt) {
    TriangulatedWall floor = squares(6, 2, 1.0 / 6.0);
    for (Vec3& x : floor.x) {
      x.y *= 3.0;
      x.z = 0.04 * std::sin(2.0 * std::numbers::pi * x.x);
    }
    Ground<MeshWall> scene{oneBall({0.3, 0.45, 0.2}, {0.9, 0.13, 0}), meshOf(floor), square};
    const ElasticLaw law{{2e4}};
    const double start = kineticEnergy(scene.particles) + 10 * scene.particles.x[0].z;
    double worst = 0.0;
    for (double t = 0.0; t < 2.0; t += dt) {
      scene.step(law, dt);
      const double now = kineticEnergy(scene.particles) + 10 * scene.particles.x[0].z + scene.work.storedEnergy();
      worst = std::max(worst, std::abs(now - start) / start);
    }
    EXPECT_GT(std::abs(scene.particles.x[0].x), 1.0);
    return worst;
  };
  const double coarse = drift(2e-4);
  EXPECT_LT(coarse, 2e-3);
  EXPECT_LT(drift(1e-4), coarse / 3.0);
}

TEST(MeshWalls, ContactsThroughImagesHaveTheirReactionAndAnyNumberOfThreads) {
  Random random(3);
  Particles particles;
  for (int i = 0; i < 400; ++i)
    addParticle(particles, {random(-7, 9), random(-7, 9), random(-0.1, 0.1)}, random.vector(1.0), 0.1, Mass{1.0});
  TriangulatedWall floor = squares(8, 8, 0.125);
  for (Vec3& x : floor.x) x.z = 0.02 * std::cos(2.0 * std::numbers::pi * x.x);
  std::vector<Vec3> forces;
  for (const int count : {1, 3}) {
    setThreads(count);
    MeshWall mesh = meshOf(floor);
    Particles p = particles;
    findContacts(p, mesh, {}, square);
    sweepWall(rough, p, mesh.wall, mesh.contacts, 1e-4);
    gatherForces(mesh);
    setThreads(1);
    Vec3 sum = totalForce(mesh.wall);
    for (const Vec3& f : p.f) sum += f;
    EXPECT_LT(norm(sum), 1e-9);
    // The contact point is one radius less the overlap away from the image that it was seen from.
    for (std::size_t c = 0; c < mesh.contacts.size(); ++c)
      EXPECT_LT(norm(contactArm(p, mesh.contacts, mesh.wall, c)), 0.1);
    if (forces.empty()) forces = p.f;
    EXPECT_EQ(p.f, forces);
  }
  EXPECT_GT(norm(forces[0]) + norm(forces[1]) + norm(forces[2]) + norm(forces[3]), 0.0);
}

TEST(MeshWalls, AWallThatStartsFromRestPushesWhatItMeets) {
  // At rest for 200 steps, then 2 mm a step, as fast as the ball of 50 mm takes without a word.
  Ground<MeshWall> scene{oneBall({0.5, 0.5, 0.3}, {}, 0.05), meshOf(squares(4, 4, 0.25)), {}, {}};
  scene.wall.candidates.skin = 0.01;
  const double dt = 1e-4;
  prescribe(scene.wall,
            [=](double t) {
              const double moving = std::max(0.0, t - 200.5 * dt);
              return RigidMotion{{0, 0, 20.0 * moving}, {}, {0, 0, moving > 0.0 ? 20.0 : 0.0}, {}};
            },
            {});
  for (int i = 0; i < 600; ++i) scene.step(ElasticLaw{{1e6}}, dt);
  EXPECT_GT(scene.particles.x[0].z, scene.wall.wall.x[0].z);
  EXPECT_NEAR(scene.particles.v[0].z, 40.0, 2e-2);  // (ω dt)² / 24 of it
}

TEST(MeshWalls, AStepThatCouldPassAParticleIsRefusedByName) {
  Ground<MeshWall> scene{oneBall({0.5, 0.5, 0.3}, {}, 0.05), meshOf(squares(4, 4, 0.25)), {}, {}};
  addParticle(scene.particles, {0.5, 0.5, 1.2}, {}, 0.2, Mass{1.0});
  prescribe(scene.wall, [](double t) { return RigidMotion{{0, 0, 500.0 * t}, {}, {0, 0, 500.0}, {}}; }, {});
  try {
    for (int i = 0; i < 20; ++i) scene.step(ElasticLaw{{1e6}}, 2e-4);
    FAIL();
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("particle 0"), std::string::npos) << error.what();
  }
  EXPECT_LT(scene.time, 1e-3);
}

TEST(MeshWalls, AWallMovedByHandIsAnErrorOrKnown) {
  MeshWall mesh = meshOf(squares(4, 4, 0.25));
  const Particles particles = oneBall({0.5, 0.5, 0.3}, {});
  findContacts(particles, mesh, {0.0});
  for (Vec3& x : mesh.wall.x) x.z += 0.25;
  EXPECT_THROW(findContacts(particles, mesh, {0.0}), InputError);
  mesh.motion = MovedByOthers{0.25};
  findContacts(particles, mesh, {0.0});
  EXPECT_EQ(mesh.contacts.size(), 1u);
  EXPECT_THROW(findContacts(particles, mesh, {0.0}), InputError);
  for (Vec3& x : mesh.wall.x) x.z += 0.01;
  std::get<MovedByOthers>(mesh.motion).travel = 0.01;
  findContacts(particles, mesh, {0.0});
  EXPECT_NEAR(mesh.contacts.overlap.at(0), 0.06, 1e-12);
}

TEST(MeshWalls, AWallOnABodyGivesItsForces) {
  MeshWall mesh = meshOf(squares(4, 4, 0.25));
  Bodies bodies;
  const MassProperties properties{2.0, {0.5, 0.5, 0.0}, {1, 1, 1}, {}};
  mesh.motion = addWallBody(bodies, mesh.wall, properties, {0, 0, 1.0});
  Particles particles = oneBall({0.7, 0.5, 0.103}, {});
  driftBodies(bodies, 0.01);
  moveWall(mesh, 0.01, 0.01, &bodies);
  findContacts(particles, mesh, {0.0});
  sweepWall(ElasticLaw{{1e4}}, particles, mesh.wall, mesh.contacts, 1e-4);
  gatherForces(mesh, &bodies);
  EXPECT_NEAR(particles.f[0].z, 70.0, 1e-9);
  EXPECT_NEAR(bodies.f[0].z, -70.0, 1e-9);
  EXPECT_NEAR(bodies.torque[0].y, 0.2 * 70.0, 1e-9);
  EXPECT_EQ(drivingPower(mesh), 0.0);
  EXPECT_THROW(moveWall(mesh, 0.0, 0.0), InputError);
}

TEST(MeshWalls, ABeltPullsItsLoadToItsSpeedAndTheWorkIsBooked) {
  const double dt = 1e-4;
  const auto carry = [&](auto wall) {
    Ground<decltype(wall)> scene{oneBall({0.3, 0.4, 0.0990}, {}), std::move(wall), square};
    scene.wall.surfaceVelocity = {0.8, 0, 0};
    double work = 0.0, lost = 0.0;
    const auto energy = [&] {
      return kineticEnergy(scene.particles) + 10 * scene.particles.x[0].z + scene.work.storedEnergy();
    };
    scene.step(rough, dt);
    const double start = energy();
    for (int i = 0; i < 20000; ++i) {
      scene.step(rough, dt);
      work += dt * drivingPower(scene.wall);
      lost += dt * scene.work.lostPower();
    }
    // A ball that starts at rest rolls at last with 2/7 of the belt's speed.
    EXPECT_NEAR(scene.particles.v[0].x, 0.8 * 2.0 / 7.0, 1e-3);
    EXPECT_NEAR(energy() - start, work - lost, 2e-3 * work);
    EXPECT_GT(work, 0.05);
    return scene.particles.x[0];
  };
  const Vec3 plane = carry(makePlane({}, {0, 0, 1})), mesh = carry(meshOf(squares(4, 4, 0.25)));
  EXPECT_LT(norm(square.minimumImage(plane - mesh)), 1e-9);
}

}  // namespace
}  // namespace dovetail::dem
