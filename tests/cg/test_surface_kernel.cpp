#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "box_surface.hpp"
#include "dovetail/cg/surface_kernel.hpp"
#include "dovetail/core/error.hpp"
#include "random_state.hpp"

namespace dovetail::cg {
namespace {

using testing::boxSurface;
using testing::dense;
using testing::RandomState;
using testing::TestSurface;

constexpr KernelShape kernelShapes[] = {KernelShape::lucy, KernelShape::gauss};
constexpr KernelCorrection corrections[] = {KernelCorrection::none, KernelCorrection::linear};
using Barycentric = std::array<double, 3>;

struct Row {
  std::vector<int> column;
  std::vector<double> weight;
};

Row rowAt(const SurfaceKernel& kernel, const TestSurface& s, int facet, const Barycentric& b) {
  Row row;
  surfaceKernelRow(kernel, s.vertices, s.facets, s.patchOfFacet, s.localMap, facet, b, row.column, row.weight);
  return row;
}

Row localAt(const TestSurface& s, int facet, const Barycentric& b) {
  Row row;
  localRow(s.localMap, s.facets[facet], b, row.column, row.weight);
  return row;
}

double distance(const TestSurface& s, const Row& a, const Row& b) {
  const auto da = dense(a.column, a.weight, s.nodes.size()), db = dense(b.column, b.weight, s.nodes.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < da.size(); ++i) largest = std::max(largest, std::abs(da[i] - db[i]));
  return largest;
}

Barycentric randomPoint(RandomState& random) {
  double a = random.number(0.0, 1.0), b = random.number(0.0, 1.0);
  if (a + b > 1.0) {
    a = 1.0 - a;
    b = 1.0 - b;
  }
  return {1.0 - a - b, a, b};
}

TEST(SurfaceKernel, RowsSumToOneAndAreSortedForEveryWidth) {
  const TestSurface s = boxSurface({2, 6, 2}, {0.8, 2.4, 0.8});
  RandomState random(1);
  for (double width : {0.0, 1e-300, 1e-15, 1e-9, 1e-3, 0.1, 0.4, 2.0, 1e3, 1e12})
    for (KernelShape shape : kernelShapes)
      for (KernelCorrection correction : corrections)
        for (int trial = 0; trial < 5; ++trial) {
          const int facet = static_cast<int>(random.number(0.0, static_cast<double>(s.facets.size()) - 1e-6));
          const Row row = rowAt({{shape, 2, width}, correction}, s, facet, randomPoint(random));
          double sum = 0.0;
          for (double w : row.weight) sum += w;
          EXPECT_NEAR(sum, 1.0, 1e-14);
          EXPECT_TRUE(std::is_sorted(row.column.begin(), row.column.end()));
          EXPECT_EQ(std::adjacent_find(row.column.begin(), row.column.end()), row.column.end());
          if (correction == KernelCorrection::none) {
            EXPECT_GE(*std::min_element(row.weight.begin(), row.weight.end()), 0.0);
          }
        }
}

TEST(SurfaceKernel, RowsAreAppended) {
  const TestSurface s = boxSurface({1, 1, 1}, {1, 1, 1});
  std::vector<int> column{99};
  std::vector<double> weight{7.0};
  for (double width : {0.0, 0.5}) {
    surfaceKernelRow({{KernelShape::lucy, 2, width}, KernelCorrection::none}, s.vertices, s.facets, s.patchOfFacet,
                     s.localMap, 3, {0.2, 0.3, 0.5}, column, weight);
    EXPECT_EQ(column.front(), 99);
    EXPECT_EQ(weight.front(), 7.0);
    EXPECT_EQ(column.size(), weight.size());
  }
  EXPECT_EQ(column.size(), 1u + 4u + 4u);
}

TEST(SurfaceKernel, TendsToTheLocalMapWithTheWidthAndReachesItAtZero) {
  const TestSurface s = boxSurface({2, 4, 2}, {0.8, 1.6, 0.8});
  // A corner and an edge of a facet, where neighbours share the support at every width, and a point inside.
  for (const Barycentric& b : {Barycentric{1.0, 0.0, 0.0}, Barycentric{0.4, 0.6, 0.0}, Barycentric{0.5, 0.2, 0.3}})
    for (KernelShape shape : kernelShapes)
      for (KernelCorrection correction : corrections) {
        const Row local = localAt(s, 21, b);
        for (double width = 0.4; width > 1e-14; width *= 0.25) {
          const double error = distance(s, rowAt({{shape, 2, width}, correction}, s, 21, b), local);
          EXPECT_LE(error, width / 0.4 + 1e-14) << "width " << width;
        }
        const Row atZero = rowAt({{shape, 2, 0.0}, correction}, s, 21, b);
        EXPECT_EQ(atZero.column, local.column);
        EXPECT_EQ(atZero.weight, local.weight);
        EXPECT_EQ(rowAt({{shape, 2, 1e-17}, correction}, s, 21, b).weight, local.weight);
      }
}

TEST(SurfaceKernel, ASupportInsideOneFacetGivesItsInterpolation) {
  // ψ is linear there and W is even, so the spread row equals the local one up to the quadrature.
  const TestSurface s = boxSurface({1, 1, 1}, {1, 1, 1});
  const Barycentric b{0.3, 0.35, 0.35};
  for (double width : {1e-2, 5e-2, 0.1}) {
    const Row row = rowAt({{KernelShape::lucy, 2, width}, KernelCorrection::none}, s, 0, b);
    EXPECT_LT(distance(s, row, localAt(s, 0, b)), 1e-6);
  }
}

/// Weights by brute force: the midpoints of a million squares on the top of a unit cube.
std::vector<double> bruteForceOnTop(const Kernel& kernel, const Vec3& centre) {
  constexpr int n = 1000;
  std::vector<double> corner(4, 0.0);
  double total = 0.0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double x = (i + 0.5) / n, y = (j + 0.5) / n;
      const double w = profile(kernel.shape, norm(Vec3{x, y, 1.0} - centre) / kernel.width);
      // On a facet that joins two corners and the centre, the centre's value is the mean of four nodes.
      const double toEdge = std::min({x, y, 1.0 - x, 1.0 - y}), mid = 2.0 * toEdge;
      for (double& value : corner) value += 0.25 * w * mid;
      const double along = toEdge == y || toEdge == 1.0 - y ? x : y;
      const double far = along - toEdge, near = 1.0 - mid - far;
      const int c00 = 0, c10 = 1, c01 = 2, c11 = 3;
      const auto add = [&](int first, int second) {
        corner[first] += w * near;
        corner[second] += w * far;
      };
      if (toEdge == y)
        add(c00, c10);
      else if (toEdge == 1.0 - y)
        add(c01, c11);
      else if (toEdge == x)
        add(c00, c01);
      else
        add(c10, c11);
      total += w;
    }
  for (double& value : corner) value /= total;
  return corner;
}

TEST(SurfaceKernel, MatchesBruteForceQuadrature) {
  const TestSurface s = boxSurface({1, 1, 1}, {1, 1, 1});
  const int facet = 5 * 4 + 1;
  const Barycentric b{0.2, 0.5, 0.3};
  const auto& f = s.facets[facet];
  const Vec3 centre = b[0] * s.vertices[f[0]] + b[1] * s.vertices[f[1]] + b[2] * s.vertices[f[2]];
  for (double width : {0.3, 0.8, 3.0}) {
    const Kernel kernel{KernelShape::lucy, 2, width};
    const Row row = rowAt({kernel, KernelCorrection::none}, s, facet, b);
    const auto weight = dense(row.column, row.weight, s.nodes.size());
    const auto expected = bruteForceOnTop(kernel, centre);
    for (std::size_t i = 0; i < s.nodes.size(); ++i) {
      if (s.nodes[i].z < 1.0) continue;
      const int corner = (s.nodes[i].x > 0.5 ? 1 : 0) + (s.nodes[i].y > 0.5 ? 2 : 0);
      EXPECT_NEAR(weight[i], expected[corner], 5e-6) << "width " << width;
    }
  }
}

TEST(SurfaceKernel, FacetsThatShareThePointAgree) {
  const TestSurface s = boxSurface({2, 2, 2}, {0.8, 0.8, 0.8});
  for (KernelCorrection correction : corrections)
    for (double width : {0.05, 0.3, 2.0}) {
      const SurfaceKernel kernel{{KernelShape::lucy, 2, width}, correction};
      // Facets 4q and 4q + 1 share the edge from corner b to the centre: (a, b, m) and (b, c, m).
      const Row one = rowAt(kernel, s, 80, {0.0, 0.7, 0.3}), two = rowAt(kernel, s, 81, {0.7, 0.0, 0.3});
      EXPECT_LT(distance(s, one, two), 1e-13);
    }
}

TEST(SurfaceKernel, NeverLeavesThePatch) {
  const TestSurface s = boxSurface({2, 6, 2}, {0.8, 2.4, 0.8});
  for (int facet = 0; facet < static_cast<int>(s.facets.size()); ++facet) {
    if (s.patchOfFacet[facet] != 5) continue;
    for (KernelCorrection correction : corrections) {
      const Row row = rowAt({{KernelShape::lucy, 2, 10.0}, correction}, s, facet, {0.2, 0.3, 0.5});
      for (int node : row.column) EXPECT_EQ(s.nodes[node].z, 0.8);
      EXPECT_EQ(row.column.size(), 21u);
    }
  }
}

TEST(SurfaceKernel, CachedRowsAreBitwiseTheSame) {
  TestSurface s = boxSurface({3, 5, 2}, {0.9, 2.0, 0.7});
  RandomState random(12);
  for (KernelCorrection correction : corrections)
    for (double width : {0.0, 1e-3, 0.2, 0.7, 50.0}) {
      const SurfaceKernel kernel{{KernelShape::lucy, 2, width}, correction};
      SurfaceKernelRows rows(kernel, s.vertices, s.facets, s.patchOfFacet, s.localMap);
      for (int facet = 0; facet < static_cast<int>(s.facets.size()); ++facet) {
        const Barycentric b = randomPoint(random);
        const Row expected = rowAt(kernel, s, facet, b);
        Row row;
        rows.row(facet, b, row.column, row.weight);
        EXPECT_EQ(row.column, expected.column);
        EXPECT_EQ(row.weight, expected.weight);
      }
    }
}

TEST(SurfaceKernel, FacetsWithoutAreaDoNoHarm) {
  TestSurface s = boxSurface({1, 1, 1}, {1, 1, 1});
  s.facets[20] = {s.facets[20][0], s.facets[20][0], s.facets[20][1]};
  for (KernelCorrection correction : corrections) {
    const SurfaceKernel kernel{{KernelShape::lucy, 2, 1e-3}, correction};
    for (int facet : {20, 21}) {
      const Row row = rowAt(kernel, s, facet, {0.2, 0.3, 0.5});
      double sum = 0.0;
      for (double w : row.weight) sum += w;
      EXPECT_NEAR(sum, 1.0, 1e-14);
    }
  }
}

TEST(SurfaceKernel, BadInputIsRefused) {
  const TestSurface s = boxSurface({1, 1, 1}, {1, 1, 1});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Barycentric b{0.2, 0.3, 0.5};
  const SurfaceKernel good{{KernelShape::lucy, 2, 0.3}, KernelCorrection::none};
  for (double width : {-0.1, nan, std::numeric_limits<double>::infinity()})
    EXPECT_THROW(rowAt({{KernelShape::lucy, 2, width}, KernelCorrection::none}, s, 0, b), InputError);
  EXPECT_THROW(rowAt({{KernelShape::lucy, 5, 0.3}, KernelCorrection::none}, s, 0, b), InputError);
  EXPECT_THROW(rowAt(good, s, -1, b), InputError);
  EXPECT_THROW(rowAt(good, s, static_cast<int>(s.facets.size()), b), InputError);
  EXPECT_THROW(rowAt(good, s, 0, {nan, 0.5, 0.5}), InputError);
  TestSurface broken = s;
  broken.patchOfFacet.pop_back();
  EXPECT_THROW(rowAt(good, broken, 0, b), InputError);
  broken = s;
  broken.vertices.pop_back();
  EXPECT_THROW(rowAt(good, broken, 0, b), InputError);
}

}  // namespace
}  // namespace dovetail::cg
