// Particles that come, go and change their numbers, and what refers to them.
#include <gtest/gtest.h>

#include <utility>

#include "dovetail/dem/model/walls.hpp"
#include "dovetail/dem/setup/insertion.hpp"
#include "walls/wall_scenes.hpp"

namespace dovetail::dem {
namespace {

const auto springs = makeContactLaws(ElasticLaw{{1e3}});

/// Spheres in a row along x, some of which overlap their neighbours.
Particles row(int n) {
  Particles particles;
  for (int i = 0; i < n; ++i) addParticle(particles, {0.19 * i, 0, 0.09}, {}, 0.1, Mass{1.0});
  return particles;
}

TEST(Renumbering, TheListIsMadeAnewWhenAsManyComeAsGo) {
  Particles particles = row(40);
  PairList list;
  list.setSkin(0.05);
  findPairs(particles, list);
  springs->pairs(particles, list, 0.0, Booking::on);
  const std::vector<int> number = numbersWithout(particles, std::vector<int>{0, 1, 2});
  renumber(list, number, particles);
  renumber(particles, number);
  const Vec3 above = particles.x[30] + Vec3{0, 0, 0.15};
  for (int i = 0; i < 3; ++i) addParticle(particles, above + Vec3{10.0 * i, 0, 0}, {}, 0.1, Mass{1.0});
  EXPECT_TRUE(updatePairs(particles, list, 0.0));
  clearForces(particles);
  springs->pairs(particles, list, 0.0, Booking::on);
  Particles fresh = particles;
  PairList other;
  other.setSkin(0.05);
  findPairs(fresh, other);
  clearForces(fresh);
  springs->pairs(fresh, other, 0.0, Booking::on);
  EXPECT_EQ(particles.f, fresh.f);
  EXPECT_GT(particles.f[37].z, 40.0);
}

TEST(Renumbering, WallsLookAgainWhenAsManyComeAsGo) {
  Particles particles = row(4);
  particles.x[3].z = 5.0;
  PrimitiveWall plane = makePlane({0, 0, 0}, {0, 0, 1});
  plane.skin = 0.02;
  const TriangulatedWall mesh = squares(4, 4, 1.0);
  WallCandidates candidates;
  candidates.skin = 0.02;
  const auto touching = [&] {
    findContacts(particles, plane, {0.0});
    updateWallCandidates(particles, mesh, candidates, {0.0, 0.0});
    WallContacts contacts;
    findWallContacts(particles, mesh, candidates, EdgeRule::projected, contacts);
    EXPECT_EQ(plane.contacts.particle, contacts.particle);
    return plane.contacts.particle;
  };
  EXPECT_EQ(touching(), (std::vector<int>{0, 1, 2}));
  const std::vector<int> number = removeParticles(particles, std::vector<int>{1});
  renumber(plane, number);
  addParticle(particles, {0.5, 0.5, 0.05}, {}, 0.1, Mass{1.0});
  EXPECT_EQ(touching(), (std::vector<int>{0, 1, 3}));
}

TEST(Renumbering, WhatContactsOfLeaversHeldHasLeftAtOnceWhateverTheNextSteps) {
  for (const double dt : {1e-6, 1e-5, 1e-4}) {
    Model model;
    model.laws = makeContactLaws(FrictionalLaw{{1e4, 0.5}, {3e3, 0.4, 0.2}});
    for (int i = 0; i < 3; ++i) addParticle(model.particles, {0.199 * i, 0, 0}, {}, 0.1, Mass{1.0});
    run(model, 1e-6, 50);
    const Energies before = energies(model);
    removeParticles(model, std::vector<int>{0});
    EXPECT_NEAR(energies(model).balance(), before.balance(), 1e-12 * before.contacts);
    EXPECT_NEAR(energies(model).left, 0.5 * before.contacts, 0.1 * before.contacts);
    run(model, 1e-6, 1);
    for (int i = 0; i < 2; ++i) {
      const double left = energies(model).balance();
      run(model, dt, 1);
      EXPECT_NEAR(energies(model).balance(), left, 2.0 * dt * before.contacts) << dt;
    }
  }
}

MeshWall meshFloor() {
  MeshWall mesh;
  mesh.wall = squares(4, 4, 1.0);
  return mesh;
}

/// Two spheres that stick to a floor over which they move.
Model stickingTo(const auto& floor) {
  Model model;
  model.laws = makeContactLaws(FrictionalLaw{{1e3}, {8e2, 5.0}});
  for (int i = 0; i < 2; ++i) addParticle(model.particles, {0.5 + i, 0.7, 0.09}, {1, 0, 0}, 0.1, Mass{1.0});
  addWall(model, floor);
  return model;
}

TEST(Renumbering, WhatSpringsOfLeaversHeldAtWallsHasLeftAtOnce) {
  const auto check = [](const auto& floor) {
    Model model = stickingTo(floor);
    run(model, 1e-4, 20);
    const Energies before = energies(model);
    EXPECT_EQ(before.lost.frictionPower, 0.0);
    const double overlap = 0.1 - model.particles.x[1].z;
    const double spring = 0.5 * before.contacts - 0.5 * 1e3 * overlap * overlap;
    EXPECT_GT(spring, 1e-3);
    removeParticles(model, std::vector<int>{1});
    EXPECT_NEAR(energies(model).balance(), before.balance(), 1e-12 * spring);
    EXPECT_NEAR(model.booked.left, 0.5 * (before.contacts + before.kinetic), 1e-12);
    run(model, 1e-4, 20);
    const Energies after = energies(model);
    EXPECT_EQ(after.lost.frictionPower, 0.0);
    EXPECT_NEAR(after.balance(), before.balance(), 1e-3 * spring);
  };
  check(makePlane({}, {0, 0, 1}));
  check(meshFloor());
}

TEST(Renumbering, ALeaverAndItsWallMayGoTogether) {
  const auto check = [](const auto& floor, const auto& ofModel) {
    Model model = stickingTo(floor);
    run(model, 1e-4, 20);
    const Energies before = energies(model);
    removeParticles(model, std::vector<int>{1});
    removeWall(model, ofModel(model));
    run(model, 1e-4, 20);
    EXPECT_NEAR(energies(model).balance(), before.balance(), 1e-12);
  };
  check(
      makePlane({}, {0, 0, 1}), [](Model & m) -> auto& { return primitiveWall(m, 0); });
  check(
      meshFloor(), [](Model & m) -> auto& { return meshWall(m, 0); });
}

TEST(Renumbering, ContactsWithWallsStartAnewBehindALawThatForgets) {
  const auto check = [](const auto& floor, const auto& force) {
    Model model = stickingTo(floor);
    run(model, 1e-4, 20);
    EXPECT_LT(force(model).x, -1.0);
    const auto sticking = std::exchange(model.laws, springs);
    run(model, 1e-4, 2);
    model.laws = sticking;
    findForces(model);
    EXPECT_NEAR(force(model).x, 0.0, 1e-12);
  };
  const auto force = [](const Model& m) { return m.particles.f[0]; };
  check(makePlane({}, {0, 0, 1}), force);
  check(meshFloor(), force);
}

}  // namespace
}  // namespace dovetail::dem
