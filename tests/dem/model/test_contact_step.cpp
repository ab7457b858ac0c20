// The stable step with the contacts as they are, and mass scaling.
#include <gtest/gtest.h>

#include <limits>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/laws/own_laws.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "impact_scenes.hpp"

namespace dovetail::dem {
namespace {

/// Whether motions much smaller than the overlaps grow, the forces at the start being taken off. Squeezed particles
/// buckle, which no step can prevent; so overlaps are tiny, or (of two particles) the first is pushed along the x axis
/// alone.
template <class Law>
bool grows(Particles particles, double skin, const Law& law, double dt, int steps, bool alongX = false) {
  PairList list;
  list.setSkin(skin);
  findPairs(particles, list);
  const auto laws = makeContactLaws(law);
  Particles rest = particles;
  clearForces(rest);
  laws->pairs(rest, list, dt, Booking::on);
  Random random(3);
  const double small = 1e-12 * particles.radius[0];
  for (Vec3& v : particles.v) v = random.vector(small / dt);
  if (alongX) particles.v = {{small / dt, 0, 0}, {}};
  const double start = kineticEnergy(particles);
  for (int s = 0; s < steps; ++s) {
    kick(particles, 0.5 * dt);
    drift(particles, dt);
    clearForces(particles);
    laws->pairs(particles, list, dt, Booking::on);
    for (std::size_t i = 0; i < particles.size(); ++i) particles.f[i] -= rest.f[i];
    kick(particles, 0.5 * dt);
    if (!(kineticEnergy(particles) < 1e4 * start)) return true;
  }
  return false;
}

Particles squeezed(double massRatio) {
  Particles particles;
  addParticle(particles, {}, {}, 0.1, Mass{0.3});
  addParticle(particles, {0.19, 0, 0}, {}, 0.1, Mass{0.3 * massRatio});
  return particles;
}

TEST(ContactStep, IsExactForOneElasticPairOfAnyMassesAndSafeForADampedOne) {
  for (const double ratio : {1.0, 10.0, 1e6})
    for (const double e : {1.0, 0.3}) {
      Particles particles = squeezed(ratio);
      PairList list;
      list.setSkin(0.01);
      findPairs(particles, list);
      const ElasticLaw linear{{1e5, e}};
      const HertzLaw hertz{{1e7, e}};
      const ContactStep a = criticalStep(particles, list, *makeContactLaws(linear)),
                        b = criticalStep(particles, list, *makeContactLaws(hertz));
      EXPECT_NEAR(a.dt, a.twoBody, 1e-14 * a.dt);
      EXPECT_EQ(a.particle, 0);
      EXPECT_EQ(a.partner, 1);
      EXPECT_FALSE(grows(particles, 0.01, linear, 0.99 * a.dt, 4000, true));
      EXPECT_FALSE(grows(particles, 0.01, hertz, 0.99 * b.dt, 4000, true));
      const double beyond = e < 1.0 ? 1.8 : 1.01;
      EXPECT_TRUE(grows(particles, 0.01, linear, beyond * a.dt, 4000, true));
      EXPECT_TRUE(grows(particles, 0.01, hertz, beyond * b.dt, 4000, true));
    }
}

TEST(ContactStep, AgreesWithTheClosedFormOfTheLightestParticle) {
  Particles particles = squeezed(1.0);
  PairList list;
  list.setSkin(0.01);
  findPairs(particles, list);
  const double mass = 0.15, omega = std::sqrt(1e5 / mass);
  EXPECT_NEAR(criticalStep(particles, list, *makeContactLaws(ElasticLaw{{1e5}})).dt, 2.0 / omega, 1e-14);
}

/// Equal spheres of unequal masses in the densest packing, barely touching.
Particles packing(bool spins) {
  Random random(4);
  Particles particles;
  const double radius = 0.1, edge = std::sqrt(2.0) * radius * (1.0 - 1e-8);  // half of the cubic cell's
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      for (int k = 0; k < 6; ++k)
        if ((i + j + k) % 2 == 0)
          addParticle(particles, edge * Vec3{1.0 * i, 1.0 * j, 1.0 * k}, {}, radius, Mass{random(0.2, 1.0)});
  if (spins) switchOnRotation(particles);
  return particles;
}

TEST(ContactStep, IsSafeInAPackingAndNamesAPairOfIt) {
  for (const bool spins : {false, true}) {
    Particles particles = packing(spins);
    PairList list;
    list.setSkin(0.0);
    findPairs(particles, list);
    const FrictionalLaw law{{1e5, 0.9}, {8e4, 1e9}};
    const ContactStep step = criticalStep(particles, list, *makeContactLaws(law));
    EXPECT_TRUE(list.find({step.particle, step.partner}));
    EXPECT_LT(step.dt, step.twoBody);
    EXPECT_FALSE(grows(particles, 0.0, law, 0.99 * step.dt, 2000));
    EXPECT_TRUE(grows(particles, 0.0, law, 2.5 * step.dt, 2000));  // not over-cautious
  }
}

TEST(ContactStep, SeesRollingPlasticAndRememberedStiffness) {
  Particles particles = [] {
    Particles two = squeezed(1.0);
    switchOnRotation(two);
    return two;
  }();
  PairList list;
  list.setSkin(0.01);
  findPairs(particles, list);
  const double mass = 0.3, radius = 0.1;
  const ContactLaw<ElasticPlastic> plastic{{1e5, 4e5}};
  EXPECT_NEAR(criticalStep(particles, list, *makeContactLaws(plastic)).dt, 2.0 / std::sqrt(2.0 * 4e5 / mass), 1e-12);
  const ContactLaw<LinearSpringDashpot, NoTangential, RollingResistance> rolling{{1e5}, {}, {0.1, 30.0}, {}};
  const double turning = 30.0 * 1e5 * 0.05 * 0.05 / (0.4 * mass * radius * radius);
  EXPECT_NEAR(criticalStep(particles, list, *makeContactLaws(rolling)).dt, 2.0 / std::sqrt(2.0 * turning), 1e-12);
}

TEST(ContactStep, WallsCountAndSoDoContactsYetToCome) {
  Particles particles = aboveWall(0.1, 1000.0, {});
  particles.x[0].z = 0.099;
  const TriangulatedWall wall = squares(2, 2, 1.0);
  particles.x[0].x = particles.x[0].y = 0.7;
  WallCandidates candidates;
  findWallCandidates(particles, wall, 0.01, candidates);
  WallContacts contacts;
  findWallContacts(particles, wall, candidates, EdgeRule::projected, contacts);
  ASSERT_EQ(contacts.size(), 1u);
  ContactDemand demand;
  makeContactLaws(ElasticLaw{{1e5}})->addDemand(demand, particles, wall, contacts);
  const ContactStep step = criticalStep(demand, particles);
  EXPECT_NEAR(step.dt, 2.0 / std::sqrt(1e5 / particles.mass[0]), 1e-14);
  EXPECT_EQ(step.partner, -1);

  Particles apart = squeezed(1.0);
  apart.x[1].x = 0.201;
  PairList list;
  list.setSkin(0.01);
  findPairs(apart, list);
  const auto hertz = makeContactLaws(HertzLaw{{1e7}});
  EXPECT_EQ(criticalStep(apart, list, *hertz).dt, std::numeric_limits<double>::infinity());
  EXPECT_EQ(criticalStep(apart, list, *hertz).particle, -1);
  EXPECT_NEAR(criticalStep(apart, list, *hertz, 0.01).dt, 2.0 / std::sqrt(2e7 * std::sqrt(0.05 * 0.01) / 0.15), 1e-12);
}

TEST(ContactStep, OfASceneCountsPairsAndAllItsWalls) {
  Model model;
  model.laws = makeContactLaws(ElasticLaw{{1e5}});
  addParticle(model.particles, {0, 0, 0.099}, {}, 0.1, Mass{0.5});
  addParticle(model.particles, {0.199, 0, 0.101}, {}, 0.1, Mass{0.3});
  model.pairs.setSkin(0.02);
  addWall(model, makePlane({0, 0, 0}, {0, 0, 1}));
  addWall(model, makePlane({-0.0995, 0, 0}, {1, 0, 0}));
  run(model, 1e-7, 1);
  const ContactStep step = criticalStep(model);  // three contacts on the first sphere, one on the second
  EXPECT_NEAR(step.dt, 2.0 / std::sqrt(3.0 * 1e5 / 0.5 + 1e5 / 0.3), 1e-13);
  EXPECT_EQ(step.particle, 0);
  EXPECT_EQ(step.partner, 1);
  EXPECT_NEAR(step.twoBody, 2.0 / std::sqrt(1e5 / 0.5 + 1e5 / 0.3), 1e-13);
}

TEST(ContactStep, UsesTheLawOfTheMaterialsAndRefusesThoseWithoutOne) {
  Particles particles = squeezed(1.0);
  particles.material = {0, 1};
  PairList list;
  list.setSkin(0.01);
  findPairs(particles, list);
  LawTable<ElasticLaw> table(2, ElasticLaw{{1e5}});
  table.set(0, 1, ElasticLaw{{4e5}});
  EXPECT_NEAR(criticalStep(particles, list, *makeContactLaws(table)).dt, 2.0 / std::sqrt(4e5 / 0.15), 1e-14);
  particles.material = {0, 2};
  EXPECT_THROW(criticalStep(particles, list, *makeContactLaws(table)), InputError);
}

TEST(MassScaling, MakesTheStepStableAndSaysWhatItDid) {
  for (const double e : {1.0, 0.5}) {
    Particles particles = packing(true);
    PairList list;
    list.setSkin(0.0);
    findPairs(particles, list);
    const FrictionalLaw law{{1e5, e}, {8e4, 1e9}};
    const auto laws = makeContactLaws(law);
    const double wanted = 2.0 * criticalStep(particles, list, *laws).dt;
    double before = 0.0, after = 0.0, added = 0.0;
    for (const double m : particles.mass) before += m;
    std::size_t count = 1;
    for (int round = 0; round < 50 && count > 0; ++round) {
      ContactDemand demand;
      laws->addDemand(demand, particles, list, 0.0);
      const MassScaling report = scaleMasses(particles, demand, wanted);
      count = report.count;
      added += report.addedMass;
      if (round == 0) {
        EXPECT_GT(count, 0u);
        EXPECT_NEAR(report.massBefore, before, 1e-12 * before);
        EXPECT_GT(report.largestFactor, 1.0);
      }
      if (e == 1.0) break;
    }
    for (const double m : particles.mass) after += m;
    EXPECT_NEAR(after - before, added, 1e-12 * after);
    EXPECT_GE(criticalStep(particles, list, *laws).dt, wanted * (1.0 - 1e-6));
    EXPECT_FALSE(grows(particles, 0.0, law, 0.99 * wanted, 2000));
  }
  Particles particles = packing(false);
  EXPECT_EQ(scaleMasses(particles, {}, 1.0).count, 0u);
  EXPECT_THROW(scaleMasses(particles, {}, 0.0), InputError);
}

TEST(ContactStep, AtAWallAWeightedParticleAsksForNoShorterStep) {
  const auto step = [](double weight) {
    Model m;
    addParticle(m.particles, {0, 0, 0.099}, {}, 0.1, Mass{1.0});
    m.particles.weight = {weight};
    ElasticLaw law;
    law.normal.stiffness = 1e4;
    m.laws = makeContactLaws(law);
    addWall(m, makePlane({}, {0, 0, 1}));
    findForces(m);
    return criticalStep(m).dt;
  };
  EXPECT_NEAR(step(1e-3), step(1.0), 1e-12 * step(1.0));
}

}  // namespace
}  // namespace dovetail::dem
