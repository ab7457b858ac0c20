#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "../../src/rve/tangent/network.hpp"
#include "cells.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/rve/operators.hpp"

namespace dovetail::rve {
namespace {

// Overlaps are 1e-9 diameters, so that what contacts carry is not felt.
constexpr double radius = 0.5 * (1.0 + 1e-9), kn = 2e5, ratio = 0.7;
const Springs even{.stiffness = kn, .tangential = ratio, .friction = 1.0};

double component(const Tangent& A, int i, int J, int k, int L) { return A(3 * i + J, 3 * k + L); }

TEST(Operators, TriangularLatticeHasItsModuli) {
  Grains grains;
  for (int j = 0; j < 6; ++j)
    for (int i = 0; i < 6; ++i) grains.centre.push_back({i + 0.5 * (j % 2), 0.5 * std::sqrt(3.0) * j, 0.0});
  grains.radius.assign(36, radius);
  const double t = 0.3;
  const Rve cell =
      makeRve(grains, {{Vec3{6, 0, 0}, Vec3{0, 3.0 * std::sqrt(3.0), 0}, Vec3{0, 0, t}}, {true, true, false}}, even);
  EXPECT_EQ(balance(cell).coordination, 6.0);
  for (const Tangent& A : {elasticTangent(cell), voigtTangent(cell)}) {
    const double unit = 2.0 / (std::sqrt(3.0) * t) * kn;
    EXPECT_NEAR(component(A, 0, 0, 0, 0), unit * (9.0 / 8.0 + 3.0 / 8.0 * ratio), 1e-7 * unit);
    EXPECT_NEAR(component(A, 1, 1, 1, 1), unit * (9.0 / 8.0 + 3.0 / 8.0 * ratio), 1e-7 * unit);
    EXPECT_NEAR(component(A, 0, 0, 1, 1), unit * (3.0 / 8.0 - 3.0 / 8.0 * ratio), 1e-7 * unit);
    const double shear = component(A, 0, 1, 0, 1) + component(A, 0, 1, 1, 0);
    EXPECT_NEAR(shear, 2.0 * unit * (3.0 / 8.0 + 3.0 / 8.0 * ratio), 1e-7 * unit);
    EXPECT_NEAR(component(A, 0, 0, 0, 1), 0.0, 1e-7 * unit);
  }
}

TEST(Operators, SquareLatticeHasItsModuli) {
  Grains grains;
  for (int k = 0; k < 25; ++k) grains.centre.push_back({double(k % 5), double(k / 5), 0.0});
  grains.radius.assign(25, radius);
  const Rve cell = makeRve(grains, {{Vec3{5, 0, 0}, Vec3{0, 5, 0}, Vec3{0, 0, 1}}, {true, true, false}}, even);
  const Tangent A = elasticTangent(cell);
  EXPECT_NEAR(component(A, 0, 0, 0, 0), kn, 1e-7 * kn);
  EXPECT_NEAR(component(A, 0, 0, 1, 1), 0.0, 1e-7 * kn);
  EXPECT_NEAR(component(A, 0, 1, 0, 1) + component(A, 0, 1, 1, 0), ratio * kn, 1e-7 * kn);
}

TEST(Operators, SimpleCubicLatticeHasItsModuli) {
  Grains grains{.shape = Shape::sphere};
  for (int k = 0; k < 27; ++k) grains.centre.push_back({double(k % 3), double(k / 3 % 3), double(k / 9)});
  grains.radius.assign(27, radius);
  const Rve cell = makeRve(grains, {{Vec3{3, 0, 0}, Vec3{0, 3, 0}, Vec3{0, 0, 3}}}, even);
  for (const Tangent& A : {elasticTangent(cell), voigtTangent(cell)})
    for (int k = 0; k < 3; ++k) {
      const int l = (k + 1) % 3;
      EXPECT_NEAR(component(A, k, k, k, k), kn, 1e-7 * kn);
      EXPECT_NEAR(component(A, k, k, l, l), 0.0, 1e-7 * kn);
      EXPECT_NEAR(component(A, k, l, k, l) + component(A, k, l, l, k), ratio * kn, 1e-7 * kn);
    }
}

void expectElasticTangentIsProbe(const Rve& cell) {
  const Tangent A = elasticTangent(cell), probe = elasticProbe(cell);
  EXPECT_LT((A - probe).norm(), 1e-4 * A.norm());
}

TEST(Operators, ElasticTangentIsTheProbeOfPressedDiscs) { expectElasticTangentIsProbe(pressedDiscs(80)); }
TEST(Operators, ElasticTangentIsTheProbeOfPressedSpheres) { expectElasticTangentIsProbe(pressedSpheres(48)); }
TEST(Operators, ElasticTangentIsTheProbeOfShearedDiscs) {
  Rve cell = pressedDiscs(80);
  followPath(cell, plane(1.003, 0.004, 0.0, 0.994), {.rest = {.tolerance = 1e-7}});
  ASSERT_GT(cell.state.ledger.friction, 0.0);
  expectElasticTangentIsProbe(cell);
}
TEST(Operators, ElasticTangentIsTheProbeOfShearedSpheres) {
  Rve cell = pressedSpheres(48);
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F(0, 1) = 2e-3;
  F(2, 2) = 0.999;
  followPath(cell, F, {.rest = {.tolerance = 1e-7}});
  expectElasticTangentIsProbe(cell);
}
TEST(Operators, ElasticTangentIsTheProbeOfRollingDiscs) {
  Rve cell = pressedDiscs(80);
  Springs rolling = cell.springs;
  rolling.rolling = 0.5;
  rolling.rollingLimit = 1e6;
  setSprings(cell, rolling);
  followPath(cell, plane(1.001, 0.001, 0.0, 0.998), {.rest = {.tolerance = 1e-7}});
  expectElasticTangentIsProbe(cell);
}

Eigen::MatrixXd inPlaneSymmetric(const Tangent& A) {
  const int at[4] = {0, 1, 3, 4};
  Eigen::MatrixXd B(4, 4);
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c) B(r, c) = 0.5 * (A(at[r], at[c]) + A(at[c], at[r]));
  return B;
}

double leastEigenvalue(const Eigen::MatrixXd& m) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(m, Eigen::EigenvaluesOnly).eigenvalues()[0];
}

TEST(Operators, UniformStrainIsStifferInEveryStretch) {
  const Rve cell = pressedDiscs(100);
  const Tangent bound = voigtTangent(cell), A = elasticTangent(cell);
  // Symmetric strains: what contacts carry makes a turn cost something.
  Eigen::MatrixXd stretches(4, 3);
  stretches << 1, 0, 0, 0, 0, 0.5, 0, 0, 0.5, 0, 1, 0;
  const Eigen::MatrixXd difference =
      stretches.transpose() * (inPlaneSymmetric(bound) - inPlaneSymmetric(A)) * stretches;
  EXPECT_GT(leastEigenvalue(difference), 0.0);
  EXPECT_GT(component(bound, 0, 0, 0, 0), 1.05 * component(A, 0, 0, 0, 0));
}

TEST(Operators, ConditionsAreStifferTheLessTheyLeaveFree) {
  // Springs alone: what a contact carries lets a frame grain with no other contact fall aside where it is free to.
  const Rve cell = pressedDiscs(120);
  const auto operatorUnder = [&](const Conditions& conditions) {
    const Rve cut = framed(cell, conditions);
    const Eigen::MatrixXd A = Network(cut, {.prestress = false}).relaxedStressByStrain();
    return Eigen::MatrixXd(0.5 * (A + A.transpose()));
  };
  const Condition d = Condition::displacement, p = Condition::periodic, t = Condition::traction;
  // Each leaves more free than the one before.
  const std::vector<std::vector<Conditions>> chains{
      {everywhere(d), everywhere(p), everywhere({p, t}), everywhere(t)},
      {everywhere(d), everywhere({d, p}), everywhere(p), everywhere({t, p}), everywhere(t)},
      {everywhere(d), everywhere({t, d}), everywhere(t)},
      {everywhere(d), layerUnder(d), layerUnder({d, t}, true), layerUnder({d, t}), layerUnder(t), everywhere(t)}};
  for (const std::vector<Conditions>& chain : chains)
    for (std::size_t k = 1; k < chain.size(); ++k) {
      const Eigen::MatrixXd stiffer = operatorUnder(chain[k - 1]), softer = operatorUnder(chain[k]);
      EXPECT_GE(leastEigenvalue(stiffer - softer), -1e-10 * stiffer.norm()) << k;
      EXPECT_GT((stiffer - softer).norm(), 1e-4 * stiffer.norm()) << k;
    }
}

TEST(Operators, ElasticTangentIsTheProbeUnderMixedConditions) {
  // Where all sides are free, probes of any size lose contacts.
  const Condition d = Condition::displacement, p = Condition::periodic, t = Condition::traction;
  for (const Conditions& conditions : {everywhere({d, p}), layerUnder({d, t}, true), layerUnder({d, t})}) {
    Rve cell = framed(pressedDiscs(80), conditions);
    followPath(cell, plane(1.0, 0.002, 0.0, 0.998), {.rest = {.tolerance = 1e-7}});
    polish(cell, 1e-10, 20);
    expectElasticTangentIsProbe(cell);
  }
}

TEST(Operators, PeriodicFramesHaveTheOperatorOfCellsThatRepeat) {
  const Rve cell = pressedDiscs(120);
  const Tangent A = elasticTangent(cell);
  EXPECT_LT((elasticTangent(framed(cell, everywhere(Condition::periodic))) - A).norm(), 1e-8 * A.norm());
}

/// Sheared until some contacts slip.
Rve slidingDiscs() {
  Rve cell = pressedDiscs(100, 4);
  Springs slippery = cell.springs;
  slippery.friction = 0.2;
  setSprings(cell, slippery);
  followPath(cell, plane(1.004, 0.0, 0.0, 0.992), {.rest = {.tolerance = 1e-6}});
  return cell;
}

TEST(Operators, SlidingSoftens) {
  const Rve cell = slidingDiscs();
  ASSERT_GT(balance(cell).sliding, 0);
  EXPECT_LT(component(frictionalTangent(cell), 1, 1, 1, 1), component(elasticTangent(cell), 1, 1, 1, 1));
}

/// Forces and moments of all contacts against their linearisation, of those that slip on and those that do not.
void expectContactsAreLinear(Rve cell, int& slipping) {
  std::mt19937 random(8);
  Springs slippery = cell.springs;
  slippery.friction = 0.05;
  setSprings(cell, slippery);
  const Components w = randomMotion(cell.state.v, 2e-4 * meanDiameter(cell), random);
  const Components theta = randomMotion(cell.state.spin, 2e-4, random);
  displace(cell, w, theta);
  const double h = 1e-6;
  const Components more = scaled(w, h), turn = scaled(theta, h);
  Rve after = cell;
  displace(after, more, turn);
  ASSERT_EQ(after.state.contacts.other, cell.state.contacts.other);
  std::vector<Touch> then(cell.state.contacts.size());
  forEachTouch(after, [&](const Touch& touch) { then[touch.contact] = touch; });
  const auto slips = [](const Rve& c, const Touch& t) {
    return norm(t.stretch) >= (1.0 - 1e-9) * slipLimit(c.springs, t);
  };
  const auto at = [](const Components& field, std::size_t i, int k) {
    const auto& component = field[static_cast<std::size_t>(k)];
    return component.empty() ? 0.0 : component[i];
  };
  forEachTouch(cell, [&](const Touch& touch) {
    const Touch& end = then[touch.contact];
    if (end.distance == 0.0 || slips(cell, touch) != slips(after, end)) return;
    slipping += slips(cell, touch) ? 1 : 0;
    Eigen::Matrix<double, 9, 1> q;
    for (int k = 0; k < 3; ++k) {
      q[k] = at(more, touch.j, k) - at(more, touch.i, k);
      q[3 + k] = at(turn, touch.i, k);
      q[6 + k] = at(turn, touch.j, k);
    }
    const Eigen::Matrix<double, 9, 1> predicted = linearised(cell, touch, {.slips = true}) * q;
    const Vec3 change = contactForce(after, end) - contactForce(cell, touch);
    const auto couple = [&](const Rve& c, const Touch& t) {
      return 0.5 * (t.distance + c.radius[t.i] - c.radius[t.j]) * cross(t.normal, contactForce(c, t));
    };
    const Vec3 turned = couple(after, end) - couple(cell, touch);
    const double size = touch.stiffness * h * 2e-4 * meanDiameter(cell);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(change[k], predicted[k], 1e-4 * size);
      EXPECT_NEAR(turned[k], predicted[3 + k], 1e-4 * size * touch.distance);
    }
  });
}

TEST(Operators, ContactsAreLinearisedSlippingOrNot) {
  for (const Rve& cell : {pressedDiscs(60), pressedSpheres(48)}) {
    int slipping = 0;
    expectContactsAreLinear(cell, slipping);
    EXPECT_GT(slipping, 10);
  }
}

TEST(Operators, ThePathProbeIsTheNetworkWhereNothingSlips) {
  Rve cell = pressedDiscs(60);
  Springs smooth = cell.springs;
  smooth.friction = 0.0;
  setSprings(cell, smooth);
  const Eigen::Matrix3d F = plane(1.0, 1e-5, 0.0, 0.9999);
  Rve after = cell;
  followPath(after, F, {.rest = {.tolerance = 1e-7}});
  const Tangent A = elasticTangent(after);
  const auto errorOf = [&](double strain) {
    return (numericalTangent(cell, F, {.strain = strain, .path = {.rest = {.tolerance = 1e-7}}}) - A).norm() / A.norm();
  };
  const double fine = errorOf(1e-6);
  EXPECT_LT(fine, 1e-3);
  EXPECT_LT(fine, 0.5 * errorOf(1e-4));
}

TEST(Operators, ThePathProbeSlips) {
  const Rve cell = slidingDiscs();
  const Eigen::Matrix3d F = plane(1.0045, 0.0, 0.0, 0.991);
  Rve after = cell;
  followPath(after, F, {.rest = {.tolerance = 1e-6}});
  ASSERT_GT(after.state.ledger.friction, cell.state.ledger.friction);
  // Less shortening: the path ends earlier, on the same branch; the network of what sticks is stiffer.
  EXPECT_LT(component(numericalTangent(cell, F, {.strain = 1e-4}), 1, 1, 1, 1),
            component(elasticTangent(after), 1, 1, 1, 1));
  EXPECT_GT((numericalTangent(cell, F, {.strain = 1e-4}) - elasticTangent(after)).norm(),
            0.02 * elasticTangent(after).norm());
}

TEST(Operators, TheFrozenMeanFreezesAtTheFirstSofteningStep) {
  AveragedTangent operators;
  int probes = 0;
  const auto probe = [&] {
    ++probes;
    return Tangent(probes * Tangent::Identity());
  };
  const auto at = [&](double strain, double stress) {
    return operators.next((1.0 + strain) * Eigen::Matrix3d::Identity(), stress * Eigen::Matrix3d::Identity(), probe)(0,
                                                                                                                     0);
  };
  EXPECT_EQ(at(0.0, 0.0), 1.0);
  EXPECT_EQ(at(0.1, 1.0), 2.0);
  EXPECT_EQ(at(0.2, 1.5), 3.0);
  EXPECT_FALSE(operators.frozen);
  EXPECT_EQ(at(0.3, 1.4), 2.0);
  EXPECT_EQ(at(0.4, 9.0), 2.0);
  EXPECT_TRUE(operators.frozen);
  EXPECT_EQ(probes, 3);
}

TEST(Operators, BadProbesAreRefused) {
  const Rve cell = squareArray(4);
  EXPECT_THROW(elasticProbe(cell, {.strain = 0.0}), InputError);
  EXPECT_THROW(elasticProbe(cell, {.unbalanced = -1.0}), InputError);
  EXPECT_THROW(numericalTangent(cell, cell.state.F, {.strain = 0.0}), InputError);
  EXPECT_THROW(numericalTangent(cell, cell.state.F, {.path = {.rest = {.tolerance = 1e-14, .steps = 20}}}),
               NumericalError);
}

}  // namespace
}  // namespace dovetail::rve
