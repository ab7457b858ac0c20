#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "box_surface.hpp"
#include "dovetail/cg/surface_quadrature.hpp"
#include "dovetail/core/error.hpp"
#include "random_state.hpp"

namespace dovetail::cg {
namespace {

using testing::boxSurface;
using testing::dense;
using testing::TestSurface;

constexpr int top = 5;

struct QuadratureRow {
  std::vector<int> column;
  std::vector<double> weight;
  bool spread = false;
};

QuadratureRow rowAt(SurfaceKernelQuadrature& quadrature, const Vec3& centre, int patch = top) {
  QuadratureRow row;
  row.spread =
      quadrature.row(centre, patch, std::vector<int>{3, 8}, std::vector<double>{0.25, 0.75}, row.column, row.weight);
  return row;
}

SurfaceKernelQuadrature make(const TestSurface& s, double width, KernelCorrection correction) {
  return {{{KernelShape::lucy, 2, width}, correction}, gaussPointsOnQuads(s.nodes, s.quads, s.patchOfQuad)};
}

TEST(SurfaceQuadrature, GaussPointsCarryTheAreaAndReproducePositions) {
  TestSurface s = boxSurface({2, 6, 2}, {0.8, 2.4, 0.8});
  const SurfacePoints points = gaussPointsOnQuads(s.nodes, s.quads, s.patchOfQuad);
  EXPECT_EQ(points.X.size(), 4 * s.quads.size());
  double area = 0.0;
  for (double w : points.weight) area += w;
  EXPECT_NEAR(area, 2 * 0.64 + 4 * 0.8 * 2.4, 1e-13);
  EXPECT_LT(rowSumError(points.shape), 1e-15);
  std::vector<Vec3> position(points.X.size());
  apply(points.shape, s.nodes, position);
  for (std::size_t q = 0; q < position.size(); ++q) EXPECT_LT(norm(position[q] - points.X[q]), 1e-15);
}

TEST(SurfaceQuadrature, ExactForBilinearLoadsOnSkewedFaces) {
  // ∫ ψ_i dA over one parallelogram is a quarter of its area for each node.
  const std::vector<Vec3> X{{0, 0, 0}, {2, 0, 0.5}, {2.5, 1, 0.75}, {0.5, 1, 0.25}};
  const SurfacePoints points =
      gaussPointsOnQuads(X, std::vector<std::array<int, 4>>{{0, 1, 2, 3}}, std::vector<int>{0});
  std::vector<double> load(4);
  applyTransposed(points.shape, points.weight, load);
  const double area = norm(cross(X[1] - X[0], X[3] - X[0]));
  for (double value : load) EXPECT_NEAR(value, 0.25 * area, 1e-14);
}

TEST(SurfaceQuadrature, RowsSumToOneStayOnThePatchAndAreNonNegative) {
  const TestSurface s = boxSurface({2, 6, 2}, {0.8, 2.4, 0.8});
  testing::RandomState random(2);
  for (double width : {0.3, 0.8, 5.0}) {
    auto quadrature = make(s, width, KernelCorrection::none);
    for (int trial = 0; trial < 50; ++trial) {
      const QuadratureRow row = rowAt(quadrature, {random.number(0.0, 0.8), random.number(0.0, 2.4), 0.8});
      EXPECT_TRUE(row.spread);
      double sum = 0.0;
      for (double w : row.weight) sum += w;
      EXPECT_NEAR(sum, 1.0, 1e-14);
      EXPECT_GE(*std::min_element(row.weight.begin(), row.weight.end()), 0.0);
      EXPECT_TRUE(std::is_sorted(row.column.begin(), row.column.end()));
      for (int node : row.column) EXPECT_EQ(s.nodes[node].z, 0.8);
    }
  }
}

TEST(SurfaceQuadrature, FallsBackToTheLocalRowBetweenPoints) {
  const TestSurface s = boxSurface({2, 6, 2}, {0.8, 2.4, 0.8});
  for (double width : {0.0, 1e-3}) {
    for (KernelCorrection correction : {KernelCorrection::none, KernelCorrection::linear}) {
      auto quadrature = make(s, width, correction);
      const QuadratureRow row = rowAt(quadrature, {0.2, 0.2, 0.8});
      EXPECT_FALSE(row.spread);
      EXPECT_EQ(row.column, (std::vector<int>{3, 8}));
      EXPECT_EQ(row.weight, (std::vector<double>{0.25, 0.75}));
    }
  }
  auto quadrature = make(s, 10.0, KernelCorrection::none);
  EXPECT_FALSE(rowAt(quadrature, {0.2, 0.2, 0.8}, 77).spread);
}

TEST(SurfaceQuadrature, CorrectionRestoresFirstMoments) {
  const TestSurface s = boxSurface({2, 6, 2}, {0.8, 2.4, 0.8});
  for (double width : {0.4, 0.8, 5.0}) {
    auto corrected = make(s, width, KernelCorrection::linear), plain = make(s, width, KernelCorrection::none);
    for (const Vec3& centre : {Vec3{0, 0, 0.8}, Vec3{0.4, 0, 0.8}, Vec3{0.31, 0.77, 0.8}}) {
      const QuadratureRow row = rowAt(corrected, centre), without = rowAt(plain, centre);
      EXPECT_LT(norm(applyRow<Vec3>(row.column, row.weight, s.nodes) - centre), 1e-12);
      EXPECT_GT(norm(applyRow<Vec3>(without.column, without.weight, s.nodes) - centre), 1e-3);
    }
  }
}

TEST(SurfaceQuadrature, TooFewPointsForTheCorrectionStillSumToOne) {
  const TestSurface s = boxSurface({1, 1, 1}, {1, 1, 1});
  auto quadrature = make(s, 0.1, KernelCorrection::linear);
  const double g = 0.5 - 0.5 / std::sqrt(3.0);
  const QuadratureRow row = rowAt(quadrature, {g + 0.05, g, 1.0});
  EXPECT_TRUE(row.spread);
  // One point within the width: its shape functions are all there is.
  const auto weight = dense(row.column, row.weight, s.nodes.size());
  for (std::size_t i = 0; i < s.nodes.size(); ++i)
    if (s.nodes[i].z == 1.0) {
      const double x = s.nodes[i].x == 0.0 ? 1 - g : g, y = s.nodes[i].y == 0.0 ? 1 - g : g;
      EXPECT_NEAR(weight[i], x * y, 1e-14);
    }
}

TEST(SurfaceQuadrature, ApproachesTheAdaptiveRowForWideKernels) {
  const TestSurface s = boxSurface({4, 12, 4}, {0.8, 2.4, 0.8});
  int facet = -1;
  for (int f = 0; f < static_cast<int>(s.facets.size()) && facet < 0; ++f)
    if (s.patchOfFacet[f] == top) facet = f + 4 * 17;
  const auto& v = s.facets[facet];
  const Vec3 centre = 0.2 * s.vertices[v[0]] + 0.3 * s.vertices[v[1]] + 0.5 * s.vertices[v[2]];
  std::vector<int> column;
  std::vector<double> weight;
  const double width = 1.6;
  surfaceKernelRow({{KernelShape::lucy, 2, width}, KernelCorrection::none}, s.vertices, s.facets, s.patchOfFacet,
                   s.localMap, facet, {0.2, 0.3, 0.5}, column, weight);
  auto quadrature = make(s, width, KernelCorrection::none);
  const QuadratureRow row = rowAt(quadrature, centre);
  const auto fine = dense(column, weight, s.nodes.size()), coarse = dense(row.column, row.weight, s.nodes.size());
  const double largest = *std::max_element(fine.begin(), fine.end());
  for (std::size_t i = 0; i < fine.size(); ++i) EXPECT_NEAR(coarse[i], fine[i], 0.02 * largest);
}

TEST(SurfaceQuadrature, BadInputIsRefused) {
  const TestSurface s = boxSurface({1, 1, 1}, {1, 1, 1});
  SurfacePoints points = gaussPointsOnQuads(s.nodes, s.quads, s.patchOfQuad);
  EXPECT_THROW(make(s, -1.0, KernelCorrection::none), InputError);
  points.weight[3] = 0.0;
  EXPECT_THROW((SurfaceKernelQuadrature{{{KernelShape::lucy, 2, 1.0}, KernelCorrection::none}, points}), InputError);
  points.weight.pop_back();
  EXPECT_THROW((SurfaceKernelQuadrature{{{KernelShape::lucy, 2, 1.0}, KernelCorrection::none}, points}), InputError);
  EXPECT_THROW(gaussPointsOnQuads(s.nodes, std::vector<std::array<int, 4>>{{0, 1, 2, 99}}, std::vector<int>{0}),
               InputError);
  EXPECT_THROW(gaussPointsOnQuads(s.nodes, s.quads, std::vector<int>{0}), InputError);
}

}  // namespace
}  // namespace dovetail::cg
