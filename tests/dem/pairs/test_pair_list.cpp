// What the list of pairs keeps through list updates: periods, memories, factors; and that it finds them all.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/laws/contact_laws.hpp"
#include "dovetail/dem/pairs/pairs.hpp"
#include "walls/wall_scenes.hpp"

namespace dovetail::dem {
namespace {

using Pair = std::array<int, 2>;
const auto springs = makeContactLaws(ElasticLaw{{1e3}});
const auto friction = makeContactLaws(FrictionalLaw{{1e3, 0.8}, {5e2, 0.4}});
const geometry::Periodicity unitBox{{{0, 0, 0}, {1, 1, 1}}, {true, true, true}};

/// Two spheres that meet across the border x = 0 of the unit box.
Particles acrossTheBorder() {
  Particles particles;
  addParticle(particles, {0.05, 0.5, 0.5}, {}, 0.1, Mass{1.0});
  addParticle(particles, {0.86, 0.5, 0.5}, {}, 0.1, Mass{2.0});
  return particles;
}

Particles dense(int n, double size, unsigned seed) {
  Random random(seed);
  Particles particles;
  for (int i = 0; i < n; ++i)
    addParticle(particles, 0.5 * (random.vector(size) + Vec3{size, size, size}), random.vector(1.0),
                random(0.018, 0.024), Density{1000.0});
  switchOnRotation(particles);
  return particles;
}

TEST(PairList, ContactsSurviveThatPositionsAreWrapped) {
  Particles particles = acrossTheBorder();
  PairList list;
  list.setPeriodicity(unitBox);
  list.setSkin(0.05);
  findPairs(particles, list);
  friction->pairs(particles, list, 1e-3, Booking::on);
  const double force = particles.f[0].x;
  EXPECT_NEAR(force, 1e3 * (0.2 - 0.19), 1e-9);
  std::ranges::copy(std::array{1e-4, 2e-4, 3e-4}, list.prepareMemory(3, 0, FrictionalLaw::memoryKind).begin());
  list.writeFactors()[0] = 0.5;
  particles.x[0].x += 3.0;
  particles.x[1].x -= 1.0;
  wrapPositions(particles, list.periodicity());
  EXPECT_TRUE(updatePairs(particles, list, 0.0));
  ASSERT_EQ(list.pairs(), (Pairs{{0, 1}}));
  EXPECT_EQ(list.memory(), (RawVector<double>{1e-4, 2e-4, 3e-4}));
  EXPECT_EQ(list.factors(), (RawVector<double>{0.5}));
  list.clearFactors();
  clearForces(particles);
  springs->pairs(particles, list, 0.0, Booking::on);
  EXPECT_NEAR(particles.f[0].x, force, 1e-9);
  EXPECT_FALSE(updatePairs(particles, list, 0.0));
}

TEST(PairList, RenewalsKeepParticlesInThePeriodicBox) {
  Particles particles = acrossTheBorder();
  for (Vec3& v : particles.v) v = {7.0, -3.0, 0.5};
  PairList list;
  list.setPeriodicity(unitBox);
  double farthest = 0.0;
  for (int i = 0; i < 1000; ++i) {
    drift(particles, 1e-3);
    updatePairs(particles, list, 1e-3 * norm(particles.v[0]));
    for (const Vec3& x : particles.x)
      for (int k = 0; k < 3; ++k) farthest = std::max({farthest, -x[k], x[k] - 1.0});
    ASSERT_EQ(list.size(), 1u);
    const Vec3 d = particles.x[0] - particles.x[1] + list.shift(0);
    ASSERT_NEAR(norm(d), 0.19, 1e-9);
  }
  EXPECT_LT(farthest, 0.5 * *list.skin() + 0.01);
}

TEST(PairList, FactorsStayWithTheirPairs) {
  Particles particles = dense(4000, 0.6, 7);
  PairList list;
  list.setSkin(0.01);
  findPairs(particles, list);
  ASSERT_GT(list.candidates().size(), list.size());  // pruned
  std::vector<Pair> muted;
  const std::span<double> factors = list.writeFactors();
  for (std::size_t p = 0; p < list.size(); p += 7) {
    factors[p] = 0.25;
    muted.push_back(list.pairs()[p]);
  }
  const auto factorOf = [&](const Pair& pair) {
    const auto place = list.find(pair);
    return place ? list.factor(*place) : -1.0;
  };
  std::int64_t prunings = 0, searches = 0;
  for (int i = 0; i < 12; ++i) {
    const std::int64_t builds = list.builds();
    drift(particles, 1e-3);
    if (!updatePairs(particles, list, 2e-3)) continue;
    (list.builds() == builds ? prunings : searches) += 1;
    std::size_t kept = 0;
    for (const Pair& pair : muted) kept += factorOf(pair) == 0.25 ? 1 : 0;
    ASSERT_EQ(static_cast<std::size_t>(std::count(list.factors().begin(), list.factors().end(), 0.25)), kept);
    ASSERT_GT(kept, muted.size() / 4);
    std::erase_if(muted, [&](const Pair& pair) { return factorOf(pair) != 0.25; });  // those that left start anew
  }
  EXPECT_GT(prunings, 0);
  EXPECT_GT(searches, 0);
  std::vector<int> reversed(particles.size());
  for (std::size_t i = 0; i < reversed.size(); ++i) reversed[i] = static_cast<int>(reversed.size() - 1 - i);
  renumber(list, reversed, particles);
  renumber(particles, reversed);
  const int last = static_cast<int>(particles.size()) - 1;
  for (const Pair& pair : muted) EXPECT_EQ(factorOf({last - pair[1], last - pair[0]}), 0.25);
}

TEST(PairList, ThinnerInnerSkinsWhereTheCandidatesLastLonger) {
  Particles particles = dense(3000, 0.6, 7);
  for (Vec3& v : particles.v) v = {1.0, 0.0, 0.0};
  for (const int life : {10, 40, 160}) {
    PairList list;
    list.setSkin(0.02);
    findPairs(particles, list);
    const double dt = 0.5 * 0.02 / life;
    const auto step = [&](int count) {
      for (int i = 0; i < count; ++i) {
        drift(particles, dt);
        updatePairs(particles, list, dt);
      }
    };
    step(3 * life);
    const std::int64_t builds = list.builds(), revision = list.revision();
    step(8 * life);
    const double prunings =
        static_cast<double>(list.revision() - revision) / static_cast<double>(list.builds() - builds);
    EXPECT_NEAR(prunings, std::sqrt(0.7 * life), 0.15 * std::sqrt(0.7 * life) + 0.5) << life;
  }
}

TEST(PairList, WhatLeaversHoldIsBookedWithTheirMaterials) {
  LawTable<FrictionalLaw> table(2, {{1e3}, {5e2, 0.4}});
  table.set(1, 1, {{4e3}, {3e3, 0.4}});
  const auto laws = makeContactLaws(table);
  Particles particles;
  for (int i = 0; i < 3; ++i) addParticle(particles, {0.18 * i, 0, 0}, {}, 0.1, Mass{1.0});
  particles.material = {0, 1, 1};
  PairList list;
  list.setSkin(0.01);
  findPairs(particles, list);
  const double dt = 1e-4;
  laws->pairs(particles, list, dt, Booking::on);
  const std::span<double> memory = list.prepareMemory(3, 0, FrictionalLaw::memoryKind);
  std::ranges::fill(memory, 0.0);
  memory[3] = 1e-3;  // y of the second pair
  clearForces(particles);
  const ContactWork before = laws->pairs(particles, list, dt, Booking::on);
  const std::vector<int> number = numbersWithout(particles, std::vector<int>{2});
  renumber(list, number, particles);
  renumber(particles, number);
  updatePairs(particles, list, 0.0);
  clearForces(particles);
  const ContactWork after = laws->pairs(particles, list, dt, Booking::on);
  EXPECT_NEAR(after.fracturePower * dt, 0.5 * 4e3 * 0.02 * 0.02, 1e-12);
  EXPECT_NEAR(after.frictionPower * dt, 0.5 * 3e3 * 1e-6, 1e-12);
  EXPECT_NEAR(after.storedEnergy() + after.lostPower() * dt, before.storedEnergy(), 1e-12);
}

TEST(PairList, ASkinThatNobodySetIsAShareOfTheMeanDiameter) {
  Particles particles = dense(500, 0.2, 3);
  PairList list;
  findPairs(particles, list);
  const double mean = 2.0 * std::accumulate(particles.radius.begin(), particles.radius.end(), 0.0) / 500.0;
  EXPECT_NEAR(*list.skin(), PairList::defaultSkin * mean, 1e-15);
  EXPECT_FALSE(updatePairs(particles, list, 0.0));
  PairList every;
  every.setSkin(0.0);
  findPairs(particles, every);
  particles.x[3].y += 1e-6;
  EXPECT_TRUE(updatePairs(particles, every, 1e-6));
  EXPECT_EQ(*every.skin(), 0.0);
}

struct State {
  Particles particles;
  PairList list;
};

/// Searches, prunings, sortings, removals and arrivals, with friction.
State run(int threadCount) {
  setThreads(threadCount);
  State r{dense(5000, 0.7, 11), {}};
  r.list.setPeriodicity({{{0, 0, 0}, {0.7, 1, 1}}, {true, false, false}});
  for (int i = 0; i < 24; ++i) {
    kick(r.particles, 5e-5);
    drift(r.particles, 1e-4);
    updatePairs(r.particles, r.list, 3e-4);
    if (i == 9 || i == 20) sortParticles(r.particles, r.list);
    if (i == 15) {
      const std::vector<int> number = numbersWithout(r.particles, std::vector<int>{5, 4000, 300});
      renumber(r.list, number, r.particles);
      renumber(r.particles, number);
      for (int k = 0; k < 3; ++k) addParticle(r.particles, {0.1 + 0.1 * k, 0.75, 0.5}, {}, 0.02, Density{1000.0});
      updatePairs(r.particles, r.list, 0.0);
    }
    clearForces(r.particles);
    friction->pairs(r.particles, r.list, 1e-4, Booking::on);
    kick(r.particles, 5e-5);
  }
  setThreads(1);
  return r;
}

TEST(PairList, IsBitwiseTheSameForAnyNumberOfThreads) {
  const State one = run(1);
  EXPECT_GT(one.list.size(), PairList::pruneFrom);
  EXPECT_GT(one.list.images().size(), 50u);
  for (const int n : {2, 3}) {
    const State many = run(n);
    EXPECT_TRUE(one.particles.x == many.particles.x);
    EXPECT_TRUE(one.particles.id == many.particles.id);
    EXPECT_TRUE(one.particles.omega == many.particles.omega);
    EXPECT_TRUE(one.list.pairs() == many.list.pairs());
    EXPECT_TRUE(one.list.memory() == many.list.memory());
  }
}

TEST(PairList, SortingKeepsForcesAndMakesChunksCompact) {
  Particles particles;
  for (const Vec3& x : [] {
         std::vector<Vec3> points;
         for (int k = 0; k < 32; ++k)
           for (int j = 0; j < 32; ++j)
             for (int i = 0; i < 32; ++i) points.push_back({0.99 * i, 0.99 * j, 0.99 * k});
         return points;
       }())
    addParticle(particles, x, {}, 0.5, Mass{1.0});
  PairList list;
  list.setSkin(0.1);
  findPairs(particles, list);
  springs->pairs(particles, list, 0.0, Booking::on);
  const std::vector<Vec3> force = particles.f;
  sortParticles(particles, list);
  clearForces(particles);
  springs->pairs(particles, list, 0.0, Booking::on);
  for (std::size_t i = 0; i < particles.size(); ++i)
    ASSERT_LE(norm(particles.f[i] - force[static_cast<std::size_t>(particles.id[i])]), 1e-11);
  // Cubes of as many particles would share with others one pair in the number of particles along their edge.
  const double fraction = static_cast<double>(list.chunks().crosses.back()) / static_cast<double>(list.size());
  EXPECT_LT(fraction, 1.5 / std::cbrt(static_cast<double>(list.chunks().size)));
}

}  // namespace
}  // namespace dovetail::dem
