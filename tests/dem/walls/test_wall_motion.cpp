// Spheres that move over walls: steadiness, energy, power, friction across edges.
#include <gtest/gtest.h>

#include <numbers>

#include "wall_scenes.hpp"

namespace dovetail::dem {
namespace {

struct Run {
  Particles particles;
  TriangulatedWall wall;
  Vec3 g;
  double dt;
  EdgeRule rule = EdgeRule::projected;
  WallCandidates candidates{};
  WallContacts contacts{};

  template <class Law>
  ContactWork forces(const Law& law) {
    updateWallCandidates(particles, wall, candidates, movesOf(particles, dt));
    clearForces(particles);
    applyGravity(particles, g);
    findWallContacts(particles, wall, candidates, rule, contacts);
    return sweepWall(law, particles, wall, contacts, dt);
  }

  template <class Law>
  ContactWork step(const Law& law) {
    kick(particles, 0.5 * dt);
    drift(particles, dt);
    const ContactWork work = forces(law);
    kick(particles, 0.5 * dt);
    return work;
  }

  double energy(const ContactWork& work) const {
    double sum = kineticEnergy(particles) + work.storedEnergy();
    for (std::size_t i = 0; i < particles.size(); ++i) sum -= particles.mass[i] * dot(g, particles.x[i]);
    return sum;
  }
};

Run start(TriangulatedWall wall, const Vec3& x, const Vec3& v, double radius, double mass, const Vec3& g, double dt) {
  Run run{{}, std::move(wall), g, dt};
  addParticle(run.particles, x, v, radius, Mass{mass});
  run.candidates.skin = 0.2 * radius;
  return run;
}

TEST(WallMotion, ASphereSlidesOverSixCoplanarTrianglesAsOverAPlane) {
  // Radius 0.5 m, 1 kg, 2000 N/m, 1 m/s², 1 m/s over 2 s: overlap 5e-4 m, wall force 1 N, speed 1 m/s throughout.
  std::vector<Vec3> x;
  for (int i = 0; i <= 3; ++i)
    for (const double y : {-1.0, 1.0}) x.push_back({1.0 * i, y, 0.0});
  auto wall = makeWall(x, {{0, 2, 1}, {2, 3, 1}, {2, 4, 3}, {4, 5, 3}, {4, 6, 5}, {6, 7, 5}});
  auto run = start(std::move(wall), {0.5, 0.1, 0.5 - 5e-4}, {1, 0, 0}, 0.5, 1.0, {0, 0, -1}, 1e-3);
  const ElasticLaw law{{2000.0}};
  run.forces(law);
  for (int i = 0; i < 2000; ++i) {
    run.step(law);
    ASSERT_EQ(run.contacts.size(), 1u);
    ASSERT_NEAR(run.contacts.overlap[0], 5e-4, 1e-12);
    ASSERT_NEAR(run.contacts.force[0].z, 1.0, 1e-9);
    ASSERT_NEAR(norm(run.particles.v[0] - Vec3{1, 0, 0}), 0.0, 1e-10);
  }
  EXPECT_NEAR(run.particles.x[0].x, 2.5, 1e-9);
}

/// Rough ground, hollow in the middle so that nobody leaves.
TriangulatedWall bowl(unsigned seed) {
  Random random(seed);
  auto wall = squares(12, 12, 0.25);
  for (Vec3& x : wall.x) {
    const double r2 = (x.x - 1.5) * (x.x - 1.5) + (x.y - 1.5) * (x.y - 1.5);
    x.z = 0.4 * r2 + random(-0.02, 0.02);
  }
  return wall;
}

double largestDrift(EdgeRule rule, double dt, double seconds) {
  auto run = start(bowl(7), {1.9, 1.4, 0.75}, {0.2, 0.5, 0}, 0.3, 1.0, {0, 0, -5}, dt);
  run.rule = rule;
  const ElasticLaw law{{4e4}};
  const double before = run.energy(run.forces(law));
  double worst = 0.0;
  for (double t = 0.0; t < seconds; t += dt) worst = std::max(worst, std::abs(run.energy(run.step(law)) - before));
  return worst / before;
}

TEST(WallMotion, EnergyOfASphereInARoughBowlIsConservedToSecondOrder) {
  const double coarse = largestDrift(EdgeRule::projected, 2e-4, 4.0),
               fine = largestDrift(EdgeRule::projected, 1e-4, 4.0);
  EXPECT_LE(coarse, 2e-3);
  EXPECT_LE(fine, coarse / 3.0);
  EXPECT_GE(largestDrift(EdgeRule::paper, 1e-4, 4.0), 10.0 * fine);
}

TEST(WallMotion, NoAngleOfIncidenceGainsEnergy) {
  const double radius = 0.3, speed = 1.0;
  for (const double bend : {-0.8, 0.0, 0.9})
    for (const double e : {0.9, 0.5})
      for (const double degrees : {1.0, 10.0, 45.0, 80.0, 88.0, 89.5, 89.9}) {
        const double angle = degrees * std::numbers::pi / 180.0;  // from the normal
        const Vec3 v{-speed * std::sin(angle), 0.05, -speed * std::cos(angle)};
        const LinearSpringDashpot normal{1e4, e};
        auto run = start(fold(bend, 3.0), {0.25, 0.1, radius * 1.001}, v, radius, 1.0, {}, 1e-4);
        double before = kineticEnergy(run.particles);
        const double entry = before;
        for (int i = 0; i < 8000; ++i) {
          const ContactWork work = run.step(ElasticLaw{normal});
          if (work.storedEnergy() > 0.0) continue;
          ASSERT_LE(kineticEnergy(run.particles), before * (1.0 + 1e-12)) << "bend " << bend << ", angle " << degrees;
          before = kineticEnergy(run.particles);
        }
        if (degrees <= 80.0) {
          EXPECT_LT(before, entry * (1.0 - 1e-3));
        }
      }
}

TEST(WallMotion, PowerBalancesOverBothSidesAtRandomStates) {
  Random random(11);
  int several = 0;
  for (int trial = 0; trial < 300; ++trial) {
    Particles particles;
    auto wall = squares(4, 4, 0.6);
    for (Vec3& x : wall.x) x += random.vector(0.2);
    for (Vec3& v : wall.v) v = random.vector(1.0);
    for (int i = 0; i < 5; ++i)
      addParticle(particles, {random(0.5, 1.9), random(0.5, 1.9), random(0.45, 0.65)}, random.vector(1.0), 0.5,
                  Mass{1.0});
    WallCandidates candidates;
    findWallCandidates(particles, wall, 0.1, candidates);
    WallContacts contacts;
    const ElasticLaw law{{2e3, 0.4}};
    const auto evaluate = [&](double t, double& particlePower, double& wallPower) {
      Particles p = particles;
      TriangulatedWall w = wall;
      drift(p, t);
      for (std::size_t i = 0; i < w.x.size(); ++i) w.x[i] += t * w.v[i];
      findWallContacts(p, w, candidates, EdgeRule::projected, contacts);
      const ContactWork work = sweepWall(law, p, w, contacts);
      addWallForces(contacts, w);
      particlePower = 0.0;
      for (std::size_t i = 0; i < p.size(); ++i) particlePower += dot(p.f[i], p.v[i]);
      wallPower = forcePower(w);
      return work;
    };
    double a, b, onParticles, onWall;
    const double h = 1e-7;
    const double rate = (evaluate(h, a, b).elasticEnergy - evaluate(-h, a, b).elasticEnergy) / (2.0 * h);
    const ContactWork work = evaluate(0.0, onParticles, onWall);
    for (const double engagement : contacts.engagement) several += engagement < 0.999;
    ASSERT_GE(work.dissipatedPower, 0.0);
    ASSERT_NEAR(onParticles + onWall, -rate - work.dissipatedPower, 1e-5 * (std::abs(rate) + work.dissipatedPower));
  }
  EXPECT_GT(several, 20);
}

/// Drags a sphere at constant velocity over a wall, pressed in by `overlap`; returns the tangential force each step.
std::vector<double> drag(TriangulatedWall wall, const Vec3& from, const Vec3& v, int steps, const FrictionalLaw& law) {
  auto run = start(std::move(wall), from, v, 0.3, 1.0, {}, 1e-3);
  std::vector<double> grip;
  for (int i = 0; i < steps; ++i) {
    drift(run.particles, run.dt);
    run.forces(law);
    EXPECT_EQ(run.contacts.size(), 1u);
    grip.push_back(-dot(run.particles.f[0], v) / norm(v));
  }
  return grip;
}

TEST(WallMotion, TheTangentialSpringIsCarriedAcrossEdges) {
  const double kt = 500.0, step = 1e-3 * 0.4;
  // Never slides: the force grows with the way, over a dozen edges and vertices.
  const auto sticking = drag(squares(6, 6, 0.1), {0.1, 0.1, 0.29}, {0.32, 0.24, 0}, 800, {{1e4}, {kt, 100.0}});
  for (std::size_t i = 0; i < sticking.size(); ++i)
    ASSERT_NEAR(sticking[i], kt * step * static_cast<double>(i + 1), 1e-9) << "step " << i;
  // Slides: the force stays at μ N once it is there.
  const auto sliding = drag(squares(6, 6, 0.1), {0.1, 0.1, 0.29}, {0.32, 0.24, 0}, 800, {{1e4}, {kt, 0.2}});
  for (std::size_t i = 200; i < sliding.size(); ++i) ASSERT_NEAR(sliding[i], 0.2 * 1e4 * 0.01, 1e-9);
}

Vec3 stretchOf(const WallContacts& contacts) {
  const auto& memory = contacts.springs.memory;
  return {memory.at(0), memory.at(1), memory.at(2)};
}

TEST(WallMotion, TheTangentialSpringTurnsWithTheNormalOverARidge) {
  // Around a ridge on a circle about it: the contact point stays on the edge, the stretch keeps its growth.
  const double kt = 500.0, distance = 0.29, rate = 1e-3;
  auto run = start(fold(-1.2, 2.0), {}, {}, 0.3, 1.0, {}, 1e-3);
  const FrictionalLaw law{{1e4}, {kt, 100.0}};
  for (int i = 0; i < 1000; ++i) {
    const double angle = -0.1 - rate * i;
    run.particles.x[0] = {distance * std::sin(angle), 0.1, distance * std::cos(angle)};
    run.particles.v[0] = -(distance * rate / run.dt) * Vec3{std::cos(angle), 0.0, -std::sin(angle)};
    run.forces(law);
    ASSERT_EQ(run.contacts.size(), 1u);
    ASSERT_NEAR(norm(stretchOf(run.contacts)), distance * rate * (i + 1), 1e-9);
    ASSERT_NEAR(dot(stretchOf(run.contacts), run.contacts.normal[0]), 0.0, 1e-12);
  }
}

TEST(WallMotion, ASpringWhoseContactEndsIsBooked) {
  auto run = start(squares(6, 6, 0.1), {0.31, 0.32, 0.29}, {0.1, 0, 0}, 0.3, 1.0, {}, 1e-3);
  const FrictionalLaw law{{1e4}, {500.0, 10.0}};
  double stored = 0.0;
  for (int i = 0; i < 20; ++i) {
    drift(run.particles, run.dt);
    stored = run.forces(law).tangentialEnergy;
  }
  run.particles.x[0].z = 0.31;
  const ContactWork work = run.forces(law);
  EXPECT_GT(stored, 0.0);
  EXPECT_NEAR(work.frictionPower * run.dt, stored, 1e-12 * stored);
  EXPECT_EQ(run.forces(law).frictionPower, 0.0);
}

}  // namespace
}  // namespace dovetail::dem
