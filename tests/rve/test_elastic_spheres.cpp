// Cells of Hertz's and Mindlin's spheres.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "../../src/rve/contacts/touching.hpp"
#include "cells.hpp"
#include "dovetail/core/archive.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/rve/operators.hpp"
#include "dovetail/rve/rve_archive.hpp"
#include "ledger.hpp"

namespace dovetail::rve {
namespace {

const Springs elastic = hertzMindlin(29e7, 0.15, 0.5);

Rve pressedElasticSpheres() {
  Rve cell = randomCell(
      {.shape = Shape::sphere, .count = 48, .sizes = dem::UniformSizes{4e-3, 6e-3}, .solidFraction = 0.55}, elastic);
  compress(cell, {.pressure = {4e5, 4e5, 4e5}, .friction = 0.0, .rest = {.tolerance = 1e-6}});
  polish(cell);
  return cell;
}

Eigen::Matrix3d sheared(double gamma) {
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F(0, 1) = gamma;
  F(2, 2) = 1.0 - gamma;
  return F;
}

TEST(ElasticSpheres, SimpleCubicLatticeHasItsPressureAndModuli) {
  const double radius = 0.5 * (1.0 + 1e-9), overlap = 1e-9, modulus = 29e7 / 0.85;
  Grains grains{.shape = Shape::sphere};
  for (int k = 0; k < 27; ++k) grains.centre.push_back({double(k % 3), double(k / 3 % 3), double(k / 9)});
  grains.radius.assign(27, radius);
  const Rve cell = makeRve(grains, {{Vec3{3, 0, 0}, Vec3{0, 3, 0}, Vec3{0, 0, 3}}}, elastic);
  const double slope = 2.0 * modulus * std::sqrt(0.5 * radius * overlap);
  EXPECT_NEAR(stress(cell).pressure, 2.0 / 3.0 * slope * overlap, 1e-6 * slope * overlap);
  const double ratio = 2.0 * 0.85 / 1.85;
  for (const Tangent& A : {elasticTangent(cell), voigtTangent(cell)}) {
    EXPECT_NEAR(A(0, 0), slope, 1e-6 * slope);
    EXPECT_NEAR(A(0, 4), 0.0, 1e-6 * slope);
    EXPECT_NEAR(A(1, 1) + A(1, 3), ratio * slope, 1e-6 * slope);
  }
}

TEST(ElasticSpheres, ForcesAreSlopesOfEnergyStoredAndLost) {
  std::mt19937 random(7);
  Rve cell = pressedElasticSpheres();
  Springs sticking = elastic;
  sticking.friction = std::numeric_limits<double>::infinity();
  setSprings(cell, sticking);
  const double d = meanDiameter(cell);
  displace(cell, randomMotion(cell.state.v, 1e-3 * d, random), randomMotion(cell.state.spin, 1e-3, random));
  const Components w = randomMotion(cell.state.v, 1e-9, random), theta = randomMotion(cell.state.spin, 1e-7, random);
  const double slope = -scalarProduct(cell.state.force, w) - scalarProduct(cell.state.torque, theta);
  const auto lostOn = [&](double way) {
    Rve moved = cell;
    displace(moved, scaled(w, way), scaled(theta, way));
    return moved.state.ledger.friction - cell.state.ledger.friction;
  };
  const auto takenOn = [&](double way) {
    Rve moved = cell;
    displace(moved, scaled(w, way), scaled(theta, way));
    return storedEnergy(moved) + lostOn(way);
  };
  EXPECT_GE(lostOn(1.0), 0.0);
  EXPECT_GE(lostOn(-1.0), 0.0);
  EXPECT_GT(lostOn(1.0) + lostOn(-1.0), 1e-3 * std::abs(slope));
  EXPECT_NEAR(0.5 * (takenOn(1.0) - takenOn(-1.0)), slope, 1e-4 * std::abs(slope));
}

TEST(ElasticSpheres, TheLedgerOfAPathClosesAsStepsShrink) {
  expectLedgerClosesAsStepsShrink(pressedElasticSpheres(), 6, [](int k) { return sheared(0.005 * k); });
}

TEST(ElasticSpheres, HillAndMandelsConditionHoldsInSlidingStates) {
  std::mt19937 random(4);
  Rve cell = pressedElasticSpheres();
  for (int k = 1; k <= 4; ++k) followPath(cell, sheared(0.02 * k), {.rest = {.tolerance = 1e-4}});
  ASSERT_TRUE(relax(cell, {.tolerance = 1e-9, .steps = 40000}).atRest);
  EXPECT_GT(cell.state.ledger.friction, 0.05 * cell.state.ledger.work);
  const Components w = randomMotion(cell.state.v, 1e-2 * meanDiameter(cell), random),
                   theta = randomMotion(cell.state.spin, 1e-2, random);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  const Eigen::Matrix3d L = Eigen::Matrix3d::NullaryExpr([&] { return u(random); });
  const Vec3 spin = 0.5 * Vec3{L(2, 1) - L(1, 2), L(0, 2) - L(2, 0), L(1, 0) - L(0, 1)};
  const auto of = [](const Components& a, std::size_t i) { return Vec3{a[0][i], a[1][i], a[2][i]}; };
  double work = 0.0;
  forEachTouch(cell, [&](const Touch& touch) {
    const Vec3 force = contactForce(cell, touch), couple = cross(touch.normal, force), &b = touch.branch;
    const double armI = 0.5 * (touch.distance + cell.radius[touch.i] - cell.radius[touch.j]);
    const Vec3 strained{L(0, 0) * b.x + L(0, 1) * b.y + L(0, 2) * b.z, L(1, 0) * b.x + L(1, 1) * b.y + L(1, 2) * b.z,
                        L(2, 0) * b.x + L(2, 1) * b.y + L(2, 2) * b.z};
    work += dot(force, strained + of(w, touch.j) - of(w, touch.i)) - armI * dot(couple, of(theta, touch.i) + spin) -
            (touch.distance - armI) * dot(couple, of(theta, touch.j) + spin);
  });
  const double given = volume(cell) * stress(cell).cauchy.cwiseProduct(L).sum();
  EXPECT_NEAR(work, given, 1e-6 * std::abs(given));
}

TEST(ElasticSpheres, ElasticTangentIsTheProbeWhereNoTangentialSpringIsStretched) {
  const Rve cell = pressedElasticSpheres();
  const Tangent A = elasticTangent(cell), probe = elasticProbe(cell);
  EXPECT_LT((A - probe).norm(), 1e-4 * A.norm());
  EXPECT_GT(voigtTangent(cell)(0, 0), A(0, 0));
}

TEST(ElasticSpheres, ArchivesHoldTheLaw) {
  Rve cell = pressedElasticSpheres();
  followPath(cell, sheared(0.003), {.rest = {.steps = 0}});
  ByteWriter archive;
  writeState(cell, cell.state, archive);
  Rve again = cell;
  ByteReader bytes(archive.bytes());
  restore(again, readState(cell, bytes));
  for (Rve* each : {&cell, &again})
    for (int k = 0; k < 20; ++k) step(*each, 0.5 * each->state.criticalStep, sheared(1e-6));
  EXPECT_EQ(again.state.x, cell.state.x);
  EXPECT_EQ(again.state.contacts.tangent, cell.state.contacts.tangent);
  EXPECT_EQ(again.state.ledger.friction, cell.state.ledger.friction);
  Rve softer = cell;
  softer.springs.hertz *= 0.5;
  ByteReader same(archive.bytes());
  EXPECT_THROW(readState(softer, same), InputError);
}

TEST(ElasticSpheres, WhatIsNoLawIsRefused) {
  EXPECT_THROW(hertzMindlin(0.0, 0.15, 0.5), InputError);
  EXPECT_THROW(hertzMindlin(29e9, 0.6, 0.5), InputError);
  EXPECT_THROW(hertzMindlin(29e9, -1.0, 0.5), InputError);
  Springs both = elastic;
  both.modulus = 6e8;
  Rve spheres = pressedSpheres(48), discs = pressedDiscs(40);
  EXPECT_THROW(setSprings(spheres, both), InputError);
  EXPECT_THROW(setSprings(discs, elastic), InputError);
}

}  // namespace
}  // namespace dovetail::rve
