#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/particles/particles.hpp"
#include "walls/wall_scenes.hpp"

namespace dovetail::dem {
namespace {

std::string complaint(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(Particles, MassFollowsFromDensity) {
  Particles particles;
  EXPECT_EQ(addParticle(particles, {}, {}, 0.1, Density{20000.0}), 0);
  EXPECT_NEAR(particles.mass[0], 83.7758, 1e-4);
  EXPECT_EQ(addParticle(particles, {}, {}, 0.1, Mass{2.0}), 1);
  EXPECT_DOUBLE_EQ(momentOfInertia(particles, 1), 0.4 * 2.0 * 0.01);
  EXPECT_TRUE(particles.omega.empty());
}

TEST(Particles, BadValuesAreRefusedWithParticleAndField) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  Particles particles;
  addParticle(particles, {}, {}, 1.0, Mass{1.0});
  const auto added = [&](const Vec3& x, const Vec3& v, double radius, double mass) {
    return complaint([&] { addParticle(particles, x, v, radius, Mass{mass}); });
  };
  EXPECT_NE(added({nan, 0, 0}, {}, 1, 1).find("particle 1, position"), std::string::npos);
  EXPECT_NE(added({0, -2e15, 0}, {}, 1, 1).find("farther than 1e15 m from the origin [particle 1, position]"),
            std::string::npos);
  EXPECT_NE(added({}, {0, inf, 0}, 1, 1).find("particle 1, velocity"), std::string::npos);
  EXPECT_NE(added({}, {}, 0, 1).find("particle 1, radius"), std::string::npos);
  EXPECT_NE(added({}, {}, 1, -1).find("particle 1, mass"), std::string::npos);
  EXPECT_NE(added({}, {}, nan, 1).find("particle 1, radius"), std::string::npos);
  EXPECT_EQ(particles.size(), 1u);
  EXPECT_NO_THROW(validate(particles));
  particles.mass[0] = 0.0;
  EXPECT_NE(complaint([&] { validate(particles); }).find("particle 0, mass"), std::string::npos);
  particles.mass = {1.0, 2.0};
  EXPECT_THROW(validate(particles), InputError);
  particles.v[0].z = nan;
  const std::string text = complaint([&] { requireFinite(particles, "t = 1 s"); });
  EXPECT_NE(text.find("velocity is not finite, t = 1 s [particle 0]"), std::string::npos) << text;
}

TEST(Particles, FreeFallIsExactInVelocityVerlet) {
  Particles particles;
  addParticle(particles, {1, 2, 3}, {4, 5, 6}, 0.1, Mass{2.0});
  const Vec3 g{0.5, -1.0, -9.81};
  const double dt = 0.01;
  applyGravity(particles, g);
  for (int step = 0; step < 100; ++step) {
    kick(particles, 0.5 * dt);
    drift(particles, dt);
    clearForces(particles);
    applyGravity(particles, g);
    kick(particles, 0.5 * dt);
  }
  EXPECT_NEAR(norm(particles.x[0] - (Vec3{5, 7, 9} + 0.5 * g)), 0.0, 1e-12);
  EXPECT_NEAR(norm(particles.v[0] - (Vec3{4, 5, 6} + g)), 0.0, 1e-12);
}

TEST(Particles, SumsAreThoseOfTheSpheres) {
  Particles particles;
  addParticle(particles, {1, 0, 0}, {0, 2, 0}, 0.5, Mass{3.0});
  EXPECT_DOUBLE_EQ(kineticEnergy(particles), 6.0);
  switchOnRotation(particles);
  particles.omega[0] = {0, 0, 4};
  EXPECT_DOUBLE_EQ(kineticEnergy(particles), 6.0 + 0.5 * 0.3 * 16.0);
  EXPECT_EQ(momentum(particles), (Vec3{0, 6, 0}));
  EXPECT_DOUBLE_EQ(angularMomentum(particles).z, 6.0 + 0.3 * 4.0);
  addParticle(particles, {}, {}, 1.0, Mass{1.0});
  EXPECT_EQ(particles.torque.size(), 2u);
  EXPECT_NO_THROW(validate(particles));
}

TEST(Particles, IdsStayAndAreNeverGivenTwice) {
  Particles particles;
  for (int i = 0; i < 6; ++i) addParticle(particles, {1.0 * i, 0, 0}, {}, 0.1, Mass{1.0});
  EXPECT_EQ(particles.id, (std::vector<std::int64_t>{0, 1, 2, 3, 4, 5}));
  const std::int64_t before = particles.revision;
  removeParticles(particles, std::vector<int>{5, 2});
  EXPECT_GT(particles.revision, before);
  EXPECT_EQ(addParticle(particles, {9, 0, 0}, {}, 0.1, Mass{1.0}), 4);
  EXPECT_EQ(particles.id.back(), 6);
  renumber(particles, std::vector<int>{4, 2, 0, 1, 3});
  EXPECT_NO_THROW(validate(particles));
  for (int i = 0; i < 5; ++i) EXPECT_EQ(find(particles, particles.id[static_cast<std::size_t>(i)]), i);
  EXPECT_EQ(particles.x[static_cast<std::size_t>(find(particles, 4))].x, 4.0);
  for (const std::int64_t gone : {-1, 2, 5, 7}) EXPECT_EQ(find(particles, gone), -1);
  particles.id[1] = particles.id[3];
  ++particles.revision;
  EXPECT_NE(complaint([&] { validate(particles); }).find("id"), std::string::npos);
}

TEST(Particles, AWeightedParticleMovesAsTheWholeOneUnderItsShareOfTheForce) {
  Particles whole, part;
  for (Particles* p : {&whole, &part}) {
    addParticle(*p, {1, 2, 3}, {4, 5, 6}, 0.1, Mass{2.0});
    switchOnRotation(*p);
  }
  part.weight = {0.25};
  const Vec3 g{0.5, -1.0, -9.81}, force{1, 2, -3}, torque{0.1, 0.2, 0.3};
  for (auto [p, fraction] : {std::pair{&whole, 1.0}, std::pair{&part, 0.25}}) {
    startForces(*p, g);
    for (int step = 0; step < 20; ++step) {
      p->f[0] += fraction * force;
      p->torque[0] += fraction * torque;
      turnStep(*p, 0.01, g);
    }
    kick(*p, 0.005);
  }
  EXPECT_EQ(whole.x, part.x);
  EXPECT_EQ(whole.v, part.v);
  EXPECT_EQ(whole.omega, part.omega);
  EXPECT_EQ(0.25 * kineticEnergy(whole), kineticEnergy(part));
  EXPECT_EQ(0.25 * momentum(whole), momentum(part));
  EXPECT_EQ(0.25 * angularMomentum(whole), angularMomentum(part));
  for (const double wrong : {0.0, -1.0, 1.5, std::numeric_limits<double>::quiet_NaN()}) {
    part.weight = {wrong};
    EXPECT_NE(complaint([&] { validate(part); }).find("weight"), std::string::npos);
  }
}

TEST(Particles, OneSweepHasTheDigitsOfItsVerbs) {
  const Vec3 g{0.5, -1.0, -9.81};
  const double dt = 1e-3;
  for (const bool spins : {false, true})
    for (const bool weighted : {false, true}) {
      Random random(7);
      Particles verbs;
      for (int i = 0; i < 11; ++i)
        addParticle(verbs, random.vector(1.0), random.vector(0.5), random(0.1, 0.3), Mass{random(1.0, 5.0)});
      if (spins) switchOnRotation(verbs);
      if (weighted)
        for (int i = 0; i < 11; ++i) verbs.weight.push_back(random(0.1, 1.0));
      for (Vec3& f : verbs.f) f = random.vector(20.0);
      for (Vec3& omega : verbs.omega) omega = random.vector(3.0);
      for (Vec3& torque : verbs.torque) torque = random.vector(2.0);
      Particles sweep = verbs;
      const double moved = turnStep(sweep, dt, g);
      kick(verbs, 0.5 * dt);
      kick(verbs, 0.5 * dt);
      drift(verbs, dt);
      startForces(verbs, g);
      EXPECT_EQ(sweep.x, verbs.x);
      EXPECT_EQ(sweep.v, verbs.v);
      EXPECT_EQ(sweep.f, verbs.f);
      EXPECT_EQ(sweep.omega, verbs.omega);
      EXPECT_EQ(sweep.torque, verbs.torque);
      double most = 0.0;
      for (const Vec3& v : verbs.v) most = std::max(most, dt * norm(v));
      EXPECT_NEAR(moved, most, 1e-15);
      // One number that is none stops its particle alone.
      sweep.v[5].y = std::numeric_limits<double>::quiet_NaN();
      const Vec3 before = sweep.x[5], other = sweep.x[6];
      EXPECT_EQ(turnStep(sweep, dt, g), std::numeric_limits<double>::infinity());
      EXPECT_EQ(sweep.x[5], before);
      EXPECT_NE(sweep.x[6], other);
    }
}

TEST(Particles, NoParticlesIsNoError) {
  Particles particles;
  EXPECT_NO_THROW(validate(particles));
  clearForces(particles);
  applyGravity(particles, {0, 0, -1});
  kick(particles, 1.0);
  drift(particles, 1.0);
  EXPECT_EQ(kineticEnergy(particles), 0.0);
  EXPECT_EQ(momentum(particles), Vec3{});
}

}  // namespace
}  // namespace dovetail::dem
