// A sphere on triangles: what the triangulation must not show.
#include <gtest/gtest.h>

#include <numbers>

#include "dovetail/core/error.hpp"
#include "wall_scenes.hpp"

namespace dovetail::dem {
namespace {

constexpr double radius = 0.5, stiffness = 2e3, pi = std::numbers::pi;

void expectPlane(const Response& response, double height, std::size_t vertices) {
  const double overlap = radius - height;
  ASSERT_EQ(response.contacts.size(), 1u);
  EXPECT_NEAR(response.force.z, stiffness * overlap, 1e-10 * stiffness * overlap);
  EXPECT_NEAR(std::hypot(response.force.x, response.force.y), 0.0, 1e-10 * stiffness * overlap);
  EXPECT_NEAR(response.energy, 0.5 * stiffness * overlap * overlap, 1e-10 * stiffness * overlap * overlap);
  ASSERT_EQ(response.onWall.size(), vertices);
}

TEST(WallEdges, AFanOfCoplanarTrianglesIsAPlaneWhateverItsNumberAndWinding) {
  Random random(1);
  for (int n = 3; n <= 12; ++n)
    for (const bool flipped : {false, true})
      for (const double depth : {1e-5, 1e-3, 0.1, 0.6, 0.95}) {
        std::vector<Vec3> x{{}};
        std::vector<geometry::Facet> facets;
        for (int k = 0; k < n; ++k) {
          const double angle = 2.0 * pi * k / n + random(-0.1, 0.1);
          x.push_back({3.0 * std::cos(angle), 3.0 * std::sin(angle), 0.0});
          const int a = k + 1, b = (k + 1) % n + 1;
          facets.push_back(flipped && k % 2 == 0 ? geometry::Facet{0, b, a} : geometry::Facet{0, a, b});
        }
        const auto wall = makeWall(x, facets);
        for (int trial = 0; trial < 20; ++trial) {
          const double off = trial == 0 ? 0.0 : 0.3 * trial / 20;
          const double height = radius * (1.0 - depth);
          expectPlane(respond(wall, {random(-off, off), random(-off, off), height}, radius, stiffness), height,
                      x.size());
        }
      }
}

TEST(WallEdges, FacetsOfAnySizeMakeThePlane) {
  Random random(2);
  for (const double size : {0.1 * radius, radius, 10.0 * radius})
    for (const bool oneSided : {false, true}) {
      const int n = size < radius ? 30 : 3;
      const auto wall = squares(n, n, size, oneSided);
      for (int trial = 0; trial < 60; ++trial) {
        const double height = radius * (1.0 - random(1e-4, 0.9)), middle = 0.5 * n * size;
        // Every third on an edge, every third on a vertex.
        const double reach = 0.4 * size, x = trial % 3 == 0 ? middle : middle + random(-reach, reach);
        const double y = trial % 3 <= 1 ? middle : middle + random(-reach, reach);
        expectPlane(respond(wall, {x, y, height}, radius, stiffness), height, wall.x.size());
      }
    }
}

TEST(WallEdges, AConvexEdgeGivesOneContactAlongTheNearestLine) {
  const auto wall = fold(-1.2, 3.0);
  Random random(3);
  for (int trial = 0; trial < 100; ++trial) {
    const double tilt = random(-1.1, -0.1), overlap = random(1e-4, 0.1) * radius, y = random(-1.0, 1.0);
    const Vec3 normal{std::sin(tilt), 0.0, std::cos(tilt)};
    const auto response = respond(wall, (radius - overlap) * normal + Vec3{0, y, 0}, radius, stiffness);
    ASSERT_EQ(response.contacts.size(), 1u);
    EXPECT_NEAR(norm(response.force - stiffness * overlap * normal), 0.0, 1e-12 * stiffness * radius);
  }
}

TEST(WallEdges, ARightAngledCornerAddsBothFaceForces) {
  const auto wall = fold(0.5 * pi, 3.0);
  const double a = 0.01 * radius, b = 0.003 * radius;
  const auto response = respond(wall, {radius - a, 0.2, radius - b}, radius, stiffness);
  ASSERT_EQ(response.contacts.size(), 2u);
  EXPECT_NEAR(response.force.x, stiffness * a, 1e-12 * stiffness * radius);
  EXPECT_NEAR(response.force.z, stiffness * b, 1e-12 * stiffness * radius);
  EXPECT_NEAR(response.energy, 0.5 * stiffness * (a * a + b * b), 1e-12 * stiffness);
}

/// The sphere stays and the left wall oscillations; returns the largest change of force per angle, N/rad.
double steepest(EdgeRule rule, double from, double to, int steps) {
  double largest = 0.0;
  Vec3 before;
  for (int i = 0; i <= steps; ++i) {
    const double bend = from + (to - from) * i / steps;
    const Vec3 force = respond(fold(bend, 3.0), {0.2 * radius, 0.2, 0.8 * radius}, radius, stiffness, rule).force;
    if (i > 0) largest = std::max(largest, norm(force - before) * steps / (to - from));
    before = force;
  }
  return largest;
}

TEST(WallEdges, AConcaveCornerPassesContinuouslyThroughFlat) {
  const double coarse = steepest(EdgeRule::projected, -0.3, 0.6, 1000);
  EXPECT_LE(coarse, stiffness * radius);  // the wall within reach moves by less than R per radian
  EXPECT_LE(steepest(EdgeRule::projected, -0.3, 0.6, 10000), 1.02 * coarse);
  // The rule of the paper jumps when the second face comes into play: the finer the sweep, the steeper.
  EXPECT_GT(steepest(EdgeRule::paper, -0.3, 0.6, 10000), 5.0 * steepest(EdgeRule::paper, -0.3, 0.6, 1000));
}

TEST(WallEdges, TheForceIsLipschitzAlongAnyPath) {
  // A projection moves no faster than the point that is projected; convex edges bend the bound by overlap/R.
  Random random(4);
  auto wall = squares(8, 8, 0.25);
  for (Vec3& x : wall.x) x.z += random(-0.05, 0.05);
  double largest = 0.0;
  for (int path = 0; path < 20; ++path) {
    const Vec3 from{random(0.6, 1.4), random(0.6, 1.4), 0.52}, step = 2e-5 * random.vector(1.0);
    Vec3 before;
    for (int i = 0; i <= 500; ++i) {
      const Vec3 force = respond(wall, from + static_cast<double>(i) * step, radius, stiffness).force;
      if (i > 0) largest = std::max(largest, norm(force - before) / norm(step));
      before = force;
    }
  }
  EXPECT_LE(largest, 1.25 * stiffness);
  EXPECT_GE(largest, 0.5 * stiffness);  // some path did touch
}

TEST(WallEdges, DegenerateFacetsActAsEdges) {
  const double height = 0.99 * radius;
  // A plane of two facets with a seam of slivers between: zero area, coincident vertices, a needle.
  const std::vector<Vec3> x{{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}, {0, 0, 0}, {0, 0, 0}, {1e-9, 1e-13, 0}};
  for (const bool oneSided : {false, true}) {
    const auto wall = makeWall(x, {{0, 1, 2}, {0, 2, 3}, {0, 4, 2}, {0, 5, 4}, {4, 5, 6}, {0, 6, 2}}, oneSided);
    for (const Vec3& at : {Vec3{0, 0, height}, Vec3{0.3, 0.3, height}, Vec3{0.1, -0.2, height}})
      expectPlane(respond(wall, at, radius, stiffness), height, x.size());
  }
  // Alone, a facet without area is an edge.
  const auto line = makeWall({{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}}, {{0, 1, 2}});
  EXPECT_NEAR(norm(respond(line, {0.2, 0.0, height}, radius, stiffness).force - Vec3{0, 0, stiffness * 0.01 * radius}),
              0.0, 1e-10 * stiffness);
  EXPECT_THROW(makeWall({{}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 1}}), InputError);
  EXPECT_THROW(makeWall({{}, {1, 0, 0}, {0, NAN, 0}}, {{0, 1, 2}}), InputError);
}

TEST(WallEdges, ACentreOnTheWallHasADefinedForce) {
  const auto wall = squares(2, 2, 2.0);
  for (const Vec3& at : {Vec3{2.0, 2.0, 0.0}, Vec3{2.0, 2.3, 0.0}, Vec3{2.3, 2.6, 0.0}}) {
    const auto response = respond(wall, at, radius, stiffness);
    EXPECT_TRUE(isFinite(response.force));
    EXPECT_NEAR(response.force.z, stiffness * radius, 1e-9 * stiffness);
  }
}

TEST(WallEdges, AOneSidedWallPushesOutFromBelowDownToOneRadius) {
  const auto skin = squares(4, 4, 0.3, true), sheet = squares(4, 4, 0.3, false);
  for (const double depth : {0.01, 0.3, 0.95})
    for (const double x : {0.6, 0.63})  // on an edge, in a face
      expectPlane(respond(skin, {x, 0.65, -depth * radius}, radius, stiffness), -depth * radius, skin.x.size());
  // Below the edge of a valley, where no face is nearest.
  EXPECT_NEAR(respond(fold(0.2, 2.0, true), {-0.01, 0.2, -0.1}, radius, stiffness).force.z, stiffness * (radius + 0.1),
              0.02 * stiffness * radius);
  // Beside and below the rim of an open surface there is nothing.
  EXPECT_EQ(respond(skin, {-0.1, 0.65, -0.1}, radius, stiffness).contacts.size(), 0u);
  EXPECT_EQ(respond(skin, {0.6, 0.65, -1.01 * radius}, radius, stiffness).contacts.size(), 0u);
  EXPECT_LT(respond(sheet, {0.6, 0.65, -0.9 * radius}, radius, stiffness).force.z, 0.0);
}

TEST(WallEdges, ThePapersRuleKeepsAllFacesOrTheLargest) {
  const double overlap = 0.01 * radius;
  // Flat: one contact. Right angle: two faces, each weighted by its half.
  EXPECT_EQ(respond(fold(0.0, 3.0), {0.1, 0.2, radius - overlap}, radius, stiffness, EdgeRule::paper).contacts.size(),
            1u);
  const auto corner =
      respond(fold(0.5 * pi, 3.0), {radius - overlap, 0.2, radius - overlap}, radius, stiffness, EdgeRule::paper);
  ASSERT_EQ(corner.contacts.size(), 2u);
  EXPECT_NEAR(corner.force.x, 0.5 * stiffness * overlap, 1e-12 * stiffness);
  EXPECT_NEAR(corner.force.z, 0.5 * stiffness * overlap, 1e-12 * stiffness);
}

}  // namespace
}  // namespace dovetail::dem
