#include <gtest/gtest.h>

#include <array>

#include "dovetail/core/error.hpp"
#include "helpers.hpp"

namespace dovetail::fem {
namespace {

Nodes someNodes() {
  Nodes nodes = makeModel(boxOf(ElementShape::hex8, {2, 1, 1}, {}, {2.0, 1.0, 1.0})).nodes;
  for (std::size_t n = 0; n < nodes.mass.size(); ++n) nodes.mass[n] = 1.0 + static_cast<double>(n);
  setRandom(nodes.v, 1.0, 3);
  setRandom(nodes.u, 1.0, 4);
  setRandom(nodes.f, 1.0, 5);
  return nodes;
}

TEST(Nodes, KickChangesTheMomentumByForceTimesTime) {
  Nodes nodes = someNodes();
  Vec3 force, torque;
  for (std::size_t n = 0; n < nodes.f.size(); ++n) {
    force += nodes.f[n];
    torque += cross(nodes.X[n] + nodes.u[n], nodes.f[n]);
  }
  const Vec3 p = momentum(nodes), l = angularMomentum(nodes);
  kick(nodes, 0.25);
  EXPECT_LT(norm(momentum(nodes) - p - 0.25 * force), 1e-14);
  EXPECT_LT(norm(angularMomentum(nodes) - l - 0.25 * torque), 1e-13);
}

TEST(Nodes, DriftMovesByVelocityTimesTimeAndKeepsTheAngularMomentum) {
  Nodes nodes = someNodes();
  const std::vector<Vec3> u = nodes.u;
  const Vec3 l = angularMomentum(nodes);
  drift(nodes, 0.5);
  for (std::size_t n = 0; n < u.size(); ++n) EXPECT_LT(norm(nodes.u[n] - u[n] - 0.5 * nodes.v[n]), 1e-15);
  EXPECT_LT(norm(angularMomentum(nodes) - l), 1e-13);
}

TEST(Nodes, KineticEnergyIsHalfMassTimesSpeedSquared) {
  Nodes nodes = someNodes();
  for (Vec3& v : nodes.v) v = {1.0, 2.0, 2.0};
  double mass = 0.0;
  for (const double m : nodes.mass) mass += m;
  EXPECT_DOUBLE_EQ(kineticEnergy(nodes), 4.5 * mass);
}

TEST(Nodes, HeldComponentsKeepTheirVelocity) {
  Nodes nodes = someNodes();
  fix(nodes, std::array{0, 2}, componentX | componentZ);
  EXPECT_EQ(nodes.v[0].x, 0.0);
  nodes.v[0].z = 3.0;
  const double y = nodes.v[0].y;
  kick(nodes, 1.0);
  EXPECT_EQ(nodes.v[0].x, 0.0);
  EXPECT_EQ(nodes.v[0].z, 3.0);
  EXPECT_DOUBLE_EQ(nodes.v[0].y, y + nodes.f[0].y / nodes.mass[0]);
}

TEST(Nodes, BadHoldsAndMissingMassAreRefused) {
  Nodes nodes = someNodes();
  EXPECT_THROW(fix(nodes, std::vector<int>{}), InputError);
  EXPECT_THROW(fix(nodes, std::array{99}), InputError);
  EXPECT_THROW(fix(nodes, std::array{0}, 0), InputError);
  EXPECT_THROW(fix(nodes, std::array{0}, 8), InputError);
  EXPECT_NO_THROW(requireMass(nodes));
  nodes.mass[5] = 0.0;
  EXPECT_THROW(requireMass(nodes), InputError);
  fix(nodes, std::array{5});
  EXPECT_NO_THROW(requireMass(nodes));
}

}  // namespace
}  // namespace dovetail::fem
