#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "cells.hpp"
#include "dovetail/core/error.hpp"

namespace dovetail::rve {
namespace {

/// A cell with stretched tangential springs, some of which slip, away from balance.
Cell shaken(Cell cell, std::mt19937& random) {
  const double d = meanDiameter(cell);
  const Components w = randomMotion(cell.state.v, 2e-4 * d, random);
  displace(cell, w, randomMotion(cell.state.spin, 2e-4, random));
  return cell;
}

void expectForcesAreSlopesOfTheEnergy(Cell cell) {
  std::mt19937 random(7);
  Springs sticking = cell.springs;
  sticking.friction = std::numeric_limits<double>::infinity();
  setSprings(cell, sticking);
  cell = shaken(std::move(cell), random);
  const Components w = randomMotion(cell.state.v, 1e-8, random), theta = randomMotion(cell.state.spin, 1e-6, random);
  const double slope = -scalarProduct(cell.state.force, w) - scalarProduct(cell.state.torque, theta);
  const auto energyAt = [&](double way) {
    Cell moved = cell;
    displace(moved, scaled(w, way), scaled(theta, way));
    return storedEnergy(moved);
  };
  EXPECT_NEAR(0.5 * (energyAt(1.0) - energyAt(-1.0)), slope, 2e-5 * std::abs(slope));
}

TEST(Cell, ForcesOfDiscsAreSlopesOfTheEnergy) { expectForcesAreSlopesOfTheEnergy(pressedDiscs(40)); }
TEST(Cell, ForcesOfSpheresAreSlopesOfTheEnergy) { expectForcesAreSlopesOfTheEnergy(pressedSpheres(48)); }
TEST(Cell, ForcesOfRollingDiscsAreSlopesOfTheEnergy) {
  Cell cell = pressedDiscs(40);
  Springs rolling = cell.springs;
  rolling.rolling = 0.7;
  rolling.rollingLimit = 1e9;
  setSprings(cell, rolling);
  expectForcesAreSlopesOfTheEnergy(std::move(cell));
}

TEST(Cell, StressIsTheSlopeOfTheEnergyByStrain) {
  for (Cell cell : {pressedDiscs(40), pressedSpheres(48)}) {
    std::mt19937 random(3);
    Springs sticking = cell.springs;
    sticking.friction = std::numeric_limits<double>::infinity();
    setSprings(cell, sticking);
    cell = shaken(std::move(cell), random);
    Eigen::Matrix3d E = Eigen::Matrix3d::Zero();
    E.topLeftCorner(cell.dimension(), cell.dimension()).setRandom();
    const double h = 1e-7, slope = stress(cell).cauchy.cwiseProduct(E).sum() * volume(cell);
    Cell more = cell, less = cell;
    deform(more, Eigen::Matrix3d::Identity() + h * E);
    deform(less, Eigen::Matrix3d::Identity() - h * E);
    EXPECT_NEAR((storedEnergy(more) - storedEnergy(less)) / (2.0 * h), slope, 1e-5 * std::abs(slope));
    EXPECT_NEAR(more.state.book.work - cell.state.book.work, h * slope, 1e-3 * std::abs(h * slope));
  }
}

TEST(Cell, ForcesAndMomentsSumToZero) {
  std::mt19937 random(5);
  const Cell cell = shaken(pressedDiscs(60), random);
  double x = 0.0, y = 0.0, size = 0.0, moment = cell.state.dyad(0, 1) - cell.state.dyad(1, 0), torques = 0.0;
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

TEST(Cell, FrictionHoldsNoMoreThanItsShare) {
  std::mt19937 random(6);
  const Cell cell = shaken(pressedDiscs(60), random);
  const Balance found = balance(cell);
  EXPECT_GT(found.sliding, 0);
  EXPECT_LT(found.sliding, found.contacts);
  EXPECT_GT(cell.state.book.friction, 0.0);
}

Grains grainsOf(const Cell& cell, const Vec3& moved) {
  Grains grains{.density = cell.density};
  for (std::size_t i = 0; i < cell.size(); ++i) {
    grains.centre.push_back(Vec3{cell.state.x[0][i], cell.state.x[1][i], 0.0} + moved);
    grains.radius.push_back(cell.radius[i]);
  }
  return grains;
}

TEST(Cell, MovingTheOriginLeavesTheStress) {
  const Cell pressed = pressedDiscs(60);
  const Cell cell = makeCell(grainsOf(pressed, {}), pressed.state.lattice, pressed.springs);
  const double side = norm(cell.state.lattice.period[0]);
  const Vec3 moved{0.37 * side, -1.81 * side, 0.0};
  const Cell same = makeCell(grainsOf(pressed, moved), cell.state.lattice, cell.springs);
  EXPECT_LT((stress(same).cauchy - stress(cell).cauchy).norm(), 1e-12 * stress(cell).cauchy.norm());
  EXPECT_NE(same.state.contacts.image, cell.state.contacts.image);
}

TEST(Cell, AnotherBasisOfTheLatticeLeavesTheStress) {
  const Cell pressed = pressedDiscs(60);
  const Cell cell = makeCell(grainsOf(pressed, {}), pressed.state.lattice, pressed.springs);
  geometry::Lattice sheared = cell.state.lattice;
  sheared.period[1] += sheared.period[0];
  const Cell same = makeCell(grainsOf(pressed, {}), sheared, cell.springs);
  EXPECT_LT((stress(same).cauchy - stress(cell).cauchy).norm(), 1e-12 * stress(cell).cauchy.norm());
}

TEST(Cell, ARestoredCellGoesOnWithTheSameDigits) {
  for (Cell cell : {pressedDiscs(60), pressedSpheres(48)}) {
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
    EXPECT_EQ(first.dyad, second.dyad);
    EXPECT_EQ(first.book.friction, second.book.friction);
    EXPECT_NE(first.x, kept.x);
  }
}

TEST(Cell, BadGrainsAndPeriodsAreRefusedByName) {
  const Cell cell = squareArray(4);
  Grains grains{.centre = {{0, 0, 0}}, .radius = {1e-3}};
  const geometry::Lattice wide{{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}, {true, true, false}};
  EXPECT_NO_THROW(makeCell(grains, wide, cell.springs));
  const geometry::Lattice narrow{{Vec3{4e-3, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}, {true, true, false}};
  EXPECT_THROW(makeCell(grains, narrow, cell.springs), InputError);
  geometry::Lattice through = wide;
  through.axes[2] = true;
  EXPECT_THROW(makeCell(grains, through, cell.springs), InputError);
  EXPECT_THROW(makeCell(grains, wide, {}), InputError);
  EXPECT_THROW(makeCell(grains, wide, {.modulus = 1.0, .stiffness = 1.0}), InputError);
  EXPECT_THROW(makeCell(grains, wide, {.stiffness = std::nan("")}), InputError);
  Grains bad = grains;
  bad.radius = {0.0};
  EXPECT_THROW(makeCell(bad, wide, cell.springs), InputError);
  bad = grains;
  bad.centre[0].z = 1.0;
  EXPECT_THROW(makeCell(bad, wide, cell.springs), InputError);
  EXPECT_THROW(makeCell({}, wide, cell.springs), InputError);
  Cell other = cell;
  EXPECT_THROW(restore(other, makeCell(grains, wide, cell.springs).state), InputError);
  EXPECT_THROW(deform(other, -Eigen::Matrix3d::Identity()), Error);
  EXPECT_THROW(deform(other, 2.0 * Eigen::Matrix3d::Identity()), InputError);
  EXPECT_THROW(deform(other, plane(-1, 0, 0, 1)), NumericalError);
}

}  // namespace
}  // namespace dovetail::rve
