// That a cell, its path and its answers turn with the frame.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "cells.hpp"
#include "dovetail/rve/deformation_path.hpp"
#include "dovetail/rve/operators.hpp"

namespace dovetail::rve {
namespace {

using Eigen::Matrix3d;

constexpr double degree = std::numbers::pi / 180.0;

Matrix3d turnOf(const Rve& cell, double angle) {
  if (cell.shape == Shape::disc) return turned(angle);
  return Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
}

/// Strains a cell's F, small and with a turn of its own; discs in their plane.
Matrix3d strained(const Rve& cell) {
  Matrix3d F = plane(1.01, 0.015, -0.005, 0.98);
  if (cell.shape == Shape::sphere) F.row(2) << 0.01, -0.005, 0.99;
  return F;
}

/// Soft, so that overlaps are a hundredth of a radius, and digits of places are digits of forces.
Rve pressedSoft(Shape shape, std::uint64_t seed) {
  Rve cell = randomCell({.shape = shape, .count = 64, .solidFraction = shape == Shape::disc ? 0.7 : 0.55, .seed = seed},
                        {.modulus = 1e7, .tangential = 0.8, .friction = 0.5});
  compress(cell, {.pressure = {1e5, 1e5, 1e5}, .friction = 0.0, .rest = {.tolerance = 1e-6}});
  return cell;
}

/// Cells of all kinds of contacts, with tangential springs stretched to and beyond their limit, at rest.
std::vector<Rve> sheared() {
  const Shape disc = Shape::disc, sphere = Shape::sphere;
  std::vector<Rve> cells{pressedSoft(disc, 1), pressedSoft(disc, 2), pressedSoft(sphere, 1), pressedSoft(sphere, 2),
                         framed(pressedSoft(disc, 3), layerUnder({Condition::displacement, Condition::traction}))};
  Springs rolling = cells[1].springs;
  rolling.rolling = 0.5;
  rolling.rollingLimit = 0.1;
  setSprings(cells[1], rolling);
  setSprings(cells[3], hertzMindlin(3e7, 0.2, 0.4));
  for (Rve& cell : cells) {
    const RestReport rest = followPath(cell, strained(cell), {.rest = {.tolerance = 1e-6}}).rest;
    EXPECT_TRUE(rest.atRest);
    EXPECT_GT(cell.state.ledger.friction, 0.0);
    cell.state.ledger = {};
  }
  return cells;
}

void expectTurned(const Rve& cell, const Rve& other, const Matrix3d& R, double tolerance) {
  const Matrix3d expected = R * stress(cell).cauchy * R.transpose();
  EXPECT_LT((stress(other).cauchy - expected).norm(), tolerance * expected.norm());
  EXPECT_NEAR(storedEnergy(other), storedEnergy(cell), tolerance * storedEnergy(cell));
  EXPECT_NEAR(kineticEnergy(other), kineticEnergy(cell), tolerance * storedEnergy(cell));
  const RveLedger &now = other.state.ledger, &then = cell.state.ledger;
  for (double RveLedger::*channel : {&RveLedger::work, &RveLedger::friction, &RveLedger::damping})
    EXPECT_NEAR(now.*channel, then.*channel, tolerance * storedEnergy(cell));
}

TEST(Turns, ATurnStrainsNothingWhateverItsAngle) {
  for (const Rve& cell : sheared())
    for (const double angle : {20.0, -135.0, 179.999, 180.0}) {
      Rve moved = cell;
      const Matrix3d R = turnOf(cell, angle * degree);
      followPath(moved, R * cell.state.F, {.rest = {.steps = 0}});
      expectTurned(cell, moved, R, 1e-12);
      followPath(moved, cell.state.F, {.rest = {.steps = 0}});
      expectTurned(cell, moved, Matrix3d::Identity(), 1e-12);
    }
}

TEST(Turns, AQuarterInPartsLosesNothing) {
  for (const Rve& cell : sheared()) {
    Rve moved = cell;
    for (int k = 1; k <= 6; ++k) followPath(moved, turnOf(cell, 15 * k * degree) * cell.state.F);
    expectTurned(cell, moved, turnOf(cell, 90 * degree), 1e-12);
  }
}

/// A path, without rest and to rest, from a turned state to a deformation that is turned further.
void expectPathsTurn(const Rve& cell, const PathOptions& settings, double tolerance) {
  const Matrix3d first = turnOf(cell, 0.7), second = turnOf(cell, -0.4);
  Rve straight = cell, round = cell;
  deform(round, first);
  // Short: cells with friction are chaotic, round-off grows tenfold in a hundred steps.
  const Matrix3d F = (Matrix3d::Identity() + 0.1 * (strained(cell) - Matrix3d::Identity())) * cell.state.F;
  followPath(straight, F, settings);
  followPath(round, second * F, settings);
  EXPECT_GT(straight.state.ledger.friction, 1e-4 * std::abs(straight.state.ledger.work));
  expectTurned(straight, round, second, tolerance);
}

TEST(Turns, PathsTurnWithTheFrame) {
  for (const Rve& cell : sheared()) {
    expectPathsTurn(cell, {.inertialNumber = 1e-2, .rest = {.steps = 0}}, 1e-11);
    expectPathsTurn(cell, {.inertialNumber = 1e-2, .rest = {.tolerance = 1e-4}}, 1e-11);
  }
}

TEST(Turns, TangentsTurnWithTheFrame) {
  for (const Rve& cell : sheared()) {
    const Matrix3d R = turnOf(cell, 0.7);
    Rve moved = cell;
    deform(moved, R);
    Tangent T = Tangent::Zero();
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) T.block<3, 3>(3 * i, 3 * k).diagonal().setConstant(R(i, k));
    for (const auto& tangent : {elasticTangent, frictionalTangent, voigtTangent}) {
      const Tangent expected = T * tangent(cell) * T.transpose();
      EXPECT_LT((tangent(moved) - expected).norm(), 1e-8 * expected.norm());
    }
  }
}

TEST(Turns, TheAveragedTangentHardensThroughTurnsAndTurnsWhenFrozen) {
  const Matrix3d R = turned(0.5), P = Eigen::Vector3d(-2.0, -1.0, 0.0).asDiagonal();
  const Matrix3d F = plane(1.001, 0.002, 0.0, 0.99);
  Tangent A = Tangent::Random();
  AveragedTangent operators;
  const auto probe = [&] { return A; };
  operators.next(F, P, probe);
  operators.next(R * F, R * P, [&] { return A; });
  EXPECT_TRUE(operators.frozen);  // nothing has hardened
  AveragedTangent hardens;
  hardens.next(F, P, probe);
  hardens.next(R * plane(1, 0, 0, 0.999) * F, R * plane(1, 0, 0, 1.001) * P, probe);
  EXPECT_FALSE(hardens.frozen);
  EXPECT_EQ(hardens.count, 2);
}

TEST(Turns, TheWayIsThatOfTheStretch) {
  Rve cell = pressedSpheres(48);
  deform(cell, turnOf(cell, 0.3) * strained(cell));
  const Matrix3d start = cell.state.F, end = turnOf(cell, 2.0) * strained(cell) * start;
  const DeformationPath path(cell, end), further(cell, turnOf(cell, 1.1) * end);
  EXPECT_EQ(path.at(1.0), end);
  EXPECT_LT((path.at(0.0) - start).norm(), 1e-14);
  EXPECT_NEAR(path.strain(), further.strain(), 1e-14);
  EXPECT_NEAR(path.strains().sum(), std::log(end.determinant() / start.determinant()), 1e-14);
  for (const double s : {0.25, 0.5, 0.9}) {
    const Matrix3d F = path.at(s), G = further.at(s);
    EXPECT_LT((F.transpose() * F - G.transpose() * G).norm(), 1e-14);
    EXPECT_NEAR(F.determinant(), std::pow(start.determinant(), 1.0 - s) * std::pow(end.determinant(), s), 1e-14);
    // Half of a half is a quarter.
    Rve there = cell;
    there.state.F = path.at(0.5 * s);
    EXPECT_NEAR(DeformationPath(there, F).strain(), 0.5 * s * path.strain(), 1e-14);
  }
}

}  // namespace
}  // namespace dovetail::rve
