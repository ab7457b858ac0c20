// Laws behind one call: the same digits as the templates they stand on, names, parameters, laws of one's own.
#include <gtest/gtest.h>

#include "dovetail/dem/laws/own_laws.hpp"
#include "dovetail/dem/pairs/contact_sample.hpp"
#include "dovetail/dem/walls/primitive_wall.hpp"
#include "own_law.hpp"
#include "walls/wall_scenes.hpp"

namespace dovetail::dem {
namespace {

/// Two spheres that rub against each other, one of them on the floor.
Particles rubbing() {
  Particles particles;
  addParticle(particles, {0, 0, 0.95}, {0.1, 0.2, -0.3}, 1.0, Mass{2.0});
  addParticle(particles, {0.3, 1.7, 1.1}, {-0.2, -0.4, 0.1}, 0.8, Mass{1.0});
  switchOnRotation(particles);
  particles.omega[0] = {0.5, -0.7, 0.2};
  particles.omega[1] = {-0.1, 0.3, 0.9};
  return particles;
}

struct Scene {
  Particles particles = rubbing();
  PairList list;
  PrimitiveWall plane = makePlane({}, {0, 0, 1});
  TriangulatedWall mesh = squares(2, 2, 8.0);
  WallCandidates candidates;
  WallContacts contacts;
  ContactWork work;

  Scene() {
    for (Vec3& x : mesh.x) x -= Vec3{8.0, 8.0, 0.0};
    list.setSkin(0.1);
    findPairs(particles, list);
    findContacts(particles, plane, {});
    updateWallCandidates(particles, mesh, candidates, {});
    findWallContacts(particles, mesh, candidates, EdgeRule::projected, contacts);
  }
};

constexpr double dt = 1e-3;

Scene withTemplates(const auto& law, int steps = 3) {
  const auto laws = prepare(law);
  Scene s;
  for (int i = 0; i < steps; ++i) {
    s.work = detail::collide(s.particles, s.list, laws, dt, Booking::on);
    s.work += detail::collide(s.particles, s.plane, laws, dt, Booking::on);
    s.work += detail::collide(s.particles, s.mesh, s.contacts, laws, dt, Booking::on);
  }
  return s;
}

Scene withCalls(const ContactLaws& laws, int steps = 3, Booking booking = Booking::on) {
  Scene s;
  for (int i = 0; i < steps; ++i) {
    s.work = laws.pairs(s.particles, s.list, dt, booking);
    s.work += laws.wall(s.particles, s.plane, dt, booking);
    s.work += laws.wall(s.particles, s.mesh, s.contacts, dt, booking);
  }
  return s;
}

void expectSameDigits(const Scene& a, const Scene& b) {
  EXPECT_EQ(a.particles.f, b.particles.f);
  EXPECT_EQ(a.particles.torque, b.particles.torque);
  EXPECT_EQ(a.work.storedEnergy(), b.work.storedEnergy());
  EXPECT_EQ(a.work.lostPower(), b.work.lostPower());
  EXPECT_EQ(a.plane.force, b.plane.force);
}

TEST(ContactLaws, OneCallPerSweepKeepsTheDigits) {
  const HertzMindlinLaw hertz{{1e5, 0.6}, {0.8, 0.4}};
  expectSameDigits(withTemplates(hertz), withCalls(*makeContactLaws(hertz)));
  const ContactLaw<ElasticPlastic, TangentialSpring, RollingAndTwisting, Cohesion> plastic{
      {1e4, 2e4}, {8e3, 0.5}, {{0.1, 0.2}, {0.1, 0.2}}, {1.0, 2.0, 3.0, 4.0}};
  expectSameDigits(withTemplates(plastic), withCalls(*makeContactLaws(plastic)));
}

TEST(ContactLaws, AListedLawStandsForOneWithFewerParts) {
  const ContactLaw<HertzDashpot, MindlinSpring, RollingResistance, DmtAdhesion> law{
      {1e5, 0.6}, {0.8, 0.4}, {0.1, 0.2, 0.3}, {0.7}};
  const auto laws = makeContactLaws(law);
  EXPECT_EQ(laws->name(), "Hertz + Mindlin + rolling + DMT");
  EXPECT_TRUE(laws->rotates());
  const Scene a = withTemplates(law), b = withCalls(*laws);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_LT(norm(a.particles.f[i] - b.particles.f[i]), 1e-14 * norm(a.particles.f[i]));
    EXPECT_LT(norm(a.particles.torque[i] - b.particles.torque[i]), 1e-14 * norm(a.particles.torque[i]));
  }
}

TEST(ContactLaws, ALawOfOnesOwnIsCompiledInAFileOfItsOwn) {
  const auto laws = makeOwnLaws({{1e5}, {0.8, 0.4}});
  EXPECT_EQ(laws->name(), "a part of one's own + Mindlin");
  EXPECT_EQ(laws->memory(), 4);
  const double overlap = 0.05;
  const Scene s = withCalls(*laws, 1);
  EXPECT_NEAR(s.plane.force.z, -1e5 * overlap * overlap * overlap, 1e-10);
}

TEST(ContactLaws, EqualLawsAreToldByPartsAndParameters) {
  const auto law = [](double friction) { return makeContactLaws(HertzMindlinLaw{{1e5, 0.6}, {0.8, friction}}); };
  EXPECT_TRUE(sameLaws(*law(0.4), *law(0.4)));
  EXPECT_FALSE(sameLaws(*law(0.4), *law(0.5)));
  const auto elastic = makeContactLaws(ElasticLaw{{1e5, 0.6}});
  EXPECT_FALSE(sameLaws(*law(0.4), *elastic));
  LawTable<ElasticLaw> table(2, {{1e5, 0.6}});
  EXPECT_EQ(makeContactLaws(table)->materials(), 2);
  EXPECT_FALSE(sameLaws(*makeContactLaws(table), *elastic));
}

TEST(ContactLaws, WithoutBookingWallsReportNothingAndForcesStay) {
  const auto laws = makeContactLaws(HertzMindlinLaw{{1e5, 0.6}, {0.8, 0.4}});
  const Scene booked = withCalls(*laws), quiet = withCalls(*laws, 3, Booking::off);
  EXPECT_EQ(booked.particles.f, quiet.particles.f);
  EXPECT_GT(booked.work.storedEnergy(), 0.0);
  EXPECT_EQ(quiet.work.storedEnergy(), 0.0);
  EXPECT_EQ(quiet.work.lostPower(), 0.0);
}

TEST(ContactLaws, RefusedInWords) {
  EXPECT_THROW(makeContactLaws(PreparedLaws<ElasticLaw>{}), InputError);
  EXPECT_THROW(makeContactLaws(ElasticLaw{{-1.0}}), InputError);
  LawTable<ElasticLaw> table(2, {{1e5, 0.6}});
  table.set(0, 1, {{1e5, 0.0}});
  try {
    makeContactLaws(table);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("materials 0 and 1"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace dovetail::dem
