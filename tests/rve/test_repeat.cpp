// Copies of a cell side by side are the same packing.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

#include "cells.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/rve/rve_archive.hpp"

namespace dovetail::rve {
namespace {

/// Sheared and stretched, in motion, with springs that slip; faces across `thin` are the nearest.
Rve moved(Rve cell, int thin) {
  Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
  G(thin, thin) = 0.9996;
  G((thin + 1) % cell.dimension(), (thin + 1) % cell.dimension()) = 1.0003;
  G(0, 1) += 4e-4;
  for (int k = 0; k < 400; ++k) step(cell, 0.5 * cell.state.criticalStep, G, 0.1);
  return cell;
}

Rve rollingDiscs() {
  Rve cell = pressedDiscs(60);
  Springs springs = cell.springs;
  springs.rolling = 0.5, springs.rollingLimit = 0.1;
  setSprings(cell, springs);
  return cell;
}

Rve bondedDiscs() {
  Rve cell = pressedDiscs(60, 2);
  bond(cell, {.normal = 6e7, .shear = 3e7, .bending = 100.0, .tensileStrength = 3e5});
  return cell;
}

Rve elasticSpheres() {
  Rve cell = pressedSpheres(100);
  setSprings(cell, hertzMindlin(1e9, 0.2, 0.4));
  return cell;
}

/// Every kind of contact, along every axis.
std::vector<Rve> kindsOfCells() {
  return {moved(rollingDiscs(), 0), moved(bondedDiscs(), 1), moved(pressedSpheres(100), 0),
          moved(pressedSpheres(100), 1), moved(elasticSpheres(), 2)};
}

void expectNear(double a, double b, double tolerance, const char* what) {
  EXPECT_NEAR(a, b, tolerance * std::abs(b)) << what;
}

TEST(RepeatedCell, HasTheStressTheForcesAndTwiceTheEnergies) {
  for (const Rve& once : kindsOfCells()) {
    Rve cell = once;
    repeat(cell);
    ASSERT_EQ(cell.size(), 2 * once.size());
    EXPECT_LT((stress(cell).cauchy - stress(once).cauchy).norm(), 1e-14 * stress(once).cauchy.norm());
    EXPECT_EQ(cell.state.F, once.state.F);
    expectNear(solidFraction(cell), solidFraction(once), 1e-13, "solid fraction");
    expectNear(storedEnergy(cell), 2.0 * storedEnergy(once), 1e-13, "stored");
    expectNear(kineticEnergy(cell), 2.0 * kineticEnergy(once), 1e-13, "kinetic");
    EXPECT_EQ(cell.state.ledger.work, 2.0 * once.state.ledger.work);
    EXPECT_EQ(cell.state.ledger.friction, 2.0 * once.state.ledger.friction);
    EXPECT_EQ(cell.state.ledger.damping, 2.0 * once.state.ledger.damping);
    EXPECT_EQ(cell.state.ledger.bonds, 2.0 * once.state.ledger.bonds);
    const Balance now = balance(cell), before = balance(once);
    EXPECT_EQ(now.contacts, 2 * before.contacts);
    EXPECT_EQ(now.sliding, 2 * before.sliding);
    EXPECT_EQ(now.bonds, 2 * before.bonds);
    EXPECT_EQ(now.rattlers, 2 * before.rattlers);
    EXPECT_LT((fabric(cell) - fabric(once)).norm(), 1e-13);
  }
}

/// Forces that are found anew, by the pairs of the repeated cell, are those that were copied.
TEST(RepeatedCell, ListsThePairsOfItsPacking) {
  for (Rve cell : kindsOfCells()) {
    repeat(cell);
    const CellState copied = cell.state;
    Components still = copied.v, unturned = copied.spin;
    displace(cell, scaled(still, 0.0), scaled(unturned, 0.0));
    const double size = std::sqrt(scalarProduct(copied.force, copied.force));
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t i = 0; i < copied.force[k].size(); ++i)
        EXPECT_NEAR(cell.state.force[k][i], copied.force[k][i], 1e-12 * size) << k << ' ' << i;
    ByteWriter written;
    writeState(cell, cell.state, written);
    ByteReader archive(written.bytes());
    EXPECT_NO_THROW(readState(cell, archive));  // who is sound is listed in order
  }
}

TEST(RepeatedCell, GoesOnAsBefore) {
  for (Rve cell : kindsOfCells()) {
    Rve twice = cell;
    repeat(twice);
    Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
    G(0, 0) = 0.9999, G(1, 0) = 1e-4;
    const double dt = 0.5 * std::min(cell.state.criticalStep, twice.state.criticalStep);
    for (int k = 0; k < 60; ++k)
      for (Rve* one : {&cell, &twice}) step(*one, dt, G, 0.1);
    EXPECT_LT((stress(twice).cauchy - stress(cell).cauchy).norm(), 1e-8 * stress(cell).cauchy.norm());
    expectNear(storedEnergy(twice), 2.0 * storedEnergy(cell), 1e-8, "stored");
    expectNear(twice.state.ledger.friction, 2.0 * cell.state.ledger.friction, 1e-8, "friction");
  }
}

/// Whatever the shear was: periods are the shortest.
TEST(RepeatedCell, IsTwiceAsWideWhereItWasThin) {
  Rve cell = moved(pressedDiscs(60), 0);
  deform(cell, plane(1.0, 7.3, 0.0, 1.0));
  const double before = relativeWidth(cell);
  EXPECT_GT(before, 1.0);
  repeat(cell);
  EXPECT_GT(relativeWidth(cell), 1.2 * before);
  cell = squareArray(5);
  deform(cell, plane(0.8, 0.0, 0.0, 1.0));
  const double thin = relativeWidth(cell);
  repeat(cell);
  expectNear(relativeWidth(cell), thin / 0.8, 1e-12, "the other faces");
  repeat(cell);
  expectNear(relativeWidth(cell), 2.0 * thin, 1e-12, "twice as wide");
}

TEST(RepeatedCell, HasTheGrainsOfAnotherInAsManyCopies) {
  const Rve once = pressedDiscs(60);
  Rve cell = once;
  for (int k = 0; k < 3; ++k) repeat(cell);
  const Rve eight = inCopies(once, 1, 8), two = inCopies(cell, 8, 2);
  EXPECT_EQ(eight.radius, cell.radius);
  EXPECT_EQ(eight.mass, cell.mass);
  EXPECT_EQ(eight.inertia, cell.inertia);
  EXPECT_EQ(eight.volume, cell.volume);
  EXPECT_EQ(inCopies(two, 2, 1).radius, once.radius);
  EXPECT_EQ(inCopies(two, 2, 1).volume, once.volume);
  for (const int wrong : {0, -1, 7}) EXPECT_THROW(inCopies(once, wrong, 1), InputError);
  EXPECT_THROW(inCopies(once, 1, 0), InputError);
  Rve cut = framed(squareArray(5), everywhere(Condition::periodic));
  EXPECT_THROW(repeat(cut), InputError);
}

}  // namespace
}  // namespace dovetail::rve
