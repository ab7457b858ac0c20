#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/model/constraints.hpp"
#include "helpers.hpp"

namespace dovetail::fem {
namespace {

Nodes nodesAtRest() { return makeModel(boxOf(ElementShape::hex8, {2, 1, 1}, {}, {2.0, 1.0, 1.0})).nodes; }

std::string messageOf(const Constraints& constraints, const Nodes& nodes) {
  try {
    DofMap map(constraints, nodes);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

Constraints manyConstraints() {
  Constraints c;
  c.hold(std::array{0, 1});
  c.hold(std::array{1, 2}, componentX);
  c.prescribe(std::array{5}, 1, [](double t) { return 0.5 * t * t; });
  c.ties.push_back({8, 2, {{7, 0, 0.25}, {6, 1, -1.5}, {5, 1, 2.0}, {0, 0, 3.0}}, 0.125, {}});
  c.ties.push_back({9, 0, {{7, 0, 0.5}, {10, 2, 0.5}}, 0.0, [](double t) { return 2.0 * t; }});
  return c;
}

double product(std::span<const double> a, std::span<const double> b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

TEST(Constraints, MotionAndForcesGoThroughAdjointMaps) {
  Nodes nodes = nodesAtRest();
  fix(nodes, std::array{11}, componentY);
  const DofMap map(manyConstraints(), nodes);
  EXPECT_EQ(map.size(), 36u - 1u - 7u - 1u - 2u);
  EXPECT_TRUE(map.hasTies());
  std::mt19937 random(3);
  std::uniform_real_distribution<double> value(-1.0, 1.0);
  for (unsigned seed = 1; seed < 20; ++seed) {
    std::vector<double> dq(map.size()), r(map.size());
    for (double& q : dq) q = value(random);
    std::vector<Vec3> f(nodes.u.size()), du(nodes.u.size());
    setRandom(f, 1.0, seed);
    map.addIncrement(dq, du);
    map.reduce(f, r);
    double work = 0.0;
    for (std::size_t n = 0; n < f.size(); ++n) work += dot(f[n], du[n]);
    EXPECT_NEAR(product(r, dq), work, 1e-13);
  }
}

TEST(Constraints, FreeRowsAndFreeComponentsAreInverse) {
  const Nodes nodes = nodesAtRest();
  const DofMap map(manyConstraints(), nodes);
  for (std::size_t i = 0; i < map.size(); ++i)
    EXPECT_EQ(map.freeRow()[static_cast<std::size_t>(map.freeDofs()[i])], static_cast<int>(i));
  EXPECT_EQ(map.freeRow()[3 * 5 + 1], -1);
  EXPECT_EQ(map.freeRow()[3 * 8 + 2], -1);
}

TEST(Constraints, PrescribedAndTiedComponentsFollowTheirEquations) {
  Nodes nodes = nodesAtRest();
  fix(nodes, std::array{11}, componentY);
  const DofMap map(manyConstraints(), nodes);
  std::vector<Vec3> u(nodes.u.size());
  setRandom(u, 1.0, 8);
  const std::vector<Vec3> before = u;
  map.apply(3.0, u);
  EXPECT_EQ(u[1], Vec3{});
  EXPECT_EQ(u[2].x, 0.0);
  EXPECT_EQ(u[2].y, before[2].y);
  EXPECT_EQ(u[11].y, before[11].y);
  EXPECT_DOUBLE_EQ(u[5].y, 4.5);
  EXPECT_DOUBLE_EQ(u[8].z, 0.25 * u[7].x - 1.5 * u[6].y + 2.0 * 4.5 + 0.125);
  EXPECT_DOUBLE_EQ(u[9].x, 0.5 * u[7].x + 0.5 * u[10].z + 6.0);
}

TEST(Constraints, VelocitiesFollowTheRatesOfTheEquations) {
  const Nodes nodes = nodesAtRest();
  const DofMap map(manyConstraints(), nodes);
  std::vector<Vec3> v(nodes.u.size());
  setRandom(v, 1.0, 9);
  map.applyVelocity(3.0, 0.25, v);
  EXPECT_EQ(v[0], Vec3{});
  EXPECT_DOUBLE_EQ(v[5].y, 3.0);
  EXPECT_DOUBLE_EQ(v[8].z, 0.25 * v[7].x - 1.5 * v[6].y + 2.0 * 3.0);
  EXPECT_DOUBLE_EQ(v[9].x, 0.5 * v[7].x + 0.5 * v[10].z + 2.0);
  map.applyVelocity(3.0, 0.0, v);
  EXPECT_EQ(v[5].y, 0.0);
}

TEST(Constraints, IncrementsKeepTheTies) {
  const Nodes nodes = nodesAtRest();
  const DofMap map(manyConstraints(), nodes);
  std::vector<Vec3> u(nodes.u.size());
  map.apply(1.0, u);
  std::vector<double> dq(map.size());
  for (std::size_t i = 0; i < dq.size(); ++i) dq[i] = 0.01 * static_cast<double>(i);
  map.addIncrement(dq, u);
  std::vector<Vec3> again = u;
  map.apply(1.0, again);
  for (std::size_t n = 0; n < u.size(); ++n) EXPECT_LT(norm(u[n] - again[n]), 1e-14);
}

TEST(Constraints, ConflictsAreRefusedByName) {
  Nodes nodes = nodesAtRest();
  Constraints twice;
  twice.hold(std::array{3}, componentZ);
  twice.prescribe(std::array{3}, 2, [](double t) { return t; });
  EXPECT_NE(messageOf(twice, nodes).find("component z of node 3 is constrained twice: held and prescribed"),
            std::string::npos);
  Constraints tied;
  tied.ties.push_back({4, 1, {{5, 1, 1.0}}, 0.0, {}});
  tied.ties.push_back({6, 1, {{4, 1, 1.0}}, 0.0, {}});
  EXPECT_NE(messageOf(tied, nodes).find("component y of node 4 is tied and a master of component y of node 6"),
            std::string::npos);
  Constraints fixed;
  fixed.hold(std::array{7}, componentX);
  fix(nodes, std::array{7}, componentX);
  EXPECT_EQ(DofMap(fixed, nodes).size(), 3 * nodes.u.size() - 1);  // at rest both say the same
  nodes.v[7].x = 0.1;
  EXPECT_NE(messageOf(fixed, nodes).find("component x of node 7 is constrained twice: fixed and held"),
            std::string::npos);
}

TEST(Constraints, NumbersOutOfRangeAreRefused) {
  const Nodes nodes = nodesAtRest();
  Constraints c;
  EXPECT_THROW(c.hold(std::vector<int>{}), InputError);
  EXPECT_THROW(c.hold(std::array{1}, 8), InputError);
  EXPECT_THROW(c.prescribe(std::array{1}, 3, [](double) { return 0.0; }), InputError);
  EXPECT_THROW(c.prescribe(std::array{1}, 0, {}), InputError);
  c.hold(std::array{12}, componentX);
  EXPECT_NE(messageOf(c, nodes).find("node 12 does not exist"), std::string::npos);
  Constraints master;
  master.ties.push_back({1, 0, {{-1, 0, 1.0}}, 0.0, {}});
  EXPECT_NE(messageOf(master, nodes).find("node -1 does not exist"), std::string::npos);
}

}  // namespace
}  // namespace dovetail::fem
