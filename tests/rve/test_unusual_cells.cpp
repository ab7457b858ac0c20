// What users do that examples do not.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "cells.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/rve/operators.hpp"
#include "dovetail/rve/rve_archive.hpp"

namespace dovetail::rve {
namespace {

constexpr double notANumber = std::numeric_limits<double>::quiet_NaN();

/// Discs whose tangential springs are stretched.
Rve shearedDiscs() {
  Rve cell = pressedDiscs(60);
  followPath(cell, plane(1.001, 0.0, 0.0, 0.997));
  return cell;
}

double unaccounted(const Rve& cell) {
  const RveLedger& ledger = cell.state.ledger;
  return ledger.work - ledger.friction - ledger.damping - ledger.bonds - storedEnergy(cell);
}

double stretched(const Rve& cell) {
  double sum = 0.0;
  for (const std::vector<double>& component : cell.state.contacts.stretch)
    for (const double u : component) sum += u * u;
  return std::sqrt(sum);
}

TEST(UnusualCells, SpringsWithoutFrictionHoldNothingAndBookIt) {
  Rve cell = shearedDiscs();
  const Springs own = cell.springs;
  Springs smooth = own;
  smooth.friction = 0.0;
  const double stored = storedEnergy(cell), lost = cell.state.ledger.friction, before = unaccounted(cell);
  ASSERT_GT(stretched(cell), 0.0);
  setSprings(cell, smooth);
  EXPECT_EQ(stretched(cell), 0.0);
  EXPECT_NEAR(cell.state.ledger.friction - lost, stored - storedEnergy(cell), 1e-12 * stored);
  EXPECT_GT(cell.state.ledger.friction, lost);
  const double smoothly = storedEnergy(cell);
  setSprings(cell, own);
  EXPECT_EQ(storedEnergy(cell), smoothly);
  EXPECT_NEAR(unaccounted(cell), before, 1e-12 * stored);
}

TEST(UnusualCells, StifferSpringsAreInTheBook) {
  Rve cell = shearedDiscs();
  const double before = unaccounted(cell), stored = storedEnergy(cell);
  Springs stiffer = cell.springs;
  stiffer.modulus *= 2.0;
  setSprings(cell, stiffer);
  EXPECT_NEAR(storedEnergy(cell), 2.0 * stored, 1e-9 * stored);
  EXPECT_NEAR(unaccounted(cell), before, 1e-12 * stored);
}

TEST(UnusualCells, StretchesStayWhenSpheresBecomeElastic) {
  Rve cell = pressedSpheres(48);
  Springs springs = cell.springs;
  springs.friction = std::numeric_limits<double>::infinity();
  setSprings(cell, springs);
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F(0, 1) = 1e-3;
  followPath(cell, F);
  const double before = stretched(cell), ledger = unaccounted(cell), stored = storedEnergy(cell);
  ASSERT_GT(before, 0.0);
  for (const double G : {3e9, 6e9}) {
    setSprings(cell, hertzMindlin(G, 0.2, springs.friction));
    EXPECT_NEAR(stretched(cell), before, 1e-12 * before);
    EXPECT_NEAR(unaccounted(cell), ledger, 1e-10 * (stored + storedEnergy(cell)));
  }
}

TEST(UnusualCells, CompressionEndsAtRestWhateverTheFrictionWas) {
  for (const double friction : {0.0, 1.0}) {
    Rve cell = shearedDiscs();
    compress(cell, {.pressure = {1e5, 1e5, 0.0}, .friction = friction, .rest = {.tolerance = 1e-5}});
    EXPECT_LE(balance(cell).unbalanced, 1e-5);
    for (int k = 0; k < 2; ++k) EXPECT_NEAR(-stress(cell).cauchy(k, k), 1e5, 1e2);
  }
}

TEST(UnusualCells, TractionOnAFlatSide) {
  const Condition D = Condition::displacement, T = Condition::traction;
  Rve cell = framed(squareArray(5), {.bottom = D, .right = D, .top = T, .left = D});
  const PathReport path = followPath(cell, plane(1.0, 1e-4, 0.0, 0.9995), {.rest = {.tolerance = 1e-8}});
  EXPECT_TRUE(path.rest.atRest);
  EXPECT_TRUE(stressOfReactions(cell).allFinite());
  polish(cell);
  const Tangent A = elasticTangent(cell), probe = elasticProbe(cell);
  EXPECT_LT((A - probe).norm(), 1e-4 * A.norm());
}

TEST(UnusualCells, CopiesOfAFrameFillNothing) {
  const Rve cell = pressedDiscs(60);
  EXPECT_NEAR(solidFraction(framed(cell, everywhere(Condition::periodic))), solidFraction(cell), 1e-12);
}

TEST(UnusualCells, StatesOfOtherSpringsAreRefused) {
  Rve cell = pressedDiscs(60);
  CellState kept;
  save(cell, kept);
  Springs rolling = cell.springs;
  rolling.rolling = 1.0;
  rolling.rollingLimit = 0.2;
  setSprings(cell, rolling);
  EXPECT_THROW(restore(cell, kept), InputError);
  ByteWriter archive;
  EXPECT_THROW(writeState(cell, kept, archive), InputError);
  EXPECT_THROW(restore(cell, pressedSpheres(60).state), InputError);
}

TEST(UnusualCells, StatesFromBeforeCompressionOrOfOtherBondsAreRefused) {
  Rve cell = pressedDiscs(60);
  CellState kept;
  save(cell, kept);
  Rve denser = cell;
  compress(denser, {.pressure = {5e5, 5e5, 0.0}});
  EXPECT_THROW(restore(denser, kept), InputError);
  EXPECT_THROW(restore(cell, pressedDiscs(60, 2).state), InputError);
  Rve bonded = cell, other = cell;
  bond(bonded, {.normal = 1e8, .shear = 1e8});
  bond(other, {.normal = 1e9, .shear = 1e8});
  EXPECT_THROW(restore(cell, bonded.state), InputError);
  EXPECT_THROW(restore(other, bonded.state), InputError);
  restore(bonded, kept);
  EXPECT_EQ(balance(bonded).bonds, 0);
}

TEST(UnusualCells, BondsThatBreakAsTheyAreMadeAreInTheBook) {
  for (const double strength : {1.0, 5.0, 1e9}) {
    Rve cell = shearedDiscs();
    const double before = unaccounted(cell), stored = storedEnergy(cell), work = cell.state.ledger.work;
    bond(cell, {.normal = 6e8, .shear = 3e8, .tensileStrength = 1e9, .shearStrength = strength});
    EXPECT_NEAR(unaccounted(cell), before, 1e-12 * stored);
    EXPECT_NEAR(cell.state.ledger.work, work, 1e-12 * stored);
    EXPECT_EQ(balance(cell).bonds < balance(cell).contacts, strength < 1e9);
  }
}

TEST(UnusualCells, WhatIsNotFiniteIsRefused) {
  Rve cell = pressedDiscs(60);
  const CellState before = cell.state;
  EXPECT_THROW(step(cell, 0.5 * cell.state.criticalStep, plane(1, 0, 0, 1), notANumber), InputError);
  EXPECT_THROW(step(cell, 0.5 * cell.state.criticalStep, plane(1, 0, 0, 1), -5.0), InputError);
  EXPECT_THROW(compress(cell, {.damping = notANumber}), InputError);
  Components w = cell.state.v;
  EXPECT_THROW(displace(cell, {}, {}), InputError);
  w[0][3] = notANumber;
  EXPECT_THROW(displace(cell, w, cell.state.spin), InputError);
  EXPECT_EQ(cell.state.x, before.x);
  cell.state.v[1][7] = 1e300;
  try {
    step(cell, 0.5 * cell.state.criticalStep);
    ADD_FAILURE();
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("grain 7"), std::string::npos) << error.what();
  }
}

TEST(UnusualCells, GrainsAtOnePlaceAreNamed) {
  const Grains grains{.centre = {{1e-3, 0, 0}, {4e-3, 0, 0}, {4e-3, 0, 0}}, .radius = {1e-3, 1e-3, 1e-3}};
  const geometry::Lattice lattice{{Vec3{8e-3, 0, 0}, Vec3{0, 8e-3, 0}, Vec3{0, 0, 1}}, {true, true, false}};
  try {
    makeRve(grains, lattice, ordinarySprings());
    ADD_FAILURE();
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("grain 1"), std::string::npos) << error.what();
  }
}

TEST(UnusualCells, BanksHoldWhatCellsWere) {
  // Faces have come closer since the last list was made.
  const double side = 1.01 * 4.4e-3;
  const Grains grains{.centre = {{0, 0, 0}, {1.95e-3, 0, 0}}, .radius = {1e-3, 1e-3}};
  Rve cell =
      makeRve(grains, {{Vec3{side, 0, 0}, Vec3{0, side, 0}, Vec3{0, 0, 1}}, {true, true, false}}, ordinarySprings());
  for (int k = 0; k < 15; ++k) deform(cell, plane(1.0, 0.01, 0.0, 1.0));
  const auto path = std::filesystem::path(testing::TempDir()) / "sheared_cell.samples";
  writeSamples(path, std::vector<Rve>{cell});
  const std::vector<Rve> read = readSamples(path);
  EXPECT_EQ(read.at(0).state.x, cell.state.x);
  EXPECT_EQ(read[0].state.lattice, cell.state.lattice);
}

TEST(UnusualCells, LatticesNeedNotBeReduced) {
  const Rve cell = pressedDiscs(60);
  Grains grains{.radius = cell.radius};
  for (std::size_t i = 0; i < cell.size(); ++i) grains.centre.push_back({cell.state.x[0][i], cell.state.x[1][i], 0.0});
  geometry::Lattice sheared = cell.state.lattice;
  sheared.period[1] += 7.0 * sheared.period[0];
  const Rve same = makeRve(grains, sheared, cell.springs);
  EXPECT_EQ(balance(same).contacts, balance(cell).contacts);
  EXPECT_NEAR(stress(same).pressure, stress(cell).pressure, 1e-6 * stress(cell).pressure);
}

}  // namespace
}  // namespace dovetail::rve
