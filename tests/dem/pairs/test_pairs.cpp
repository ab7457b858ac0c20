// Particle–particle contacts.
#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/laws/contact_laws.hpp"
#include "dovetail/dem/pairs/pair_collide.hpp"
#include "walls/wall_scenes.hpp"

namespace dovetail::dem {
namespace {

using Laws = std::shared_ptr<const ContactLaws>;

ContactWork step(Particles& particles, PairList& list, const Laws& law, double dt) {
  kick(particles, 0.5 * dt);
  drift(particles, dt);
  updatePairs(particles, list);
  clearForces(particles);
  const ContactWork work = law->pairs(particles, list, dt, Booking::on);
  kick(particles, 0.5 * dt);
  return work;
}

Particles cloud(int n, double size, unsigned seed) {
  Random random(seed);
  Particles particles;
  for (int i = 0; i < n; ++i)
    addParticle(particles, random.vector(size), random.vector(1.0), random(0.03, 0.1), Density{1000.0});
  return particles;
}

TEST(Pairs, TheListHoldsAllPairsThatTouchWhileParticlesMove) {
  Particles particles = cloud(400, 0.5, 1);
  PairList list;
  list.setSkin(0.02);
  findPairs(particles, list);
  for (int i = 0; i < 60; ++i) {
    drift(particles, 2e-3);
    updatePairs(particles, list);
    if (i % 7 != 0) continue;
    for (int a = 0; a < 400; ++a)
      for (int b = a + 1; b < 400; ++b)
        if (pairContact(particles, static_cast<std::size_t>(a), static_cast<std::size_t>(b)).overlap > 0.0) {
          ASSERT_TRUE(list.find({a, b}));
        }
  }
  EXPECT_GT(list.builds(), 2);
  EXPECT_LT(list.builds(), 40);
}

TEST(Pairs, ForcesAreTheGradientOfTheEnergyAndBalance) {
  Particles particles = cloud(200, 0.25, 2);
  PairList list;
  list.setSkin(0.02);
  findPairs(particles, list);
  const auto law = makeContactLaws(ElasticLaw{{1e4}});
  const auto energy = [&] {
    clearForces(particles);
    return law->pairs(particles, list, 0.0, Booking::on).storedEnergy();
  };
  energy();
  const std::vector<Vec3> force = particles.f;
  Vec3 total;
  double size = 0.0, work = 0.0;
  Random random(3);
  std::vector<Vec3> direction;
  for (const Vec3& f : force) {
    total += f;
    size += norm(f);
    direction.push_back(random.vector(1.0));
    work += dot(f, direction.back());
  }
  EXPECT_GT(size, 0.0);
  EXPECT_LE(norm(total), 1e-14 * size);
  const double h = 1e-7;
  const auto moved = [&](double by) {
    for (std::size_t i = 0; i < force.size(); ++i) particles.x[i] += by * direction[i];
    return energy();
  };
  const double up = moved(h), down = moved(-2.0 * h);
  EXPECT_NEAR((up - down) / (2.0 * h), -work, 1e-6 * size);
}

TEST(Pairs, ACollisionConservesEnergyToSecondOrderAndMomentumExactly) {
  const auto error = [](double dt) {
    Particles particles;
    addParticle(particles, {0, 0, 0}, {0.3, 0, 0}, 0.1, Mass{1.0});
    addParticle(particles, {0.2001, 0.03, 0.01}, {-0.2, 0.1, 0}, 0.11, Mass{2.0});
    const double start = kineticEnergy(particles);
    const Vec3 momentumAtStart = momentum(particles), angularAtStart = angularMomentum(particles);
    PairList list;
    list.setSkin(0.01);
    findPairs(particles, list);
    const auto law = makeContactLaws(ElasticLaw{{1e4}});
    const double stored = law->pairs(particles, list, 0.0, Booking::on).storedEnergy();
    double worst = 0.0;
    for (double t = 0.0; t < 0.1; t += dt) {
      const double now = step(particles, list, law, dt).storedEnergy();
      worst = std::max(worst, std::abs(kineticEnergy(particles) + now - start - stored));
    }
    EXPECT_LE(norm(momentum(particles) - momentumAtStart), 1e-15);
    EXPECT_LE(norm(angularMomentum(particles) - angularAtStart), 1e-14);
    return worst / start;
  };
  const double coarse = error(2e-4), fine = error(1e-4);
  EXPECT_LE(coarse, 1e-3);
  EXPECT_NEAR(coarse / fine, 4.0, 0.8);
}

TEST(Pairs, TheReboundHasTheRestitutionAskedForWhateverTheMasses) {
  for (const double ratio : {1.0, 1e3, 1e6})
    for (const double e : {0.1, 0.5, 0.9, 1.0}) {
      Particles particles;
      addParticle(particles, {0, 0, 0}, {0.3, 0, 0}, 0.1, Mass{1.0});
      addParticle(particles, {0.2001, 0, 0}, {-0.2, 0, 0}, 0.1, Mass{ratio});
      const ElasticLaw spring{{1e4, e}};
      const auto law = makeContactLaws(spring);
      const double reduced = ratio / (1.0 + ratio), dt = spring.normal.contactTime(reduced) / 2000;
      PairList list;
      list.setSkin(0.05);
      findPairs(particles, list);
      for (int i = 0; i < 4000; ++i) step(particles, list, law, dt);
      EXPECT_NEAR((particles.v[1].x - particles.v[0].x) / 0.5, e, 1e-3);
    }
}

TEST(Pairs, CoincidentCentresHaveADefinedForce) {
  Particles particles;
  addParticle(particles, {1, 1, 1}, {}, 0.1, Mass{1.0});
  addParticle(particles, {1, 1, 1}, {}, 0.2, Mass{1.0});
  PairList list;
  list.setSkin(0.0);
  findPairs(particles, list);
  makeContactLaws(ElasticLaw{{100.0}})->pairs(particles, list, 0.0, Booking::on);
  EXPECT_EQ(particles.f[0], (Vec3{100.0 * (0.1 + 0.2), 0, 0}));
  EXPECT_EQ(particles.f[1], -particles.f[0]);
}

TEST(Pairs, NobodyAndOneParticle) {
  for (const int n : {0, 1}) {
    Particles particles = cloud(n, 1.0, 4);
    PairList list;
    list.setSkin(0.1);
    findPairs(particles, list);
    EXPECT_FALSE(updatePairs(particles, list));
    const auto law = makeContactLaws(FrictionalLaw{{1.0}, {1.0, 1.0}});
    EXPECT_EQ(law->pairs(particles, list, 1.0, Booking::on).storedEnergy(), 0.0);
  }
  PairList list;
  EXPECT_THROW(list.setSkin(-1.0), InputError);
  Particles lost = cloud(3, 1.0, 4);
  list.setSkin(0.1);
  findPairs(lost, list);
  lost.x[2].y = NAN;
  EXPECT_THROW(updatePairs(lost, list), NumericalError);
}

Particles run(int threadCount, const Laws& law) {
  setThreads(threadCount);
  Particles particles = cloud(1500, 0.6, 5);
  switchOnRotation(particles);
  const auto wall = [] {
    auto ground = squares(20, 20, 0.06);
    for (Vec3& x : ground.x) x += Vec3{-0.6, -0.6, -0.3 + 0.2 * std::sin(40.0 * x.x * x.y)};
    return ground;
  }();
  PairList list;
  list.setSkin(0.01);
  findPairs(particles, list);
  WallCandidates candidates;
  candidates.skin = 0.02;
  WallContacts contacts;
  for (int i = 0; i < 10; ++i) {
    const double dt = 1e-4;
    kick(particles, 0.5 * dt);
    drift(particles, dt);
    updatePairs(particles, list);
    updateWallCandidates(particles, wall, candidates, movesOf(particles, dt));
    clearForces(particles);
    law->pairs(particles, list, dt, Booking::on);
    findWallContacts(particles, wall, candidates, EdgeRule::projected, contacts);
    law->wall(particles, wall, contacts, dt, Booking::on);
    kick(particles, 0.5 * dt);
  }
  EXPECT_GT(contacts.size(), 150u);
  setThreads(1);
  return particles;
}

TEST(Pairs, ARunIsBitwiseTheSameForAnyNumberOfThreads) {
  const auto law = makeContactLaws(FrictionalLaw{{1e3, 0.7}, {5e2, 0.4}});
  const Particles one = run(1, law);
  for (const int n : {2, 3}) {
    const Particles many = run(n, law);
    EXPECT_TRUE(one.x == many.x);
    EXPECT_TRUE(one.v == many.v);
    EXPECT_TRUE(one.omega == many.omega);
    EXPECT_TRUE(one.f == many.f);
  }
}

TEST(Pairs, FrictionBalancesMomentsAndEnergy) {
  Particles particles;
  addParticle(particles, {0, 0, 0}, {0.3, 0.1, 0}, 0.1, Mass{1.0});
  addParticle(particles, {0.206, 0.05, 0.01}, {-0.2, -0.3, 0.1}, 0.11, Mass{2.0});
  switchOnRotation(particles);
  particles.omega[0] = {1, -2, 3};
  const double start = kineticEnergy(particles), dt = 1e-5;
  const Vec3 angular = angularMomentum(particles);
  PairList list;
  list.setSkin(0.0);
  findPairs(particles, list);  // rebuilt every step: springs must survive that
  const auto law = makeContactLaws(FrictionalLaw{{1e4, 0.8}, {7e3, 0.2}});
  double lost = 0.0, stored = 0.0;
  for (int i = 0; i < 8000; ++i) {
    const ContactWork work = step(particles, list, law, dt);
    lost += work.lostPower() * dt;
    stored = work.storedEnergy();
  }
  EXPECT_LE(norm(angularMomentum(particles) - angular), 1e-4 * norm(angular));
  EXPECT_LT(kineticEnergy(particles), 0.95 * start);
  EXPECT_NEAR(kineticEnergy(particles) + stored + lost, start, 1e-3 * start);
}

}  // namespace
}  // namespace dovetail::dem
