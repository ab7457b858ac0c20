// A law with a range: forms on contact, pulls beyond it, ruptures; its energy is in the ledger.
#include <gtest/gtest.h>

#include <numbers>

#include "dovetail/dem/laws/contact_laws.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/dem/pairs/pairs.hpp"
#include "dovetail/dem/walls/primitive_wall.hpp"
#include "walls/wall_scenes.hpp"

namespace dovetail::dem {
namespace {

constexpr double radius = 1e-3, gap0 = 1e-5;
const LiquidBridge bridge{0.072, 1e-11, 0.3};
const ContactLaw<HertzDashpot, MindlinSpring, NoRolling, LiquidBridge> law{{1e7, 0.8}, {0.8, 0.4}, {}, bridge};

TEST(LiquidBridge, TheForceIsTheSlopeOfItsEnergyAndWillettsFormula) {
  const auto wet = bridge.prepare();
  Contact contact;
  contact.effectiveRadius = 0.5 * radius;
  double held = 1.0;
  const auto at = [&](double gap) {
    contact.overlap = -gap;
    return wet.respond(contact, {}, &held);
  };
  for (const double gap : {-1e-5, 1e-6, 5e-5, 2e-4}) {
    const double h = 1e-8, slope = (at(gap + h).energy - at(gap - h).energy) / (2.0 * h);
    const double s = std::max(gap, 0.0) * std::sqrt(radius / bridge.volume);
    const double pull = 2.0 * std::numbers::pi * radius * 0.072 * std::cos(0.3) / (1.0 + 1.05 * s + 2.5 * s * s);
    EXPECT_NEAR(at(gap).force, -pull, 1e-12);
    EXPECT_NEAR(slope, pull, 1e-7 * pull);
  }
  EXPECT_NEAR(at(wet.reach()).energy, held, 1e-18);
  held = 0.0;
  EXPECT_EQ(at(1e-6).force, 0.0);  // none before the first touch
}

struct Meeting {
  double fast, stored, lost, fractured, start;
};

/// Two spheres (or one and a wall) that meet, and what is left of their motion.
Meeting meet(double speed, bool wall, double dt, int steps) {
  const auto laws = makeContactLaws(law);
  Particles particles;
  addParticle(particles, {0, 0, radius + gap0}, {0, 0, -speed}, radius, Density{2500.0});
  if (!wall) addParticle(particles, {0, 0, -radius}, {}, radius, Density{2500.0});
  PairList list;
  list.setReach(laws->reach());
  list.setSkin(0.2 * radius);
  findPairs(particles, list);
  PrimitiveWall plane = makePlane({}, {0, 0, 1});
  plane.reach = laws->reach();
  Meeting run{0.0, 0.0, 0.0, 0.0, kineticEnergy(particles)};
  for (int s = 0; s < steps; ++s) {
    kick(particles, 0.5 * dt);
    drift(particles, dt);
    clearForces(particles);
    updatePairs(particles, list);
    ContactWork work = laws->pairs(particles, list, dt, Booking::on);
    if (wall) {
      findContacts(particles, plane, movesOf(particles, dt));
      work += laws->wall(particles, plane, dt, Booking::on);
    }
    kick(particles, 0.5 * dt);
    run.stored = work.storedEnergy();
    run.lost += dt * work.lostPower();
    run.fractured += dt * work.fracturePower;
  }
  run.fast = kineticEnergy(particles);
  return run;
}

TEST(LiquidBridge, WhatItTakesAtRuptureIsBooked) {
  const auto wet = bridge.prepare();
  for (const bool wall : {false, true}) {
    Contact contact;
    contact.effectiveRadius = wall ? radius : 0.5 * radius;
    contact.overlap = -wet.reach();
    double held = 1.0;
    const double holds = wet.respond(contact, {}, &held).energy;
    const Meeting fast = meet(0.3, wall, 2e-7, 20000);
    EXPECT_EQ(fast.stored, 0.0);
    EXPECT_NEAR(fast.fractured, holds, 1e-12 * holds);
    EXPECT_NEAR(fast.fast + fast.lost, fast.start, 2e-3 * fast.start);
    const Meeting slow = meet(0.02, wall, 2e-7, 40000);  // too slow to part again
    EXPECT_EQ(slow.fractured, 0.0);
    EXPECT_NE(slow.stored, 0.0);
    EXPECT_NEAR(slow.fast + slow.stored + slow.lost, slow.start, 1e-2 * slow.start);
  }
}

/// A sphere that falls on a floor, sticks out its bridge and leaves, or comes back.
Model wetBall(double speed) {
  Model m;
  m.laws = makeContactLaws(law);
  m.gravity = {0, 0, 0};
  m.pairs.setSkin(0.2 * radius);
  addParticle(m.particles, {0.4e-3, 0.3e-3, radius + gap0}, {0.02, 0.01, -speed}, radius, Density{2500.0});
  return m;
}

TEST(LiquidBridge, ToATriangulatedFloorIsThatToThePlane) {
  for (const EdgeRule rule : {EdgeRule::projected, EdgeRule::paper})
    for (const double speed : {0.3, 0.02}) {
      Model onPlane = wetBall(speed), onMesh = wetBall(speed);
      addWall(onPlane, makePlane({}, {0, 0, 1})).skin = 0.2 * radius;
      MeshWall& mesh = addWall(onMesh, MeshWall{});
      mesh.wall = squares(12, 12, 1e-3);
      for (Vec3& x : mesh.wall.x) x -= Vec3{6e-3, 6e-3, 0};
      mesh.rule = rule;
      mesh.candidates.skin = 0.2 * radius;
      double pulled = 0.0, worst = 0.0;
      for (int s = 0; s < 20000; ++s) {
        advance(onPlane, 2e-7);
        advance(onMesh, 2e-7);
        pulled = std::min(pulled, onMesh.particles.f[0].z);
        worst = std::max(worst, norm(onPlane.particles.f[0] - onMesh.particles.f[0]));
      }
      EXPECT_LT(pulled, -2e-4);
      EXPECT_LE(worst, 1e-6 * 4e-4) << speed;
      EXPECT_LE(norm(onPlane.particles.x[0] - onMesh.particles.x[0]), 1e-9 * radius);
      close(onPlane);
      close(onMesh);
      EXPECT_NEAR(energies(onPlane).lost.fracturePower, energies(onMesh).lost.fracturePower, 1e-15);
      EXPECT_EQ(energies(onMesh).lost.fracturePower > 0.0, speed > 0.1);
    }
}

TEST(LiquidBridge, InACornerBothWallsHoldUntilEachLetsGo) {
  // A ball that touches both halves of a right-angled fold and is drawn along one of them.
  const TriangulatedWall corner = fold(0.5 * std::numbers::pi, 10.0 * radius);
  const auto laws = makeContactLaws(law);
  Particles particles;
  addParticle(particles, {0.999 * radius, 0.1e-3, 0.999 * radius}, {}, radius, Density{2500.0});
  WallCandidates candidates;
  candidates.reach = laws->reach();
  findWallCandidates(particles, corner, radius, candidates);
  WallContacts contacts;
  std::size_t both = 0;
  for (const double gap : {-1e-6, 5e-5, 1e-4, 0.99 * laws->reach(), 1.01 * laws->reach()}) {
    particles.x[0].x = radius + gap;
    clearForces(particles);
    findWallContacts(particles, corner, candidates, EdgeRule::projected, contacts);
    laws->wall(particles, corner, contacts, 1e-7, Booking::on);
    both += contacts.size() == 2;
    if (gap > 0.0) {
      EXPECT_EQ(particles.f[0].x < -1e-5, gap < laws->reach()) << gap;
    }
  }
  EXPECT_EQ(both, 4u);
}

TEST(LiquidBridge, BadOnesAreRefused) {
  EXPECT_THROW(validate(LiquidBridge{-1.0, 1e-11, 0.0}), InputError);
  EXPECT_THROW(validate(LiquidBridge{0.07, 0.0, 0.0}), InputError);
  EXPECT_THROW(validate(LiquidBridge{0.07, 1e-11, 2.0}), InputError);
}

}  // namespace
}  // namespace dovetail::dem
