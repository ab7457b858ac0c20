#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/geometry/surface_checks.hpp"
#include "dovetail/geometry/surface_topology.hpp"
#include "dovetail/geometry/triangle.hpp"

namespace dovetail::geometry {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

struct Surface {
  std::vector<Vec3> x;
  std::vector<Facet> facets;

  int vertex(const Vec3& p) {
    const auto found = std::find(x.begin(), x.end(), p);
    if (found != x.end()) return static_cast<int>(found - x.begin());
    x.push_back(p);
    return static_cast<int>(x.size()) - 1;
  }
  void quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const int i = vertex(a), j = vertex(b), k = vertex(c), l = vertex(d);
    facets.push_back({i, j, k});
    facets.push_back({i, k, l});
  }
};

/// Surface of the box [0, n]³, every face cut into n × n squares of two facets; normals outward.
Surface box(int n) {
  Surface s;
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side)
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const auto corner = [&](int u, int v) {
            Vec3 p;
            p[axis] = side * n;
            p[(axis + 1) % 3] = i + u;
            p[(axis + 2) % 3] = j + v;
            return p;
          };
          if (side == 1)
            s.quad(corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1));
          else
            s.quad(corner(0, 0), corner(0, 1), corner(1, 1), corner(1, 0));
        }
  return s;
}

/// Two triangles over the edge (0,0,0)–(0,1,0), the second one bent down by `angle` (a ridge for angle > 0).
Surface hinge(double angle) {
  Surface s;
  s.x = {{0, 0, 0}, {0, 1, 0}, {-1, 0.3, 0}, {std::cos(angle), 0.6, -std::sin(angle)}};
  s.facets = {{0, 1, 2}, {1, 0, 3}};
  return s;
}

int patches(const Surface& s, double sharpAngle) {
  const auto patch = smoothPatches(s.x, s.facets, makeTopology(s.facets, static_cast<int>(s.x.size())), sharpAngle);
  return *std::max_element(patch.begin(), patch.end()) + 1;
}

template <class Call>
std::string inputError(Call&& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(SurfaceTopology, NeighboursOfAClosedBoxAreMutualAndComplete) {
  const Surface s = box(3);
  const auto t = makeTopology(s.facets, static_cast<int>(s.x.size()));
  ASSERT_EQ(s.facets.size(), 108u);
  ASSERT_EQ(s.x.size(), 56u);
  for (int f = 0; f < 108; ++f)
    for (int k = 0; k < 3; ++k) {
      const int other = t.neighbours[static_cast<std::size_t>(f)][static_cast<std::size_t>(k)];
      ASSERT_GE(other, 0);
      const int back = sharedEdge(s.facets, f, k, other);
      ASSERT_GE(back, 0);
      EXPECT_EQ(t.neighbours[static_cast<std::size_t>(other)][static_cast<std::size_t>(back)], f);
    }
  EXPECT_TRUE(checkSurface(s.x, s.facets).closedAndOriented());
}

TEST(SurfaceTopology, FacetsAtAVertexAreThoseThatNameIt) {
  const Surface s = box(2);
  const auto t = makeTopology(s.facets, static_cast<int>(s.x.size()) + 1);  // the last vertex has no facet
  for (int v = 0; v <= static_cast<int>(s.x.size()); ++v) {
    std::vector<int> expected;
    for (std::size_t f = 0; f < s.facets.size(); ++f)
      if (std::count(s.facets[f].begin(), s.facets[f].end(), v) > 0) expected.push_back(static_cast<int>(f));
    const auto found = t.facetsAtVertex(v);
    EXPECT_EQ(std::vector<int>(found.begin(), found.end()), expected) << "vertex " << v;
  }
}

TEST(SurfaceTopology, EdgeAngleIsTheBendAndItsSignTheSense) {
  for (double angle : {-179.0, -90.0, -30.0, -1e-5, 1e-5, 45.0, 90.0, 120.0, 179.0}) {
    const Surface s = hinge(angle * degree);
    const auto t = makeTopology(s.facets, 4);
    EXPECT_NEAR(edgeAngle(s.x, s.facets, 0, 0, t), angle * degree, 1e-15 * 180);
    EXPECT_NEAR(edgeAngle(s.x, s.facets, 1, 0, t), angle * degree, 1e-15 * 180);
  }
  const Surface flat = hinge(0.0);
  EXPECT_EQ(edgeAngle(flat.x, flat.facets, 0, 0, makeTopology(flat.facets, 4)), 0.0);
}

TEST(SurfaceTopology, AFlippedNeighbourDoesNotChangeTheAngle) {
  Surface s = hinge(50.0 * degree);
  std::swap(s.facets[1][1], s.facets[1][2]);
  const auto t = makeTopology(s.facets, 4);
  EXPECT_EQ(t.neighbours[0][0], 1);
  EXPECT_NEAR(edgeAngle(s.x, s.facets, 0, 0, t), 50.0 * degree, 1e-14);
}

TEST(SurfaceTopology, EveryEdgeOfABoxIsFlatOrARidgeOfNinetyDegrees) {
  const Surface s = box(2);
  const auto t = makeTopology(s.facets, static_cast<int>(s.x.size()));
  int ridges = 0;
  for (int f = 0; f < static_cast<int>(s.facets.size()); ++f)
    for (int k = 0; k < 3; ++k) {
      const double angle = edgeAngle(s.x, s.facets, f, k, t);
      EXPECT_TRUE(angle == 0.0 || std::abs(angle - 90.0 * degree) < 1e-15) << angle;
      ridges += angle > 0.0 ? 1 : 0;
    }
  EXPECT_EQ(ridges, 2 * 12 * 2);  // twelve box edges of two segments, each seen from both sides
}

TEST(SurfaceTopology, ABoxHasSixPatchesBelowNinetyDegreesAndOneAbove) {
  const Surface s = box(3);
  EXPECT_EQ(patches(s, 60.0 * degree), 6);
  EXPECT_EQ(patches(s, 89.9 * degree), 6);
  EXPECT_EQ(patches(s, 90.1 * degree), 1);
  const auto patch = smoothPatches(s.x, s.facets, makeTopology(s.facets, static_cast<int>(s.x.size())), 60.0 * degree);
  for (std::size_t f = 0; f < s.facets.size(); ++f) EXPECT_EQ(patch[f], static_cast<int>(f) / 18);
}

TEST(SurfaceTopology, ACubeWithAFlippedFacetKeepsItsPatchesAndIsReported) {
  Surface s = box(1);
  std::swap(s.facets[5][0], s.facets[5][1]);
  EXPECT_EQ(patches(s, 60.0 * degree), 6);
  const auto defects = checkSurface(s.x, s.facets);
  EXPECT_FALSE(defects.closedAndOriented());
  EXPECT_EQ(defects.flipped.size(), 6u);
  std::multiset<int> facets;
  for (const auto& edge : defects.flipped) facets.insert(edge[0]);
  EXPECT_EQ(facets.count(5), 3u);
  EXPECT_TRUE(defects.boundary.empty() && defects.nonManifold.empty());
}

TEST(SurfaceTopology, HolesAndFinsAreReportedAndHaveNoNeighbour) {
  Surface s = box(1);
  s.facets.pop_back();
  EXPECT_EQ(checkSurface(s.x, s.facets).boundary.size(), 3u);
  s = box(1);
  s.x.push_back({0.5, -1.0, 2.0});
  s.facets.push_back({s.facets[0][0], s.facets[0][1], 8});
  const auto defects = checkSurface(s.x, s.facets);
  EXPECT_EQ(defects.nonManifold.size(), 3u);
  EXPECT_EQ(defects.nonManifold.front(), (std::array<int, 2>{0, 0}));
  EXPECT_EQ(defects.boundary.size(), 2u);
  const auto t = makeTopology(s.facets, 9);
  EXPECT_EQ(t.neighbours[0][0], -1);
  EXPECT_NE(inputError([&] { edgeAngle(s.x, s.facets, 0, 0, t); }).find("facet 0"), std::string::npos);
}

TEST(SurfaceTopology, BadFacetsAreReportedByNumber) {
  const std::vector<Vec3> x{{0, 0, 0}, {1, 0, 0}, {0.4, 0, 0}, {0.5, 1e-9, 0}, {0, 1, 0}, {0, 0, 0}};
  const std::vector<Facet> facets{{0, 1, 4}, {0, 1, 2}, {0, 1, 3}, {1, 4, 1}, {0, 5, 4}};
  const auto defects = checkSurface(x, facets);
  EXPECT_EQ(defects.zeroArea, (std::vector<int>{1, 4}));
  EXPECT_EQ(defects.needle, (std::vector<int>{2}));
  EXPECT_EQ(defects.repeatedVertex, (std::vector<int>{3}));
  EXPECT_TRUE(checkSurface(x, facets, 1e-10).needle.empty());
}

TEST(SurfaceTopology, AFacetWithoutAreaDoesNotBridgeASharpEdge) {
  Surface s = hinge(90.0 * degree);  // a sliver is wedged into the edge: 0–4–1 with vertex 4 on the edge
  s.x.push_back({0, 0.5, 0});
  s.facets = {{0, 1, 2}, {1, 0, 4}, {4, 0, 3}, {1, 4, 3}};
  EXPECT_EQ(patches(s, 60.0 * degree), 3);
}

TEST(SurfaceTopology, BadInputNamesTheFacet) {
  const std::vector<Facet> outside{{0, 1, 2}, {0, 1, 3}}, negative{{0, -1, 2}},
      repeated{{0, 1, 2}, {0, 1, 2}, {2, 1, 2}};
  EXPECT_NE(inputError([&] { makeTopology(outside, 3); }).find("facet 1"), std::string::npos);
  EXPECT_NE(inputError([&] { makeTopology(negative, 3); }).find("facet 0"), std::string::npos);
  EXPECT_NE(inputError([&] { makeTopology(repeated, 3); }).find("facet 2"), std::string::npos);
  EXPECT_TRUE(makeTopology({}, 0).neighbours.empty());
}

}  // namespace
}  // namespace dovetail::geometry
