#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/rve/operators.hpp"
#include "dovetail/rve/rve_archive.hpp"
#include "hill_mandel.hpp"
#include "ledger.hpp"

namespace dovetail::rve {
namespace {

/// Stiffnesses like those of the contacts of pressedDiscs; strengths some times the forces there.
BondLaw law(double times) {
  return {.normal = 4e6,
          .shear = 2e6,
          .bending = 20.0,
          .tensileStrength = 60.0 * times,
          .shearStrength = 60.0 * times,
          .bendingStrength = 0.3 * times};
}

Rve bonded(int count, double times) {
  Rve cell = pressedDiscs(count);
  bond(cell, law(times));
  return cell;
}

/// Two discs that touch, far from all images, bonded.
Rve pair(const BondLaw& bonds) {
  const Grains grains{.centre = {{0.1, 0.1, 0.0}, {0.1199, 0.1, 0.0}}, .radius = {0.01, 0.01}};
  Rve cell = makeRve(grains, {{Vec3{0.3, 0, 0}, Vec3{0, 0.3, 0}, Vec3{0, 0, 0.1}}, {true, true, false}},
                     {.stiffness = 1e6, .tangential = 0.5, .friction = 0.4});
  bond(cell, bonds);
  return cell;
}

TEST(Bonds, CarryWhatTheirContactsCarried) {
  Rve cell = pressedDiscs(80);
  followPath(cell, plane(1.001, 0.002, 0.0, 0.998), {.rest = {.tolerance = 1e-6}});
  const Eigen::Matrix3d before = stress(cell).cauchy;
  const int contacts = balance(cell).contacts;
  const double stored = storedEnergy(cell);
  bond(cell, law(1e6));
  EXPECT_LT((stress(cell).cauchy - before).norm(), 1e-12 * before.norm());
  EXPECT_EQ(balance(cell).bonds, contacts);
  EXPECT_EQ(balance(cell).contacts, contacts);
  EXPECT_NEAR(cell.state.ledger.bonds, stored - storedEnergy(cell), 1e-12 * stored);
}

TEST(Bonds, OfTwoDiscsPullSlideAndBendAsTheirLawSays) {
  const BondLaw bonds{.normal = 2e6, .shear = 5e5, .bending = 30.0};
  Rve cell = pair(bonds);
  const double pressed = cell.state.force[0][1];
  EXPECT_NEAR(pressed, 1e6 * 1e-4, 1e-6);
  const double e = 1e-6, turn = 1e-5;
  Components w = cell.state.v, theta = cell.state.spin;
  w[0][1] = 2e-4;
  w[1][1] = e;
  theta[2][0] = turn;
  displace(cell, w, theta);
  const double distance = 0.0199 + 2e-4, tilt = e / distance, normalForce = pressed - 2e6 * 2e-4;
  const double tangentialForce = 5e5 * (e - tilt * 2e-4 - 0.5 * distance * turn);
  EXPECT_NEAR(cell.state.force[0][1], normalForce, 1e-4);
  EXPECT_NEAR(cell.state.force[1][1], tilt * normalForce - tangentialForce, 1e-4 * tangentialForce);
  EXPECT_NEAR(cell.state.torque[2][1], 0.5 * distance * tangentialForce + 30.0 * turn, 1e-6 * tangentialForce);
}

TEST(Bonds, BreakWhereTheirLawSays) {
  const BondLaw bonds{.normal = 1e6, .shear = 5e5, .bending = 30.0, .tensileStrength = 50.0, .shearStrength = 20.0};
  for (const double fraction : {0.99, 1.01}) {
    Rve cell = pair(bonds);
    Components w = cell.state.v;
    w[0][1] = 1e-4 + 0.5 * fraction * 50.0 / 1e6;
    w[1][1] = 0.5 * fraction * 20.0 / 5e5;
    displace(cell, w, cell.state.spin);
    EXPECT_EQ(balance(cell).bonds, fraction < 1.0 ? 1 : 0);
    const double stored = 0.5 * 25.0 * 25.0 / 1e6 + 0.5 * 10.0 * 10.0 / 5e5;
    EXPECT_NEAR(cell.state.ledger.bonds, fraction < 1.0 ? 0.0 : stored, 0.05 * stored);
    EXPECT_EQ(cell.state.force[0][1] == 0.0, fraction > 1.0);
  }
}

TEST(Bonds, ElasticTangentIsTheProbeWithBonds) {
  Rve cell = bonded(80, 1e6);
  followPath(cell, plane(1.001, 0.002, 0.0, 0.999), {.rest = {.tolerance = 1e-7}});
  const Tangent A = elasticTangent(cell), probe = elasticProbe(cell);
  EXPECT_LT((A - probe).norm(), 1e-4 * A.norm());
  cell = bonded(80, 1.0);
  followPath(cell, plane(1.003, 0.004, 0.0, 0.994), {.rest = {.tolerance = 1e-7}});
  const Balance found = balance(cell);
  ASSERT_GT(found.bonds, 0);
  ASSERT_LT(found.bonds, found.contacts);
  const Tangent B = elasticTangent(cell), broken = elasticProbe(cell);
  EXPECT_LT((B - broken).norm(), 1e-4 * B.norm());
}

TEST(Bonds, TheLedgerClosesWhileBondsBreak) {
  Rve cell = bonded(100, 1.0);
  cell.state.ledger = {};
  const double before = storedEnergy(cell);
  const int bonds = balance(cell).bonds;
  for (int k = 1; k <= 4; ++k)
    followPath(cell, plane(1.0 + 0.005 * k, 0, 0, 1.0 - 0.007 * k), {.stepFraction = 0.3, .rest = {.steps = 0}});
  EXPECT_LT(balance(cell).bonds, bonds);
  EXPECT_GT(cell.state.ledger.bonds, 1e-2 * cell.state.ledger.work);
  EXPECT_LT(std::abs(ledgerResidual(cell, before)), 1e-3);
}

TEST(Bonds, HillAndMandelsConditionHoldsWithBonds) {
  std::mt19937 random(4);
  const Rve start = pressedDiscs(100);
  for (const Conditions& conditions : kindsOfFrames()) {
    Rve cell = framed(start, conditions);
    bond(cell, law(4.0));
    const int bonds = balance(cell).bonds;
    for (int k = 1; k <= 3; ++k) followPath(cell, plane(1, 0.005 * k, 0, 1 - 0.001 * k), {.rest = {.tolerance = 1e-4}});
    const RestReport rest = relax(cell, {.tolerance = 1e-8, .steps = 40000});
    EXPECT_TRUE(rest.atRest) << rest.residual;
    EXPECT_LT(balance(cell).bonds, bonds);
    EXPECT_GT(balance(cell).bonds, 0);
    for (int k = 0; k < 3; ++k) EXPECT_LT(hillMandelError(cell, random), 1e-6);
  }
}

std::vector<char> bytesOf(const Rve& cell) {
  ByteWriter archive;
  writeState(cell, cell.state, archive);
  return archive.bytes();
}

TEST(Bonds, GoOnFromAFileWithTheSameDigits) {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "bonded.cells";
  Rve cell = bonded(80, 1.0);
  followPath(cell, plane(1.003, 0.004, 0.0, 0.994));
  writeSamples(path, std::span(&cell, 1));
  Rve read = readSamples(path).front();
  CellState kept;
  save(cell, kept);
  const auto goOn = [](Rve& c) {
    followPath(c, plane(1.006, 0.008, 0.0, 0.988));
    return bytesOf(c);
  };
  const std::vector<char> first = goOn(cell);
  restore(cell, kept);
  EXPECT_EQ(goOn(cell), first);
  EXPECT_EQ(goOn(read), first);
  EXPECT_LT(balance(read).bonds, 80 * 2);
  std::filesystem::remove(path);
}

TEST(Bonds, WhatCannotBeBondedIsRefused) {
  Rve spheres = pressedSpheres(48);
  EXPECT_THROW(bond(spheres, law(1.0)), InputError);
  Rve cell = pressedDiscs(60);
  EXPECT_THROW(bond(cell, {}), InputError);
  EXPECT_THROW(bond(cell, {.normal = 1.0, .shear = -1.0}), InputError);
  EXPECT_THROW(bond(cell, {.normal = 1.0, .tensileStrength = 0.0}), InputError);
  bond(cell, law(1.0));
  EXPECT_THROW(bond(cell, law(1.0)), InputError);
  EXPECT_THROW(framed(cell, everywhere(Condition::periodic)), InputError);
}

TEST(Bonds, StretchAsFarAsTheyHold) {
  Rve cell = pair({.normal = 1e6});
  const double pressed = cell.state.force[0][1];
  for (int k = 0; k < 40; ++k) deform(cell, plane(1.01, 0, 0, 0.99));
  EXPECT_NEAR(cell.state.force[0][1], pressed - 1e6 * 0.0199 * (std::pow(1.01, 40) - 1.0), 1e-6);
  EXPECT_EQ(balance(cell).bonds, 1);
}

}  // namespace
}  // namespace dovetail::rve
