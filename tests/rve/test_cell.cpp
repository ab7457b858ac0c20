#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "cells.hpp"
#include "dovetail/core/error.hpp"

namespace dovetail::rve {
namespace {

/// A cell with stretched tangential springs, some of which slip, away from balance.
Rve shaken(Rve cell, std::mt19937& random) {
  const double d = meanDiameter(cell);
  const Components w = randomMotion(cell.state.v, 2e-4 * d, random);
  displace(cell, w, randomMotion(cell.state.spin, 2e-4, random));
  return cell;
}

void expectForcesAreSlopesOfTheEnergy(Rve cell) {
  std::mt19937 random(7);
  Springs sticking = cell.springs;
  sticking.friction = std::numeric_limits<double>::infinity();
  setSprings(cell, sticking);
  cell = shaken(std::move(cell), random);
  const Components w = randomMotion(cell.state.v, 1e-8, random), theta = randomMotion(cell.state.spin, 1e-6, random);
  const double slope = -scalarProduct(cell.state.force, w) - scalarProduct(cell.state.torque, theta);
  const auto energyAt = [&](double way) {
    Rve moved = cell;
    displace(moved, scaled(w, way), scaled(theta, way));
    return storedEnergy(moved);
  };
  EXPECT_NEAR(0.5 * (energyAt(1.0) - energyAt(-1.0)), slope, 2e-5 * std::abs(slope));
}

TEST(Rve, ForcesOfDiscsAreSlopesOfTheEnergy) { expectForcesAreSlopesOfTheEnergy(pressedDiscs(40)); }
TEST(Rve, ForcesOfSpheresAreSlopesOfTheEnergy) { expectForcesAreSlopesOfTheEnergy(pressedSpheres(48)); }
TEST(Rve, ForcesOfRollingDiscsAreSlopesOfTheEnergy) {
  Rve cell = pressedDiscs(40);
  Springs rolling = cell.springs;
  rolling.rolling = 0.7;
  rolling.rollingLimit = 1e9;
  setSprings(cell, rolling);
  expectForcesAreSlopesOfTheEnergy(std::move(cell));
}

TEST(Rve, StressIsTheSlopeOfTheEnergyByStrain) {
  for (Rve cell : {pressedDiscs(40), pressedSpheres(48)}) {
    std::mt19937 random(3);
    Springs sticking = cell.springs;
    sticking.friction = std::numeric_limits<double>::infinity();
    setSprings(cell, sticking);
    cell = shaken(std::move(cell), random);
    Eigen::Matrix3d E = Eigen::Matrix3d::Zero();
    E.topLeftCorner(cell.dimension(), cell.dimension()).setRandom();
    const double h = 1e-7, slope = stress(cell).cauchy.cwiseProduct(E).sum() * volume(cell);
    Rve more = cell, less = cell;
    deform(more, Eigen::Matrix3d::Identity() + h * E);
    deform(less, Eigen::Matrix3d::Identity() - h * E);
    EXPECT_NEAR((storedEnergy(more) - storedEnergy(less)) / (2.0 * h), slope, 1e-5 * std::abs(slope));
    EXPECT_NEAR(more.state.ledger.work - cell.state.ledger.work, h * slope, 1e-3 * std::abs(h * slope));
  }
}

TEST(Rve, ForcesAndMomentsSumToZero) {
  std::mt19937 random(5);
  const Rve cell = shaken(pressedDiscs(60), random);
  double x = 0.0, y = 0.0, size = 0.0, moment = cell.state.virial(0, 1) - cell.state.virial(1, 0), torques = 0.0;
  for (std::size_t i = 0; i < cell.size(); ++i) {
    x += cell.state.force[0][i];
    y += cell.state.force[1][i];
    size += std::abs(cell.state.force[0][i]);
    torques += cell.state.torque[2][i];
  }
  EXPECT_NEAR(x, 0.0, 1e-13 * size);
  EXPECT_NEAR(y, 0.0, 1e-13 * size);
  // Couples of the contacts about the grains' centres are those of their forces on the branches.
  EXPECT_NEAR(torques, -moment, 1e-10 * std::abs(torques));
}

TEST(Rve, FrictionHoldsNoMoreThanItsShare) {
  std::mt19937 random(6);
  const Rve cell = shaken(pressedDiscs(60), random);
  const Balance found = balance(cell);
  EXPECT_GT(found.sliding, 0);
  EXPECT_LT(found.sliding, found.contacts);
  EXPECT_GT(cell.state.ledger.friction, 0.0);
}

Grains grainsOf(const Rve& cell, const Vec3& moved) {
  Grains grains{.density = cell.density};
  for (std::size_t i = 0; i < cell.size(); ++i) {
    grains.centre.push_back(Vec3{cell.state.x[0][i], cell.state.x[1][i], 0.0} + moved);
    grains.radius.push_back(cell.radius[i]);
  }
  return grains;
}

TEST(Rve, MovingTheOriginLeavesTheStress) {
  const Rve pressed = pressedDiscs(60);
  const Rve cell = makeRve(grainsOf(pressed, {}), pressed.state.lattice, pressed.springs);
  const double side = norm(cell.state.lattice.period[0]);
  const Vec3 moved{0.37 * side, -1.81 * side, 0.0};
  const Rve same = makeRve(grainsOf(pressed, moved), cell.state.lattice, cell.springs);
  EXPECT_LT((stress(same).cauchy - stress(cell).cauchy).norm(), 1e-12 * stress(cell).cauchy.norm());
  EXPECT_NE(same.state.contacts.image, cell.state.contacts.image);
}

TEST(Rve, AnotherBasisOfTheLatticeLeavesTheStress) {
  const Rve pressed = pressedDiscs(60);
  const Rve cell = makeRve(grainsOf(pressed, {}), pressed.state.lattice, pressed.springs);
  geometry::Lattice sheared = cell.state.lattice;
  sheared.period[1] += sheared.period[0];
  const Rve same = makeRve(grainsOf(pressed, {}), sheared, cell.springs);
  EXPECT_LT((stress(same).cauchy - stress(cell).cauchy).norm(), 1e-12 * stress(cell).cauchy.norm());
}

TEST(Rve, ARestoredCellGoesOnWithTheSameDigits) {
  for (Rve cell : {pressedDiscs(60), pressedSpheres(48)}) {
    CellState kept;
    std::mt19937 random(9);
    cell = shaken(std::move(cell), random);
    const auto goOn = [&] {
      Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
      G(0, 0) += 2e-4;
      G(0, 1) -= 3e-4;
      for (int k = 0; k < 150; ++k) step(cell, 0.5 * cell.state.criticalStep, G, 0.2);
      return cell.state;
    };
    save(cell, kept);
    const CellState first = goOn();
    restore(cell, kept);
    const CellState second = goOn();
    EXPECT_EQ(first.x, second.x);
    EXPECT_EQ(first.spin, second.spin);
    EXPECT_EQ(first.contacts.stretch, second.contacts.stretch);
    EXPECT_EQ(first.virial, second.virial);
    EXPECT_EQ(first.ledger.friction, second.ledger.friction);
    EXPECT_NE(first.x, kept.x);
  }
}

TEST(Rve, BadGrainsAndPeriodsAreRefusedByName) {
  const Rve cell = squareArray(4);
  Grains grains{.centre = {{0, 0, 0}}, .radius = {1e-3}};
  const geometry::Lattice wide{{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}, {true, true, false}};
  EXPECT_NO_THROW(makeRve(grains, wide, cell.springs));
  const geometry::Lattice narrow{{Vec3{4e-3, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}, {true, true, false}};
  EXPECT_THROW(makeRve(grains, narrow, cell.springs), InputError);
  geometry::Lattice through = wide;
  through.axes[2] = true;
  EXPECT_THROW(makeRve(grains, through, cell.springs), InputError);
  EXPECT_THROW(makeRve(grains, wide, {}), InputError);
  EXPECT_THROW(makeRve(grains, wide, {.modulus = 1.0, .stiffness = 1.0}), InputError);
  EXPECT_THROW(makeRve(grains, wide, {.stiffness = std::nan("")}), InputError);
  Grains bad = grains;
  bad.radius = {0.0};
  EXPECT_THROW(makeRve(bad, wide, cell.springs), InputError);
  bad = grains;
  bad.centre[0].z = 1.0;
  EXPECT_THROW(makeRve(bad, wide, cell.springs), InputError);
  EXPECT_THROW(makeRve({}, wide, cell.springs), InputError);
  Rve other = cell;
  EXPECT_THROW(restore(other, makeRve(grains, wide, cell.springs).state), InputError);
  EXPECT_THROW(deform(other, -Eigen::Matrix3d::Identity()), Error);
  EXPECT_THROW(deform(other, 2.0 * Eigen::Matrix3d::Identity()), InputError);
  EXPECT_THROW(deform(other, plane(-1, 0, 0, 1)), NumericalError);
}

}  // namespace
}  // namespace dovetail::rve
