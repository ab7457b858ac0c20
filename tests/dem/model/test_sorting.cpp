// Particles sorted at every list update: numbers change, physics does not.
#include <gtest/gtest.h>

#include "bonds/beam_scenes.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/bodies/body_term.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/dem/setup/streams.hpp"

namespace dovetail::dem {
namespace {

const FrictionalLaw frictional{{.stiffness = 2e4, .restitution = 0.7}, {.stiffness = 6e3, .friction = 0.4}};

ClumpShape rod() {
  return makeClumpShape(std::vector<Vec3>{{0, 0, 0}, {0.03, 0, 0}}, std::vector<double>{0.03, 0.03}, Density{1000.0});
}

/// Grains, rods and bonded grains that fall into a heap, through periods, in an order far from that of space.
Model heap(int sortEvery) {
  Model m;
  m.laws = makeContactLaws(frictional);
  m.gravity = {0, 0, -9.81};
  m.sortEvery = sortEvery;
  m.pairs.setSkin(0.004);
  m.pairs.setPeriodicity({{{0, 0, 0}, {0.9, 0.9, 1}}, {true, true, false}});
  Random random(9);
  std::vector<int> place(729);
  for (int i = 0; i < 729; ++i) place[static_cast<std::size_t>(i)] = (i * 400) % 729;
  for (const int i : place) {
    const Vec3 x{0.1 * (i % 9), 0.1 * (i / 9 % 9), 0.05 + 0.1 * (i / 81)}, v = random.vector(0.5);
    if (i % 9 == 4)
      addClump(m, rod(), x, fromRotationVector(random.vector(3.0)), v, random.vector(3.0));
    else
      addParticle(m.particles, x, v, random(0.04, 0.0499), Density{1000.0});
  }
  switchOnRotation(m.particles);
  addWall(m, makePlane({}, {0, 0, 1}));
  PairList near;
  near.setPeriodicity(m.pairs.periodicity());
  near.setSkin(0.004);
  findPairs(m.particles, near);
  for (std::size_t p = 0; p < near.size(); p += 5)
    addBond(bonds(m), m.particles, near.periodicity(), near.pairs()[p][0], near.pairs()[p][1], unbreakable(2e5));
  m.terms.all<BondTerm>()[0]->mutesContacts = true;
  return m;
}

constexpr double dt = 5e-5;

/// Largest distance of equal ids.
double apart(const Model& a, const Model& b) {
  double worst = 0.0;
  for (std::size_t i = 0; i < a.particles.size(); ++i) {
    const auto j = static_cast<std::size_t>(find(b.particles, a.particles.id[i]));
    worst = std::max(worst, norm(a.pairs.periodicity().minimumImage(a.particles.x[i] - b.particles.x[j])));
  }
  return worst;
}

TEST(Sorting, AtEveryListUpdateIsTheSamePhysicsToRoundOff) {
  Model never = heap(0), always = heap(1);
  std::int64_t sorted = 0;
  for (int s = 0; s < 300; ++s) {
    const std::int64_t listUpdates = always.listUpdates;
    const std::vector<std::int64_t> ids = always.particles.id;
    advance(never, dt);
    advance(always, dt);
    sorted += always.listUpdates > listUpdates && always.particles.id != ids;
  }
  close(never);
  close(always);
  EXPECT_GT(always.listUpdates, 3);
  EXPECT_GE(sorted, 2);
  EXPECT_FALSE(std::is_sorted(always.particles.id.begin(), always.particles.id.end()));
  EXPECT_LE(apart(never, always), 1e-10);
  const Energies a = energies(never), b = energies(always);
  EXPECT_NEAR(a.contacts, b.contacts, 1e-8 * a.contacts);
  EXPECT_NEAR(a.lost.lostPower(), b.lost.lostPower(), 1e-8 * a.lost.lostPower());
}

TEST(Sorting, AtEveryListUpdateIsTheSameForAnyThreads) {
  std::vector<Vec3> x, omega;
  std::vector<std::int64_t> id;
  for (const int count : {1, 2, 3}) {
    setThreads(count);
    Model m = heap(1);
    run(m, dt, 301);
    if (count == 1) {
      x = m.particles.x;
      omega = m.particles.omega;
      id = m.particles.id;
    }
    EXPECT_TRUE(m.particles.x == x && m.particles.omega == omega && m.particles.id == id) << count;
  }
  setThreads(1);
}

TEST(Sorting, KeepsPairsThatALawReachesBeyondTouch) {
  Model m;
  m.laws = makeContactLaws(
      ContactLaw<HertzDashpot, MindlinSpring, NoRolling, LiquidBridge>{{1e7, 0.8}, {0.8, 0.4}, {}, {0.072, 1e-9, 0.0}});
  m.pairs.setSkin(1e-5);
  m.sortEvery = 1;
  const double reach = m.laws->reach();
  for (int i = 0; i < 40; ++i) addParticle(m.particles, {(2e-3 + 0.9 * reach) * i, 0, 0}, {}, 1e-3, Density{2500.0});
  findForces(m);
  EXPECT_EQ(m.pairs.size(), 39u);
}

}  // namespace
}  // namespace dovetail::dem
