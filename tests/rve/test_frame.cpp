#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "dovetail/core/error.hpp"
#include "dovetail/rve/operators.hpp"
#include "hill_mandel.hpp"
#include "ledger.hpp"

namespace dovetail::rve {
namespace {

TEST(Frame, AreasCloseAndMeasureTheVolume) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Rve cell = framed(pressedDiscs(100, seed), everywhere(Condition::periodic));
    const Frame& frame = cell.frame;
    Vec3 sum;
    Eigen::Matrix2d volumes = Eigen::Matrix2d::Zero();
    double size = 0.0;
    for (std::size_t q = 0; q < frame.grain.size(); ++q) {
      sum += frame.area[q];
      size += norm(frame.area[q]);
      volumes +=
          Eigen::Vector2d(frame.place[q].x, frame.place[q].y) * Eigen::RowVector2d(frame.area[q].x, frame.area[q].y);
    }
    EXPECT_LT(norm(sum), 1e-12 * size);
    EXPECT_LT((volumes - cell.volume * Eigen::Matrix2d::Identity()).norm(), 1e-12 * cell.volume);
  }
}

TEST(Frame, ArraysHaveTheirStressAtFullAndHalfWeight) {
  // −σ₁₁/k_n = 0.02 n/(n − 1) with contacts along the frame at full weight (Liu 2018, Fig. 2.4), 0.02 with half of it.
  const double full[] = {0.0250, 0.0222, 0.0214};
  int k = 0;
  for (const int n : {5, 10, 15}) {
    Rve cell = framed(squareArray(n - 1), everywhere(Condition::displacement));
    ASSERT_EQ(cell.size(), static_cast<std::size_t>(n * n));
    EXPECT_NEAR(-stressOfReactions(cell)(0, 0) / 1e4, 0.02, 1e-12);
    cell.state.contacts.stiffness.assign(cell.state.contacts.size(), 1e4);
    displace(cell, cell.state.v, cell.state.spin);
    EXPECT_NEAR(-stressOfReactions(cell)(0, 0) / 1e4, full[k++], 1e-4);
  }
}

TEST(Frame, PeriodicFramesAnswerAsCellsThatRepeat) {
  Rve wrapped = pressedDiscs(100, 2);  // no contact begins or ends on the way
  // What slips depends on the last digits.
  Springs sticking = wrapped.springs;
  sticking.friction = std::numeric_limits<double>::infinity();
  setSprings(wrapped, sticking);
  Rve cut = framed(wrapped, everywhere(Condition::periodic));
  EXPECT_LT((nominalStress(cut) - nominalStress(wrapped)).norm(), 1e-12 * nominalStress(wrapped).norm());
  for (int k = 1; k <= 3; ++k) {
    const Eigen::Matrix3d F = plane(1.0 + 2e-4 * k, 3e-4 * k, 0.0, 1.0 - 4e-4 * k);
    for (Rve* cell : {&wrapped, &cut}) {
      deform(*cell, relativeDeformation(*cell, F));
      const RestReport rest = polish(*cell, 1e-11, 30);
      ASSERT_TRUE(rest.atRest) << rest.residual;
    }
    EXPECT_LT((nominalStress(cut) - nominalStress(wrapped)).norm(), 1e-9 * nominalStress(wrapped).norm());
    EXPECT_LT((stressOfReactions(cut) - nominalStress(cut)).norm(), 1e-9 * nominalStress(cut).norm());
  }
}

TEST(Frame, HillAndMandelsConditionHoldsInEverySpaceInSlidingStates) {
  std::mt19937 random(4);
  const Rve start = pressedDiscs(100, 8);
  for (const Conditions& conditions : kindsOfFrames()) {
    Rve cell = framed(start, conditions);
    // A little compression, so that no space lets the grains fall apart.
    for (int k = 1; k <= 5; ++k) followPath(cell, plane(1, 0.02 * k, 0, 1 - 0.002 * k), {.rest = {.tolerance = 1e-4}});
    const RestReport rest = relax(cell, {.tolerance = 1e-8, .steps = 40000});
    EXPECT_TRUE(rest.atRest) << rest.residual;
    EXPECT_GT(cell.state.ledger.friction, 0.0);
    for (int k = 0; k < 3; ++k) EXPECT_LT(hillMandelError(cell, random), 1e-6);
  }
}

TEST(Frame, TheLedgerOfAPathClosesInEverySpaceAsStepsShrink) {
  const Rve start = pressedDiscs(100);
  for (const Conditions& conditions : kindsOfFrames())
    expectLedgerClosesAsStepsShrink(framed(start, conditions), 3,
                                    [](int k) { return plane(1, 0.005 * k, 0, 1 - 0.002 * k); });
}

/// Mean over packings of the largest shear stress on a path to 1 % of shear under a little compression.
double meanShearStress(Condition condition) {
  double sum = 0.0;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    Rve cell = framed(pressedDiscs(100, seed), everywhere(condition));
    double most = 0.0;
    for (int k = 1; k <= 4; ++k) {
      followPath(cell, plane(1, 0.0025 * k, 0, 1 - 0.001 * k), {.rest = {.tolerance = 1e-3}});
      most = std::max(most, std::abs(stress(cell).cauchy(0, 1)));
    }
    sum += most / 5.0;
  }
  return sum;
}

TEST(Frame, MeansOfPathsAreStifferTheLessTheyLeaveFree) {
  const double D = meanShearStress(Condition::displacement), P = meanShearStress(Condition::periodic),
               T = meanShearStress(Condition::traction);
  EXPECT_GT(D, P);
  EXPECT_GT(P, T);
}

TEST(Frame, ConditionsHoldOnTheWay) {
  Rve cell = framed(pressedDiscs(100), everywhere(Condition::traction));
  // A little compression, so that grains do not fall apart.
  followPath(cell, plane(1, 0.01, 0, 0.997), {.rest = {.tolerance = 1e-9}});
  const Eigen::Matrix2d F = cell.state.F.topLeftCorner<2, 2>();
  Eigen::Matrix2d mean = Eigen::Matrix2d::Zero();
  double size = 0.0;
  for (std::size_t q = 0; q < cell.frame.grain.size(); ++q) {
    const auto g = static_cast<std::size_t>(cell.frame.grain[q]);
    const Eigen::Vector2d X(cell.frame.place[q].x, cell.frame.place[q].y),
        A(cell.frame.area[q].x, cell.frame.area[q].y), x(cell.state.x[0][g], cell.state.x[1][g]);
    mean += x * A.transpose();
    size += (x - F * X).norm() * A.norm();
  }
  EXPECT_LT((mean / cell.volume - F).norm(), 1e-12);
  EXPECT_GT(size, 1e-5 * cell.volume);
  const std::vector<Vec3> a = reactions(cell);
  const Eigen::Matrix2d P = stressOfReactions(cell).topLeftCorner<2, 2>();
  for (std::size_t q = 0; q < a.size(); ++q) {
    const Eigen::Vector2d expected = P * Eigen::Vector2d(cell.frame.area[q].x, cell.frame.area[q].y);
    EXPECT_LT(std::hypot(a[q].x - expected[0], a[q].y - expected[1]), 1e-7 * P.norm() * norm(cell.frame.area[q]));
  }
}

TEST(Frame, CopiesMoveAlikeWhateverElseTheyObey) {
  const Rve start = pressedDiscs(100);
  const double side = norm(start.state.lattice.period[0]);
  for (const Conditions& conditions : kindsOfFrames()) {
    if (conditions.left.along != Condition::periodic || conditions.left.across != Condition::periodic) continue;
    Rve cell = framed(start, conditions);
    for (int k = 1; k <= 3; ++k) followPath(cell, plane(1, 0.01 * k, 0, 1 - 0.001 * k), {.rest = {.steps = 0}});
    const Frame& frame = cell.frame;
    int pairs = 0;
    for (const std::vector<int>& group : frame.alike)
      for (const int p : group)
        for (const int q : group) {
          const auto a = static_cast<std::size_t>(p), b = static_cast<std::size_t>(q);
          const Vec3 apart = frame.place[b] - frame.place[a];
          if (std::abs(apart.x - side) > 1e-3 * side || std::abs(apart.y) > 1e-3 * side) continue;
          ++pairs;
          const auto i = static_cast<std::size_t>(frame.grain[a]), j = static_cast<std::size_t>(frame.grain[b]);
          const CellState& s = cell.state;
          const Eigen::Vector2d X(apart.x, apart.y), x(s.x[0][j] - s.x[0][i], s.x[1][j] - s.x[1][i]);
          EXPECT_LT((x - s.F.topLeftCorner<2, 2>() * X).norm(), 1e-13 * side);
          for (const std::vector<double>* v : {&s.v[0], &s.v[1], &s.spin[2]}) EXPECT_EQ((*v)[i], (*v)[j]);
        }
    EXPECT_GT(pairs, 4);
  }
}

TEST(Frame, AlongAndAcrossAreHeldApart) {
  const Condition D = Condition::displacement, T = Condition::traction;
  Rve cell = framed(pressedDiscs(100), layerUnder({D, T}, true));
  deform(cell, turned(0.5));
  followPath(cell, turned(0.5) * plane(1, 0.01, 0, 0.999), {.rest = {.steps = 0}});
  project(cell, cell.state.v, cell.state.spin);  // turned since by half the shear of a step
  const Frame& frame = cell.frame;
  const Eigen::Vector2d along = turned(0.5).col(0).head<2>();
  const auto isHeld = [&](std::size_t c, int q) {
    return std::ranges::find(frame.freedom[c].held, q) != frame.freedom[c].held.end();
  };
  double fastest = 0.0;
  int held = 0, corners = 0, moving = 0;
  for (const double v : cell.state.v[0]) fastest = std::max(fastest, std::abs(v));
  for (std::size_t q = 0; q < frame.grain.size(); ++q) {
    const auto g = static_cast<std::size_t>(frame.grain[q]);
    const Eigen::Vector2d v(cell.state.v[0][g], cell.state.v[1][g]);
    const int place = static_cast<int>(q);
    if (!isHeld(0, place)) continue;
    ++held;
    EXPECT_LT(std::abs(along.dot(v)), 1e-12 * fastest);
    moving += v.norm() > 1e-3 * fastest ? 1 : 0;
    if (!isHeld(1, place)) continue;
    ++corners;  // and the bottom
    EXPECT_LT(v.norm(), 1e-12 * fastest);
  }
  EXPECT_GT(held, corners + 5);
  EXPECT_GT(moving, 3);
  const Eigen::Matrix2d P = stressOfReactions(cell).topLeftCorner<2, 2>();
  EXPECT_TRUE(P.allFinite());
}

TEST(Frame, WhatCannotBeFramedIsRefused) {
  EXPECT_THROW(framed(pressedSpheres(48), everywhere(Condition::periodic)), InputError);
  const Rve cell = squareArray(4);
  const Rve cut = framed(cell, everywhere(Condition::periodic));
  EXPECT_THROW(framed(cut, everywhere(Condition::periodic)), InputError);
  EXPECT_THROW(framed(cell, {.bottom = Condition::displacement}), InputError);
  EXPECT_THROW(framed(cell, {.left = {Condition::traction, Condition::periodic}}), InputError);
  Rve pressed = cut;
  EXPECT_THROW(compress(pressed, {}), InputError);
}

}  // namespace
}  // namespace dovetail::rve
