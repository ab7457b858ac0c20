// Bonded pairs, and pairs that count by a fraction.
#include <gtest/gtest.h>

#include "dovetail/dem/pairs/pairs.hpp"
#include "walls/wall_scenes.hpp"

namespace dovetail::dem {
namespace {

struct Two {
  Particles particles;
  PairList list;
};

Two apart(double distance) {
  Two two;
  addParticle(two.particles, {0, 0, 0}, {}, 0.5, Mass{2.0});
  addParticle(two.particles, {1.0, 0, 0}, {}, 0.5, Mass{3.0});
  two.list.setSkin(0.1);
  findPairs(two.particles, two.list);
  two.particles.x[1].x = distance;
  clearForces(two.particles);
  return two;
}

ElasticLaw lawOf(bool bonded, double restitution = 1.0) {
  ElasticLaw law;
  law.normal = {100.0, restitution, true, bonded};
  return law;
}

TEST(Bonds, PullAsTheyPush) {
  for (const double stretch : {-0.05, 0.05}) {
    Two two = apart(1.0 + stretch);
    const ContactWork work = sweepPairs(lawOf(true), two.particles, two.list);
    EXPECT_NEAR(two.particles.f[1].x, -100.0 * stretch, 1e-12);
    EXPECT_NEAR(two.particles.f[0].x, 100.0 * stretch, 1e-12);
    EXPECT_NEAR(work.elasticEnergy, 50.0 * stretch * stretch, 1e-14);
  }
}

TEST(Bonds, WithoutThemPartedParticlesFeelNothing) {
  Two two = apart(1.05);
  EXPECT_EQ(sweepPairs(lawOf(false), two.particles, two.list).elasticEnergy, 0.0);
  EXPECT_EQ(two.particles.f[0].x, 0.0);
}

TEST(PairScale, ScalesForceEnergyAndLoss) {
  Two whole = apart(0.95), part = apart(0.95);
  for (Two* two : {&whole, &part}) two->particles.v[1].x = -0.3;
  part.list.writeFactors()[0] = 0.25;
  for (double& m : part.particles.mass) m *= 0.25;  // the fraction of an overlap is that of the masses too
  const ContactWork a = sweepPairs(lawOf(false, 0.7), whole.particles, whole.list),
                    b = sweepPairs(lawOf(false, 0.7), part.particles, part.list);
  EXPECT_NEAR(part.particles.f[0].x, 0.25 * whole.particles.f[0].x, 1e-13);
  EXPECT_NEAR(b.elasticEnergy, 0.25 * a.elasticEnergy, 1e-15);
  EXPECT_NEAR(b.dissipatedPower, 0.25 * a.dissipatedPower, 1e-13);
}

}  // namespace
}  // namespace dovetail::dem
