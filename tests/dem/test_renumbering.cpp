// Particles that come, go and change their numbers, and what refers to them.
#include <gtest/gtest.h>

#include "dovetail/dem/model/model.hpp"
#include "dovetail/dem/setup/insertion.hpp"
#include "dovetail/dem/walls/primitive_wall.hpp"
#include "wall_scenes.hpp"

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
  renumber(plane, number, particles);
  addParticle(particles, {0.5, 0.5, 0.05}, {}, 0.1, Mass{1.0});
  EXPECT_EQ(touching(), (std::vector<int>{0, 1, 3}));
}

TEST(Renumbering, WhatContactsOfLeaversHeldIsLostInTheStepThatFollows) {
  Model model;
  model.laws = springs;
  model.particles = row(4);
  run(model, 1e-4, 20);
  const Energies before = energies(model);
  removeParticles(model, std::vector<int>{3});
  run(model, 1e-4, 20);
  const Energies after = energies(model);
  EXPECT_GT(after.lost.dissipatedPower, 0.01);
  EXPECT_NEAR(after.balance(), before.balance(), 1e-3 * after.lost.dissipatedPower);
}

}  // namespace
}  // namespace dovetail::dem
