#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "dovetail/geometry/triangle.hpp"

namespace dovetail::geometry {
namespace {

using Triangle = std::array<Vec3, 3>;

class Random {
public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  Vec3 vector(double size) { return {uniform(-size, size), uniform(-size, size), uniform(-size, size)}; }

private:
  std::mt19937_64 engine_;
};

Vec3 at(const Triangle& t, const std::array<double, 3>& w) { return w[0] * t[0] + w[1] * t[1] + w[2] * t[2]; }

/// Least value on [0, 1] of a convex function, by ternary search.
template <class Function>
double leastValue(Function&& f) {
  double low = 0.0, high = 1.0;
  for (int i = 0; i < 100; ++i) {
    const double s = low + (high - low) / 3.0, t = high - (high - low) / 3.0;
    if (f(s) < f(t))
      high = t;
    else
      low = s;
  }
  return f(0.5 * (low + high));
}

double distanceToSegment(const Vec3& p, const Vec3& a, const Vec3& b) {
  return leastValue([&](double s) { return norm(p - (a + s * (b - a))); });
}

/// Over all segments of the triangle parallel to its edge v2v0: convex, as the partial minimum of a convex function.
double bruteForceDistance(const Vec3& p, const Triangle& t) {
  return leastValue([&](double s) { return distanceToSegment(p, t[0] + s * (t[1] - t[0]), t[2] + s * (t[1] - t[2])); });
}

void expectValid(const ClosestPoint& r, const Triangle& t, double size) {
  double sum = 0.0;
  for (double w : r.barycentric) {
    ASSERT_TRUE(std::isfinite(w));
    EXPECT_GE(w, 0.0);
    sum += w;
  }
  EXPECT_NEAR(sum, 1.0, 4e-16);
  EXPECT_LE(norm(at(t, r.barycentric) - r.point), 1e-15 * size);
  const auto& w = r.barycentric;
  const auto count = static_cast<int>(w[0] != 0.0) + static_cast<int>(w[1] != 0.0) + static_cast<int>(w[2] != 0.0);
  if (isVertex(r.feature)) {
    EXPECT_EQ(w[static_cast<std::size_t>(r.feature) - static_cast<std::size_t>(Feature::vertex0)], 1.0);
    EXPECT_EQ(count, 1);
  }
  if (isEdge(r.feature)) {
    const auto k = static_cast<std::size_t>(r.feature) - static_cast<std::size_t>(Feature::edge0);
    EXPECT_EQ(w[(k + 2) % 3], 0.0);
  }
}

/// A state with a known answer: a point of the feature plus an offset into the feature's Voronoi region.
struct State {
  Triangle triangle;
  Vec3 p;
  std::array<double, 3> weights;
  Feature feature;
};

State stateIn(Feature feature, Random& random) {
  State s{};
  for (Vec3& v : s.triangle) v = random.vector(1.0);
  const auto& t = s.triangle;
  const Vec3 n = triangleNormal(t[0], t[1], t[2]);
  s.feature = feature;
  const double height = random.uniform(-2.0, 2.0);
  if (feature == Feature::face) {
    const double a = random.uniform(0.05, 0.9), b = random.uniform(0.02, 0.95 - a);
    s.weights = {a, b, 1.0 - a - b};
    s.p = at(t, s.weights) + height * n;
  } else if (isEdge(feature)) {
    const auto k = static_cast<std::size_t>(feature) - static_cast<std::size_t>(Feature::edge0);
    const Vec3 outward = normalized(cross(t[(k + 1) % 3] - t[k], n));
    const double u = random.uniform(0.01, 0.99);
    s.weights[k] = 1.0 - u;
    s.weights[(k + 1) % 3] = u;
    s.p = at(t, s.weights) + random.uniform(0.01, 2.0) * outward + height * n;
  } else {
    const auto k = static_cast<std::size_t>(feature) - static_cast<std::size_t>(Feature::vertex0);
    // The normal cone of the vertex is spanned by the outward normals of its two edges.
    const Vec3 before = normalized(cross(t[k] - t[(k + 2) % 3], n)),
               after = normalized(cross(t[(k + 1) % 3] - t[k], n));
    s.weights[k] = 1.0;
    s.p = t[k] + random.uniform(0.01, 1.0) * before + random.uniform(0.01, 1.0) * after + height * n;
  }
  return s;
}

TEST(Triangle, KnownClosestPointsInAllSevenRegions) {
  Random random(1);
  for (int f = 0; f < 7; ++f)
    for (int trial = 0; trial < 2000; ++trial) {
      const State s = stateIn(static_cast<Feature>(f), random);
      const auto& t = s.triangle;
      const double shape = norm(triangleAreaNormal(t[0], t[1], t[2])) / longestEdgeSquared(t[0], t[1], t[2]);
      const ClosestPoint r = closestPointOnTriangle(s.p, t[0], t[1], t[2]);
      EXPECT_EQ(static_cast<int>(r.feature), f) << "trial " << trial;
      EXPECT_LE(norm(r.point - at(t, s.weights)), 1e-14 / shape);
      expectValid(r, t, 1.0);
    }
}

TEST(Triangle, DistanceEqualsBruteForceMinimisation) {
  Random random(2);
  std::array<int, 7> visits{};
  for (int trial = 0; trial < 400; ++trial) {
    const Triangle t{random.vector(1.0), random.vector(1.0), random.vector(1.0)};
    const Vec3 p = random.vector(1.5);
    const ClosestPoint r = closestPointOnTriangle(p, t[0], t[1], t[2]);
    ++visits[static_cast<std::size_t>(r.feature)];
    EXPECT_NEAR(norm(p - r.point), bruteForceDistance(p, t), 1e-8) << "trial " << trial;
    expectValid(r, t, 1.0);
  }
  for (std::size_t f = 0; f < 7; ++f) EXPECT_GT(visits[f], 10) << "region " << f;
}

TEST(Triangle, WindingChangesNothing) {
  Random random(3);
  for (int trial = 0; trial < 1000; ++trial) {
    const Triangle t{random.vector(1.0), random.vector(1.0), random.vector(1.0)};
    const Vec3 p = random.vector(1.5);
    const double shape = norm(triangleAreaNormal(t[0], t[1], t[2])) / longestEdgeSquared(t[0], t[1], t[2]);
    const Vec3 q = closestPointOnTriangle(p, t[0], t[1], t[2]).point;
    EXPECT_LE(norm(q - closestPointOnTriangle(p, t[1], t[2], t[0]).point), 1e-14 / shape);
    EXPECT_LE(norm(q - closestPointOnTriangle(p, t[2], t[1], t[0]).point), 1e-14 / shape);
  }
}

TEST(Triangle, DegenerateOnesBehaveAsEdgesOrPoints) {
  Random random(4);
  for (int trial = 0; trial < 500; ++trial) {
    const Vec3 a = random.vector(1.0), b = random.vector(1.0), p = random.vector(1.5);
    const double s = random.uniform(0.0, 1.0);
    const Vec3 between = a + s * (b - a);
    for (const Triangle& t : {Triangle{a, b, a}, Triangle{a, a, b}, Triangle{b, a, a}, Triangle{a, b, between},
                              Triangle{between, a, b}, Triangle{a, between, b}}) {
      const ClosestPoint r = closestPointOnTriangle(p, t[0], t[1], t[2]);
      EXPECT_NE(r.feature, Feature::face);
      EXPECT_NEAR(norm(p - r.point), distanceToSegment(p, a, b), 1e-8);
      expectValid(r, t, 1.0);
    }
    const ClosestPoint r = closestPointOnTriangle(p, a, a, a);
    EXPECT_EQ(r.feature, Feature::vertex0);
    EXPECT_EQ(r.point, a);
  }
}

TEST(Triangle, NeedlesOfAnyHeightAgreeWithTheirFaceOrEdgeToOneInAHundredMillion) {
  Random random(5);
  int faces = 0, edges = 0;
  for (double height = 1e-2; height > 1e-20; height *= 0.1)
    for (int trial = 0; trial < 50; ++trial) {
      const Vec3 origin = random.vector(1.0), e = normalized(random.vector(1.0));
      const Vec3 f = normalized(cross(e, random.vector(1.0))), g = cross(e, f);
      const auto place = [&](double along, double across, double above) {
        return origin + along * e + across * f + above * g;
      };
      const Triangle cap{origin, place(1, 0, 0), place(random.uniform(0.1, 0.9), height, 0)};
      const Triangle needle{origin, place(1, -0.5 * height, 0), place(1, 0.5 * height, 0)};
      for (const Triangle& t : {cap, needle}) {
        // In, near and far from the plane: only near it does the distance feel an error in the plane to first order.
        const double above = std::array{0.0, random.uniform(-1.0, 1.0) * height,
                                        random.uniform(-1.0, 1.0)}[static_cast<std::size_t>(trial % 3)];
        const Vec3 p = place(random.uniform(-0.2, 1.2), random.uniform(-1.5, 1.5) * height, above);
        const ClosestPoint r = closestPointOnTriangle(p, t[0], t[1], t[2]);
        expectValid(r, t, 1.0);
        (r.feature == Feature::face ? faces : edges) += 1;
        EXPECT_NEAR(norm(p - r.point), bruteForceDistance(p, t), 1.5e-8) << "height " << height;
      }
    }
  EXPECT_GT(faces, 50);
  EXPECT_GT(edges, 500);
}

TEST(Triangle, AnyFiniteInputGivesFiniteOutput) {
  const double tiny = 5e-324, small = 1e-200;
  for (double size : {tiny, small, 1e-160, 1e-90, 1.0, 1e60}) {
    const ClosestPoint r = closestPointOnTriangle({size, size, size}, {0, 0, 0}, {size, 0, 0}, {0, size, 0});
    EXPECT_TRUE(isFinite(r.point));
    for (double w : r.barycentric) EXPECT_TRUE(std::isfinite(w));
  }
}

TEST(Triangle, PointsOfTheTriangleAreTheirOwnClosestPoints) {
  const Vec3 a{1, 2, 3}, b{4, 2, 3}, c{1, 6, 3};
  EXPECT_EQ(closestPointOnTriangle(a, a, b, c).feature, Feature::vertex0);
  EXPECT_EQ(closestPointOnTriangle(b, a, b, c).feature, Feature::vertex1);
  EXPECT_EQ(closestPointOnTriangle(c, a, b, c).feature, Feature::vertex2);
  EXPECT_EQ(closestPointOnTriangle({2, 2, 3}, a, b, c).feature, Feature::edge0);
  EXPECT_EQ(closestPointOnTriangle({2.5, 4, 3}, a, b, c).feature, Feature::edge1);
  EXPECT_EQ(closestPointOnTriangle({1, 3, 3}, a, b, c).feature, Feature::edge2);
  EXPECT_EQ(closestPointOnTriangle({2, 3, 3}, a, b, c).feature, Feature::face);
  EXPECT_LE(norm(closestPointOnTriangle({2, 3, 3}, a, b, c).point - Vec3{2, 3, 3}), 1e-15);
}

TEST(Triangle, NormalAndArea) {
  EXPECT_EQ(triangleNormal({0, 0, 1}, {2, 0, 1}, {0, 3, 1}), (Vec3{0, 0, 1}));
  EXPECT_EQ(triangleArea({0, 0, 1}, {2, 0, 1}, {0, 3, 1}), 3.0);
  EXPECT_EQ(triangleNormal({1, 1, 1}, {1, 1, 1}, {0, 3, 1}), Vec3{});
}

}  // namespace
}  // namespace dovetail::geometry
