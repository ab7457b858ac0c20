// CGAL as an oracle for the checks of our own, and its repair of what ours leaves alone.
#include <gtest/gtest.h>

#include <numbers>

#include "dovetail/core/error.hpp"
#include "dovetail/geometry/surface_checks.hpp"
#include "dovetail/geometry_cgal/cgal_surface.hpp"

namespace dovetail::geometry {
namespace {

/// A torus; `crumple` moves its vertices at random, until it runs through itself.
TriangleMesh torus(int n, int m, double crumple, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> u(-crumple, crumple);
  TriangleMesh mesh;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      const double a = 2.0 * std::numbers::pi * i / n, b = 2.0 * std::numbers::pi * j / m;
      const double r = 1.0 + 0.4 * std::cos(b);
      mesh.x.push_back(Vec3{r * std::cos(a), r * std::sin(a), 0.4 * std::sin(b)} +
                       Vec3{u(random), u(random), u(random)});
    }
  const auto number = [&](int i, int j) { return i % n * m + j % m; };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      mesh.facets.push_back({number(i, j), number(i + 1, j), number(i + 1, j + 1)});
      mesh.facets.push_back({number(i, j), number(i + 1, j + 1), number(i, j + 1)});
    }
  return mesh;
}

/// Vertices on a coarse lattice, so that many facets are coplanar, folded or touch.
TriangleMesh onLattice(TriangleMesh mesh) {
  for (Vec3& x : mesh.x)
    for (int k = 0; k < 3; ++k) x[k] = std::round(4.0 * x[k]) / 4.0;
  return mesh;
}

TEST(CgalSurface, AgreesOnClosednessOrientationAndSelfIntersection) {
  for (const double crumple : {0.0, 0.05, 0.1, 0.2, 0.4})
    for (unsigned seed = 0; seed < 4; ++seed) {
      const TriangleMesh mesh = torus(16, 10, crumple, seed);
      const CgalReport report = checkWithCgal(mesh.x, mesh.facets);
      const SurfaceDefects defects = checkSurface(mesh.x, mesh.facets);
      ASSERT_TRUE(report.isMesh);
      EXPECT_EQ(report.closed, defects.closedAndOriented());
      EXPECT_EQ(report.selfIntersection, defects.selfIntersection) << crumple << " " << seed;
      EXPECT_EQ(report.boundsVolume, defects.none());
      if (crumple >= 0.2) {
        EXPECT_GT(defects.selfIntersection.size(), 5u);
      }
    }
}

TEST(CgalSurface, AgreesOnFacetsThatAreCoplanarOrTouch) {
  std::size_t found = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    TriangleMesh mesh = onLattice(torus(7, 5, 0.3, seed));
    const auto flat = checkSurface(mesh.x, mesh.facets).zeroArea;
    for (std::size_t k = flat.size(); k-- > 0;) mesh.facets.erase(mesh.facets.begin() + flat[k]);
    const CgalReport report = checkWithCgal(mesh.x, mesh.facets);
    if (!report.isMesh) continue;
    EXPECT_EQ(report.selfIntersection, selfIntersections(mesh.x, mesh.facets)) << seed;
    found += report.selfIntersection.size();
  }
  EXPECT_GT(found, 500u);
}

TEST(CgalSurface, AnInsideOutOrOpenOrTurnedSurfaceBoundsNoVolume) {
  TriangleMesh mesh = torus(12, 8, 0.0, 1);
  EXPECT_TRUE(checkWithCgal(mesh.x, mesh.facets).boundsVolume);
  TriangleMesh turned = mesh;
  for (Facet& f : turned.facets) std::swap(f[0], f[1]);
  EXPECT_FALSE(checkWithCgal(turned.x, turned.facets).boundsVolume);
  EXPECT_FALSE(checkSurface(turned.x, turned.facets).insideOut.empty());
  turned = mesh;
  std::swap(turned.facets[3][0], turned.facets[3][1]);
  EXPECT_FALSE(checkWithCgal(turned.x, turned.facets).isMesh);
  turned.facets.erase(turned.facets.begin() + 3);
  EXPECT_FALSE(checkWithCgal(turned.x, turned.facets).closed);
  turned.facets[0][0] = 1000;
  EXPECT_THROW(checkWithCgal(turned.x, turned.facets), InputError);
}

TEST(CgalSurface, RepairFillsHolesAndTurnsTheSurfaceRight) {
  TriangleMesh soup;
  const TriangleMesh mesh = torus(24, 16, 0.02, 3);
  std::mt19937_64 random(2);
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    if (f == 5 || f == 200 || f == 201) continue;
    const int first = static_cast<int>(soup.x.size());
    for (const int v : mesh.facets[f]) soup.x.push_back(mesh.x[v]);
    soup.facets.push_back(random() % 2 ? Facet{first, first + 1, first + 2} : Facet{first + 1, first, first + 2});
  }
  soup.facets.push_back({0, 0, 1});
  TriangleMesh open = soup;
  const CgalRepair report = repairWithCgal(soup);
  EXPECT_EQ(report.filledHoles, 2);
  EXPECT_TRUE(report.closed && report.boundsVolume && !report.selfIntersecting);
  EXPECT_TRUE(checkSurface(soup.x, soup.facets).none()) << describe(checkSurface(soup.x, soup.facets));
  EXPECT_NEAR(signedVolume(soup.x, soup.facets), signedVolume(mesh.x, mesh.facets), 2e-3);
  EXPECT_FALSE(repairWithCgal(open, {.fillHoles = false}).closed);
  EXPECT_EQ(checkSurface(open.x, open.facets).boundary.size(), 7u);
}

}  // namespace
}  // namespace dovetail::geometry
