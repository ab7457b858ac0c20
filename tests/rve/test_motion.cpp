#include <gtest/gtest.h>

#include <cmath>

#include "dovetail/core/error.hpp"
#include "ledger.hpp"

namespace dovetail::rve {
namespace {

TEST(Motion, TheLedgerOfAPathClosesAsStepsShrink) {
  expectLedgerClosesAsStepsShrink(pressedDiscs(100), 4,
                                  [](int k) { return plane(1.0 + 0.005 * k, 0, 0, 1.0 - 0.007 * k); });
}

TEST(Motion, AClosedLoopWithoutSlippingReturnsItsWork) {
  Rve cell = pressedDiscs(60);
  Springs smooth = cell.springs;
  smooth.friction = 0.0;
  setSprings(cell, smooth);
  polish(cell, 1e-9);
  const double stored = storedEnergy(cell);
  for (const double a : {1e-5, -1e-5, 0.0}) {
    deform(cell, relativeDeformation(cell, plane(1.0 + a, a, 0.0, 1.0)));
    relax(cell, {.tolerance = 1e-6});
    polish(cell, 1e-9);
  }
  EXPECT_NEAR(storedEnergy(cell), stored, 1e-6 * stored);
}

TEST(Motion, APathInPartsConverges) {
  const Rve start = pressedDiscs(100);
  const auto stressAfter = [&](int parts) {
    Rve cell = start;
    for (int k = 1; k <= parts; ++k) {
      deform(cell, relativeDeformation(cell, plane(1 + 0.002 * k / parts, 0, 0, 1 - 0.004 * k / parts)));
      EXPECT_TRUE(relax(cell, {.tolerance = 1e-5}).atRest);
    }
    EXPECT_GT(cell.state.ledger.friction, 1e-3 * cell.state.ledger.work);
    return stress(cell).cauchy;
  };
  const Eigen::Matrix3d fine = stressAfter(1000);
  const auto errorOf = [&](int parts) { return (stressAfter(parts) - fine).norm() / fine.norm(); };
  const double one = errorOf(1), ten = errorOf(10), hundred = errorOf(100);
  EXPECT_LT(ten, 0.5 * one);
  EXPECT_LT(hundred, 0.5 * ten);
}

TEST(Motion, ReductionOfTheLatticeOnTheWayIsNotFelt) {
  // A shear of more than one, in which a reduced lattice and its images change several times.
  Rve cell = squareArray(6, 1.001e-3);
  Springs smooth = cell.springs;
  smooth.friction = 0.0;
  setSprings(cell, smooth);
  const Stress before = stress(cell);
  for (int k = 0; k < 200; ++k) deform(cell, plane(1, 0.005, 0, 1));
  EXPECT_NEAR(cell.state.F(0, 1), 1.0, 1e-12);
  EXPECT_LT(std::abs(cell.state.lattice.period[1].x), 0.51 * 12e-3);
  // Sheared by one, a square lattice of grains is itself.
  EXPECT_LT((stress(cell).cauchy - before.cauchy).norm(), 1e-9 * before.cauchy.norm());
}

TEST(Motion, PathsTellHowFastTheyWereAndEndWhereTheyShall) {
  Rve cell = pressedDiscs(60);
  const Eigen::Matrix3d F = plane(1.002, 0.003, -0.001, 0.996);
  const PathReport report = followPath(cell, F, {.inertialNumber = 1e-3, .rest = {.tolerance = 1e-6}});
  EXPECT_LT((cell.state.F - F).norm(), 1e-14);
  EXPECT_TRUE(report.rest.atRest);
  EXPECT_LT(report.kineticFraction, 1e-2);
  EXPECT_GT(report.steps, 10);
  EXPECT_EQ(kineticEnergy(cell), 0.0);
  EXPECT_LT(stress(cell).asymmetry, 1e-5);
}

TEST(Motion, StepsAboveTheCriticalOneAreRefused) {
  Rve cell = pressedDiscs(40);
  const CellState before = cell.state;
  for (const double dt : {1.01 * before.criticalStep, 0.0, -1e-9, std::nan("")})
    EXPECT_THROW(step(cell, dt), InputError);
  EXPECT_EQ(cell.state.v, before.v);
  step(cell, before.criticalStep);
}

TEST(Motion, CollisionsOfFewGrainsLoseEnergy) {
  // Five discs in a row with gaps as wide as they are, at the steps and with the damping of cells in solids.
  constexpr double d = 2e-3;
  Grains row;
  for (int i = 0; i < 5; ++i) row.centre.push_back({2.0 * d * i, 0.0, 0.0});
  row.radius.assign(5, 0.5 * d);
  const Rve still = makeRve(row, {{Vec3{10.0 * d, 0, 0}, Vec3{0, 5.0 * d, 0}, Vec3{0, 0, 1}}, {true, true, false}},
                            {.stiffness = 1e4, .tangential = 0.0, .friction = 0.0});
  std::mt19937 random(1);
  for (int trial = 0; trial < 4; ++trial) {
    Rve cell = still;
    cell.state.v[0] = randomMotion(cell.state.v, 1.0, random)[0];
    const double before = kineticEnergy(cell);
    for (int k = 0; k < 3000; ++k) step(cell, 0.8 * cell.state.criticalStep, Eigen::Matrix3d::Identity(), 0.1);
    EXPECT_LT(kineticEnergy(cell) + storedEnergy(cell), 0.7 * before) << trial;
  }
}

TEST(Motion, PathsThatCannotBeGoneAreRefused) {
  Rve cell = pressedDiscs(40);
  EXPECT_THROW(followPath(cell, plane(1.06, 0, 0, 1)), InputError);
  EXPECT_THROW(followPath(cell, plane(1, 0, 0, -1)), InputError);
  EXPECT_THROW(followPath(cell, 1.01 * Eigen::Matrix3d::Identity()), InputError);
  EXPECT_THROW(followPath(cell, plane(1.01, 0, 0, 1), {.inertialNumber = 0.1}), InputError);
  EXPECT_THROW(followPath(cell, plane(1.01, 0, 0, 1), {.damping = 1.0}), InputError);
  EXPECT_THROW(relax(cell, {.tolerance = 0.0}), InputError);
  EXPECT_THROW(relax(cell, {}, 1.5), InputError);
}

}  // namespace
}  // namespace dovetail::rve
