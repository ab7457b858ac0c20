// Sweeps over pairs leave out what a scene does not need, and choose their vector code, without changing a digit.
#include <gtest/gtest.h>

#include "../../core/every_vector_code.hpp"
#include "dovetail/dem/laws/hertz_mindlin.hpp"
#include "dovetail/dem/laws/rolling.hpp"
#include "dovetail/dem/pairs/pairs.hpp"
#include "walls/wall_scenes.hpp"

namespace dovetail::dem {
namespace {

using Laws = std::shared_ptr<const ContactLaws>;

constexpr double dt = 1e-4;

/// Overlapping spheres that move and spin.
Particles cloud(bool oneSize, unsigned seed) {
  Random random(seed);
  Particles particles;
  for (int i = 0; i < 400; ++i)
    addParticle(particles, random.vector(0.4), random.vector(1.0), oneSize ? 0.06 : random(0.03, 0.1), Density{1000.0});
  switchOnRotation(particles);
  for (Vec3& omega : particles.omega) omega = random.vector(10.0);
  return particles;
}

/// Forces, torques and energies of some steps.
std::vector<double> stepped(Particles particles, const Laws& laws) {
  PairList list;
  list.setSkin(0.02);
  std::vector<double> numbers;
  const auto add = [&](const std::vector<Vec3>& values) {
    for (const Vec3& value : values) numbers.insert(numbers.end(), {value.x, value.y, value.z});
  };
  for (int i = 0; i < 4; ++i) {
    updatePairs(particles, list);
    clearForces(particles);
    const ContactWork work = laws->pairs(particles, list, dt, Booking::on);
    numbers.insert(numbers.end(), {work.storedEnergy(), work.lostPower()});
    add(particles.f);
    add(particles.torque);
    kick(particles, dt);
    drift(particles, dt);
  }
  return numbers;
}

TEST(PairSweeps, GiveTheDigitsOfPortableCode) {
  ContactLaw<LinearSpringDashpot, TangentialSpring, RollingAndTwisting> rolling{{1e4, 0.7}, {8e3, 0.5, 0.3}};
  rolling.rolling = {{.friction = 0.1, .stiffnessRatio = 0.2}, {.friction = 0.1, .stiffnessRatio = 0.1}};
  for (const bool oneSize : {true, false})
    for (const Laws& laws : {makeContactLaws(ElasticLaw{{1e4}}), makeContactLaws(ElasticLaw{{1e4, 0.7}}),
                             makeContactLaws(FrictionalLaw{{1e4, 0.7}, {8e3, 0.5}}), makeContactLaws(rolling),
                             makeContactLaws(HertzMindlinLaw{{1e5, 0.6}, {0.8, 0.4}})})
      test::expectSameDigitsOfEveryVectorCode(laws->name(), [&] { return stepped(cloud(oneSize, 3), laws); });
}

/// Springs alone do not ask how fast particles move, dashpots do.
TEST(PairSweeps, LeaveOutVelocitiesThatNoDashpotSees) {
  const auto forces = [](const Laws& laws, double speed) {
    Particles particles = cloud(true, 5);
    for (Vec3& v : particles.v) v *= speed;
    PairList list;
    list.setSkin(0.02);
    findPairs(particles, list);
    const ContactWork work = laws->pairs(particles, list, dt, Booking::on);
    return std::pair{particles.f, work.lostPower()};
  };
  for (const Laws& springs : {makeContactLaws(ElasticLaw{{1e4}}), makeContactLaws(ContactLaw<HertzDashpot>{{1e5}})}) {
    EXPECT_EQ(forces(springs, 0.0).first, forces(springs, 3.0).first);
    EXPECT_EQ(forces(springs, 3.0).second, 0.0);
  }
  for (const Laws& dashpots :
       {makeContactLaws(ElasticLaw{{1e4, 0.7}}), makeContactLaws(ContactLaw<HertzDashpot>{{1e5, 0.7}})}) {
    EXPECT_NE(forces(dashpots, 0.0).first, forces(dashpots, 3.0).first);
    EXPECT_GT(forces(dashpots, 3.0).second, 0.0);
  }
}

/// Where only one of several materials occurs its law is taken; where others do, each pair has its own.
TEST(PairSweeps, TakeTheLawOfTheOnlyMaterialThatOccurs) {
  const FrictionalLaw law{{1e4, 0.7}, {8e3, 0.5}}, stiffer{{3e4, 0.7}, {8e3, 0.5}};
  LawTable<FrictionalLaw> table(3, stiffer);
  table.set(1, 1, law);
  Particles particles = cloud(false, 7);
  const std::vector<double> single = stepped(particles, makeContactLaws(law));
  particles.material.assign(particles.size(), 1);
  EXPECT_EQ(stepped(particles, makeContactLaws(table)), single);
  particles.material[200] = 2;
  EXPECT_NE(stepped(particles, makeContactLaws(table)), single);
  EXPECT_EQ(stepped(particles, makeContactLaws(LawTable<FrictionalLaw>(3, law))), single);
}

}  // namespace
}  // namespace dovetail::dem
