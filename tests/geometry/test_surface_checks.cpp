// Predicates, self-intersections, and every defect of a surface found and, where promised, repaired.
#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "dovetail/core/error.hpp"
#include "dovetail/geometry/predicates.hpp"
#include "dovetail/geometry/surface_checks.hpp"
#include "dovetail/geometry/triangle_mesh.hpp"

namespace dovetail::geometry {
namespace {

/// The cube [0, size]³ moved by `shift`, outward normals; corner c has coordinate k = bit k of c.
TriangleMesh cube(double size = 1.0, const Vec3& shift = {}) {
  TriangleMesh mesh;
  for (int c = 0; c < 8; ++c) mesh.x.push_back(shift + size * Vec3{double(c & 1), double(c >> 1 & 1), double(c >> 2)});
  mesh.facets = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                 {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

void append(TriangleMesh& mesh, const TriangleMesh& more) {
  const int first = static_cast<int>(mesh.x.size());
  mesh.x.insert(mesh.x.end(), more.x.begin(), more.x.end());
  for (const Facet& f : more.facets) mesh.facets.push_back({f[0] + first, f[1] + first, f[2] + first});
}

SurfaceDefects check(const TriangleMesh& mesh) { return checkSurface(mesh.x, mesh.facets); }

TEST(Predicates, OrientationIsExactWhereRoundingWouldDecide) {
  // Small whole numbers times a power of two, moved far out: the sign from whole numbers is the truth.
  std::mt19937_64 random(1);
  const auto whole = [&] { return static_cast<double>(random() % 7) - 3.0; };
  int flat = 0;
  for (int round = 0; round < 20000; ++round) {
    std::array<Vec3, 4> p;
    for (Vec3& x : p) x = {whole(), whole(), whole()};
    const double det = dot(cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0]);
    const int truth = det > 0.0 ? 1 : (det < 0.0 ? -1 : 0);
    flat += truth == 0;
    const double scale = 0x1p-40;
    std::array<Vec3, 4> q = p;
    for (Vec3& x : q) x = scale * x + Vec3{1.0, 3.0, -2.0};
    ASSERT_EQ(orientation(q[0], q[1], q[2], q[3]), truth);
    ASSERT_EQ(orientation(q[1], q[0], q[2], q[3]), -truth);
    ASSERT_EQ(orientation(q[2], q[3], q[0], q[1]), truth);
  }
  EXPECT_GT(flat, 500);
  const Vec3 a{0.1, 0.1, 0.1}, b{0.7, 0.7, 0.7}, c{0.3, 0.3, 0.3}, d{0.3, 0.3, std::nextafter(0.3, 1.0)};
  EXPECT_TRUE(areCollinear(a, b, c));
  EXPECT_FALSE(areCollinear(a, b, d));
  EXPECT_EQ(orientation({0, 0, 0}, {1, 0, 0}, {0.3, 1, 5}, 2), 1);
}

TEST(Predicates, TrianglesThatTouchMeetAndThoseOneUnitInTheLastPlaceApartDoNot) {
  const std::array<Vec3, 3> t{Vec3{0, 0, 0}, Vec3{3, 0, 0.1}, Vec3{0, 3, 0.7}};
  const auto moved = [&](const std::array<Vec3, 3>& a, const Vec3& by) {
    return std::array<Vec3, 3>{a[0] + by, a[1] + by, a[2] + by};
  };
  const std::array<Vec3, 3> above{Vec3{1, 1, 2}, Vec3{1, 2, 3}, Vec3{2, 1, 3}};
  EXPECT_FALSE(trianglesMeet(t, above));
  const std::array<Vec3, 3> through{Vec3{1, 1, -1}, Vec3{1, 1, 2}, Vec3{5, 5, 1}};
  EXPECT_TRUE(trianglesMeet(t, through));
  EXPECT_TRUE(trianglesMeet(through, t));
  const std::array<Vec3, 3> tip{Vec3{0, 0, 0}, Vec3{-1, -1, 0}, Vec3{-1, 0, 1}};
  EXPECT_TRUE(trianglesMeet(t, tip));
  EXPECT_FALSE(trianglesMeet(t, moved(tip, {-0x1p-52, 0, 0})));
  const std::array<Vec3, 3> flat{Vec3{0, 0, 0}, Vec3{4, 0, 0}, Vec3{0, 4, 0}};
  const std::array<Vec3, 3> within{Vec3{1, 1, 0}, Vec3{1.5, 1, 0}, Vec3{1, 1.5, 0}};
  EXPECT_TRUE(trianglesMeet(flat, within));
  EXPECT_TRUE(trianglesMeet(within, flat));
  EXPECT_TRUE(trianglesMeet(flat, moved(within, {1, 0, 0})));  // corner on the hypotenuse … and inside
  EXPECT_FALSE(trianglesMeet(flat, moved(within, {3, 3, 0})));
  EXPECT_FALSE(trianglesMeet(flat, moved(within, {0, 0, 0x1p-60})));
}

TEST(Predicates, TriangleTestAgreesWithADensePlacementOfPoints) {
  // Two random triangles meet where the signed distance of one's points to the other's plane changes inside it.
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  const auto triangle = [&] {
    std::array<Vec3, 3> t;
    for (Vec3& x : t) x = {u(random), u(random), u(random)};
    return t;
  };
  const auto onEdgeThrough = [](const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 p = a[k], d = a[(k + 1) % 3] - a[k], e1 = b[1] - b[0], e2 = b[2] - b[0];  // Möller–Trumbore
      const Vec3 h = cross(d, e2);
      const double det = dot(e1, h), s = dot(p - b[0], h) / det, t = dot(d, cross(p - b[0], e1)) / det;
      const double along = dot(e2, cross(p - b[0], e1)) / det;
      if (s >= 0.0 && t >= 0.0 && s + t <= 1.0 && along >= 0.0 && along <= 1.0) return true;
    }
    return false;
  };
  int met = 0;
  for (int round = 0; round < 5000; ++round) {
    const auto a = triangle(), b = triangle();
    const bool truth = onEdgeThrough(a, b) || onEdgeThrough(b, a);
    ASSERT_EQ(trianglesMeet(a, b), truth) << round;
    met += truth;
  }
  EXPECT_GT(met, 500);
}

TEST(SurfaceChecks, AGoodSurfaceHasNoDefects) {
  TriangleMesh mesh = cube();
  append(mesh, cube(0.5, {3, 0, 0}));
  TriangleMesh cavity = cube(0.5, {0.25, 0.25, 0.25});
  for (Facet& f : cavity.facets) std::swap(f[0], f[1]);
  append(mesh, cavity);
  append(mesh, cube(0.1, {0.4, 0.4, 0.4}));  // a stone in the cavity
  EXPECT_TRUE(check(mesh).none()) << describe(check(mesh));
  EXPECT_EQ(describe(check(mesh)), "no defects");
  EXPECT_NEAR(signedVolume(mesh.x, mesh.facets), 1.0 + 0.125 - 0.125 + 0.001, 1e-15);
  EXPECT_NEAR(windingNumber(mesh.x, mesh.facets, {0.1, 0.1, 0.1}), 1.0, 1e-14);
  EXPECT_NEAR(windingNumber(mesh.x, mesh.facets, {0.3, 0.3, 0.3}), 0.0, 1e-14);
}

TEST(SurfaceChecks, EachDefectIsListedWithItsFacets) {
  TriangleMesh mesh = cube();
  mesh.facets.push_back({3, 2, 0});
  EXPECT_EQ(check(mesh).duplicate, (std::vector<std::array<int, 2>>{{12, 0}}));
  mesh = cube();
  mesh.x.push_back({5, 5, 5});
  EXPECT_EQ(check(mesh).unusedVertex, (std::vector<int>{8}));
  mesh = cube();
  append(mesh, cube(1.0, {2, 0, 0}));
  for (std::size_t f = 12; f < 24; ++f) std::swap(mesh.facets[f][0], mesh.facets[f][1]);
  EXPECT_EQ(check(mesh).insideOut, (std::vector<int>{12}));
  EXPECT_NE(describe(check(mesh)).find("1 closed patches are inside out (first facet): 12"), std::string::npos);
  mesh = cube();
  append(mesh, cube(0.5, {0.25, 0.25, 0.25}));  // a cavity should have its normals inwards
  EXPECT_EQ(check(mesh).insideOut, (std::vector<int>{12}));
  mesh = cube();
  mesh.x[3].z = std::nan("");
  EXPECT_THROW(check(mesh), InputError);
}

TEST(SurfaceChecks, SelfIntersectionsAreFoundAcrossCoplanarAndFolded) {
  TriangleMesh mesh = cube();
  append(mesh, cube(1.0, {0.5, 0.5, 0.5}));
  const auto crossing = selfIntersections(mesh.x, mesh.facets);
  std::vector<std::array<int, 2>> all;
  for (int i = 0; i < 24; ++i)
    for (int j = i + 1; j < 24; ++j) {
      const Facet &a = mesh.facets[i], &b = mesh.facets[j];
      if ((i < 12) != (j < 12) &&
          trianglesMeet({mesh.x[a[0]], mesh.x[a[1]], mesh.x[a[2]]}, {mesh.x[b[0]], mesh.x[b[1]], mesh.x[b[2]]}))
        all.push_back({i, j});
    }
  EXPECT_EQ(crossing, all);
  EXPECT_GE(all.size(), 6u);

  const std::vector<Vec3> x{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {2, 2, 0}, {0.5, 0.5, 0}, {1, 0.5, 0}, {0.5, 1, 1}};
  using Pairs = std::vector<std::array<int, 2>>;
  EXPECT_EQ(selfIntersections(x, std::vector<Facet>{{0, 1, 2}, {1, 3, 2}}), Pairs{});          // a flat square
  EXPECT_EQ(selfIntersections(x, std::vector<Facet>{{0, 1, 2}, {1, 0, 4}}), (Pairs{{0, 1}}));  // folded
  EXPECT_EQ(selfIntersections(x, std::vector<Facet>{{0, 1, 2}, {0, 5, 4}}), (Pairs{{0, 1}}));  // one corner, flat
  EXPECT_EQ(selfIntersections(x, std::vector<Facet>{{0, 1, 2}, {0, 6, 4}}), (Pairs{{0, 1}}));  // touches along 0–4
  EXPECT_EQ(selfIntersections(x, std::vector<Facet>{{0, 1, 2}, {3, 4, 6}}), (Pairs{{0, 1}}));
  EXPECT_EQ(selfIntersections(x, std::vector<Facet>{{0, 1, 2}, {2, 1, 0}, {0, 1, 1}}),
            Pairs{});  // other lists' business
}

TEST(SurfaceChecks, AFineSphereIsCleanAndAPinchedOneIsNot) {
  TriangleMesh mesh;
  const int n = 24, m = 48;
  for (int i = 1; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      const double theta = std::numbers::pi * i / n, phi = 2.0 * std::numbers::pi * j / m;
      mesh.x.push_back({std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)});
    }
  const int top = static_cast<int>(mesh.x.size());
  mesh.x.push_back({0, 0, 1});
  mesh.x.push_back({0, 0, -1});
  for (int j = 0; j < m; ++j) {
    const int next = (j + 1) % m, last = (n - 2) * m;
    mesh.facets.push_back({top, j, next});
    mesh.facets.push_back({top + 1, last + next, last + j});
    for (int i = 0; i + 2 < n; ++i) {
      mesh.facets.push_back({i * m + j, (i + 1) * m + j, (i + 1) * m + next});
      mesh.facets.push_back({i * m + j, (i + 1) * m + next, i * m + next});
    }
  }
  EXPECT_TRUE(check(mesh).none()) << describe(check(mesh));
  EXPECT_NEAR(signedVolume(mesh.x, mesh.facets), 4.0 / 3.0 * std::numbers::pi, 0.03);
  mesh.x[static_cast<std::size_t>(top)] = {0, 0, -1.2};
  EXPECT_FALSE(check(mesh).selfIntersection.empty());
}

TEST(SurfaceRepair, ASoupOfTrianglesBecomesTheCubeAgain) {
  TriangleMesh mesh;
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> shift(-1e-7, 1e-7);
  const TriangleMesh wanted = cube();
  for (const Facet& f : wanted.facets) {
    const int first = static_cast<int>(mesh.x.size());
    for (const int v : f) mesh.x.push_back(wanted.x[v] + Vec3{shift(random), shift(random), shift(random)});
    const bool turn = random() % 2 == 0;
    mesh.facets.push_back(turn ? Facet{first, first + 2, first + 1} : Facet{first, first + 1, first + 2});
  }
  mesh.facets.push_back({0, 1, 1});
  mesh.facets.push_back({2, 1, 0});
  mesh.x.push_back({9, 9, 9});
  const SurfaceRepair report = repairSurface(mesh, 1e-6);
  EXPECT_EQ(report.weldedVertices, 28);
  EXPECT_EQ(report.degenerateFacets, 1);
  EXPECT_EQ(report.duplicateFacets, 1);
  EXPECT_EQ(report.unusedVertices, 1);
  EXPECT_EQ(mesh.x.size(), 8u);
  EXPECT_TRUE(check(mesh).none()) << describe(check(mesh));
  EXPECT_NEAR(signedVolume(mesh.x, mesh.facets), 1.0, 1e-6);
  EXPECT_FALSE(repairSurface(mesh, 1e-6).changedAnything());
}

TEST(SurfaceRepair, ClosedPatchesMayKeepTheirSense) {
  TriangleMesh mesh = cube();
  for (Facet& f : mesh.facets) std::swap(f[1], f[2]);
  std::swap(mesh.facets[3][1], mesh.facets[3][2]);  // one against all others
  const SurfaceRepair report = repairSurface(mesh, 0.0, ClosedPatches::keep);
  EXPECT_EQ(report.turnedFacets, 1);
  EXPECT_EQ(report.turnedPatches, 0);
  EXPECT_NEAR(signedVolume(mesh.x, mesh.facets), -1.0, 1e-15);
}

TEST(SurfaceRepair, CavitiesTurnInwardsAndOpenSheetsKeepTheirMajority) {
  TriangleMesh mesh = cube();
  append(mesh, cube(0.5, {0.25, 0.25, 0.25}));
  const SurfaceRepair report = repairSurface(mesh);
  EXPECT_EQ(report.turnedFacets, 12);
  EXPECT_EQ(report.turnedPatches, 1);
  EXPECT_TRUE(check(mesh).none());
  EXPECT_NEAR(signedVolume(mesh.x, mesh.facets), 0.875, 1e-15);
  mesh.x = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}};
  mesh.facets = {{0, 2, 1}, {0, 2, 3}, {1, 4, 2}};
  EXPECT_EQ(repairSurface(mesh).turnedFacets, 1);
  EXPECT_EQ(mesh.facets, (std::vector<Facet>{{0, 1, 2}, {0, 2, 3}, {1, 4, 2}}));
}

TEST(SurfaceRepair, AMoebiusStripIsReportedAndLeftAsItIs) {
  TriangleMesh mesh;
  const int n = 9;
  for (int i = 0; i < n; ++i)
    for (const double w : {-0.3, 0.3}) {
      const double t = 2.0 * std::numbers::pi * i / n;
      const double r = 1.0 + w * std::cos(0.5 * t);
      mesh.x.push_back({r * std::cos(t), r * std::sin(t), w * std::sin(0.5 * t)});
    }
  for (int i = 0; i < n; ++i) {
    const bool last = i + 1 == n;
    const int a = 2 * i, b = 2 * i + 1, c = last ? 1 : 2 * i + 2, d = last ? 0 : 2 * i + 3;
    mesh.facets.push_back({a, c, b});
    mesh.facets.push_back({b, c, d});
  }
  const auto before = mesh.facets;
  const SurfaceRepair report = repairSurface(mesh);
  EXPECT_EQ(report.unorientablePatches, 1);
  EXPECT_EQ(mesh.facets, before);
  EXPECT_FALSE(check(mesh).flipped.empty());
}

TEST(Welding, GoesToTheFirstWithinReachWhereverThePointsLie) {
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (const double tolerance : {0.0, 1e-3, 0.2}) {
    TriangleMesh mesh;
    for (int i = 0; i < 400; ++i) mesh.x.push_back({1e3 + u(random), u(random), i % 2 ? 0.0 : u(random)});
    for (int i = 0; i < 100; ++i) mesh.x.push_back(mesh.x[static_cast<std::size_t>(random() % 400)]);
    const std::vector<Vec3> x = mesh.x;
    for (int i = 0; i + 2 < 500; i += 3) mesh.facets.push_back({i, i + 1, i + 2});
    std::vector<Vec3> kept;
    std::vector<int> target;
    for (const Vec3& p : x) {
      std::size_t k = 0;
      while (k < kept.size() && !(squaredNorm(kept[k] - p) <= tolerance * tolerance)) ++k;
      if (k == kept.size()) kept.push_back(p);
      target.push_back(static_cast<int>(k));
    }
    EXPECT_EQ(weldVertices(mesh, tolerance), static_cast<int>(500 - kept.size()));
    EXPECT_EQ(mesh.x, kept);
    for (int i = 0; i < 498; ++i) ASSERT_EQ(mesh.facets[i / 3][i % 3], target[i]);
  }
}

}  // namespace
}  // namespace dovetail::geometry
