#include <gtest/gtest.h>

#include <cmath>

#include "cells.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/rve/contact_sample.hpp"

namespace dovetail::rve {
namespace {

TEST(Preparation, CellsPressAsWantedAndRest) {
  Rve cell = randomCell({.count = 150, .seed = 3}, ordinarySprings());
  compress(cell, {.pressure = {1e5, 1.3e5, 0}, .friction = 0.2});
  const Eigen::Matrix3d now = stress(cell).cauchy;
  EXPECT_NEAR(-now(0, 0), 1e5, 1e2);
  EXPECT_NEAR(-now(1, 1), 1.3e5, 1.3e2);
  EXPECT_LE(balance(cell).unbalanced, 1e-4);
  EXPECT_EQ(cell.state.F, Eigen::Matrix3d::Identity());
  EXPECT_NEAR(cell.volume, volume(cell), 1e-15 * cell.volume);
}

TEST(Preparation, LessFrictionMakesDenserCells) {
  const auto solidAt = [](double friction) {
    Rve cell = randomCell({.count = 200}, ordinarySprings());
    compress(cell, {.friction = friction});
    return solidFraction(cell);
  };
  EXPECT_GT(solidAt(0.0), solidAt(0.5) + 0.005);
}

TEST(Preparation, SpheresArePreparedAlike) {
  const Rve cell = pressedSpheres(64);
  EXPECT_NEAR(stress(cell).pressure, 1e6, 1e3);
  EXPECT_GT(solidFraction(cell), 0.6);
  EXPECT_GT(balance(cell).coordination, 5.0);
}

/// With hardly more contacts than hold them, discs yield in shear and their pressures differ until the servo hurries.
TEST(Preparation, PackingsThatYieldInShearAreNotWaitedFor) {
  constexpr double stiffness = 1e4, thickness = 1e-3, wanted = 1e-4 * stiffness / thickness;
  Rve cell = randomCell({.count = 189,
                         .sizes = dem::UniformSizes{0.3e-3, 0.45e-3},
                         .thickness = thickness,
                         .density = 2000.0,
                         .seed = 15},
                        {.stiffness = stiffness, .tangential = 0.2, .friction = 0.4});
  compress(cell, {.pressure = {wanted, wanted, 0.0}, .friction = 0.0, .steps = 300000});
  const Eigen::Matrix3d now = stress(cell).cauchy;
  EXPECT_NEAR(-now(0, 0), wanted, 1e-3 * wanted);
  EXPECT_NEAR(-now(1, 1), wanted, 1e-3 * wanted);
  EXPECT_LE(balance(cell).unbalanced, 1e-4);
}

TEST(Preparation, FabricIsThatOfArraysAndTurnsWithTheCell) {
  EXPECT_LT((fabric(squareArray(6)) - Eigen::Vector3d(0.5, 0.5, 0.0).asDiagonal().toDenseMatrix()).norm(), 1e-14);
  const Rve start = pressedDiscs(80);
  const Eigen::Matrix3d before = fabric(start), R = turned(0.4);
  EXPECT_NEAR(before.trace(), 1.0, 1e-14);
  Rve cell = start;
  deform(cell, R);
  EXPECT_LT((fabric(cell) - R * before * R.transpose()).norm(), 1e-12);
  // Shortened along y: more contacts lie that way.
  followPath(cell = start, plane(1.004, 0, 0, 0.99));
  EXPECT_GT(fabric(cell)(1, 1), before(1, 1));
  EXPECT_LT((fabric(framed(start, everywhere(Condition::periodic))) - before).norm(), 1e-12);
}

/// Σ f ⊗ b of the contacts one by one is the virial, and those that slide are counted.
TEST(Preparation, ContactsOneByOneAreTheStress) {
  for (Rve cell : {pressedDiscs(80), pressedSpheres(64)}) {
    followPath(cell, plane(1.0, 0.004, 0, 0.996));
    const ContactSample sample = sampleContacts(cell);
    const Balance now = balance(cell);
    EXPECT_EQ(sample.size(), static_cast<std::size_t>(now.contacts));
    Eigen::Matrix3d virial = Eigen::Matrix3d::Zero();
    int sliding = 0;
    for (std::size_t c = 0; c < sample.size(); ++c) {
      const Vec3 &f = sample.force[c], &b = sample.branch[c];
      virial += Eigen::Vector3d(f.x, f.y, f.z) * Eigen::RowVector3d(b.x, b.y, b.z);
      sliding += sample.slides[c];
    }
    EXPECT_LT((virial - cell.state.virial).norm(), 1e-9 * virial.norm());
    EXPECT_EQ(sliding, now.sliding);
    EXPECT_GT(sliding, 0);
  }
}

TEST(Preparation, SameSeedSameCell) {
  EXPECT_EQ(pressedDiscs(50, 4).state.x, pressedDiscs(50, 4).state.x);
  EXPECT_NE(pressedDiscs(50, 4).state.x, pressedDiscs(50, 5).state.x);
}

TEST(Preparation, BadSettingsAreRefused) {
  Rve cell = squareArray(4);
  EXPECT_THROW(compress(cell, {.pressure = {-1e5, 1e5, 1e5}}), InputError);
  EXPECT_THROW(compress(cell, {.tolerance = 0.0}), InputError);
  EXPECT_THROW(compress(cell, {.friction = -0.1}), InputError);
  EXPECT_THROW(randomCell({.count = 0}, ordinarySprings()), InputError);
  EXPECT_THROW(randomCell({.solidFraction = 1.2}, ordinarySprings()), InputError);
  EXPECT_THROW(randomCell({.count = 2}, ordinarySprings()), InputError);
}

}  // namespace
}  // namespace dovetail::rve
