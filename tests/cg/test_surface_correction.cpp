#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "box_surface.hpp"
#include "dovetail/cg/surface_kernel.hpp"
#include "random_state.hpp"

namespace dovetail::cg {
namespace {

using testing::boxSurface;
using testing::TestSurface;

using Barycentric = std::array<double, 3>;

Vec3 pointOn(const TestSurface& s, int facet, const Barycentric& b) {
  const auto& f = s.facets[facet];
  return b[0] * s.vertices[f[0]] + b[1] * s.vertices[f[1]] + b[2] * s.vertices[f[2]];
}

/// Σ P_i X_i − X_c.
Vec3 firstMomentGap(const SurfaceKernel& kernel, const TestSurface& s, int facet, const Barycentric& b) {
  std::vector<int> column;
  std::vector<double> weight;
  surfaceKernelRow(kernel, s.vertices, s.facets, s.patchOfFacet, s.localMap, facet, b, column, weight);
  return applyRow<Vec3>(column, weight, s.nodes) - pointOn(s, facet, b);
}

SurfaceKernel kernelOf(double width, KernelCorrection correction) {
  return {{KernelShape::lucy, 2, width}, correction};
}

/// Corners, edges and inside of every side: every facet of the box with these points.
const std::vector<Barycentric> places{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5, 0.5, 0}, {0.3, 0, 0.7}, {0.2, 0.3, 0.5}};

TEST(SurfaceCorrection, RestoresFirstMomentsEverywhereOnFlatPatches) {
  const TestSurface s = boxSurface({2, 4, 3}, {0.8, 1.6, 1.2});
  for (double width : {1e-6, 0.01, 0.3, 0.8, 4.0, 1e6})
    for (int facet = 0; facet < static_cast<int>(s.facets.size()); ++facet)
      for (const Barycentric& b : places)
        EXPECT_LT(norm(firstMomentGap(kernelOf(width, KernelCorrection::linear), s, facet, b)), 1e-12)
            << "width " << width << ", facet " << facet;
}

TEST(SurfaceCorrection, WithoutItTheCentreMovesIn) {
  const TestSurface s = boxSurface({2, 4, 3}, {0.8, 1.6, 1.2});
  // Facet 4q of the side z+ touches the edge; the load is pulled inwards by a good part of the width.
  int facet = -1;
  for (int f = 0; f < static_cast<int>(s.facets.size()) && facet < 0; ++f)
    if (s.patchOfFacet[f] == 5) facet = f;
  ASSERT_GE(facet, 0);
  for (const Barycentric& b : {Barycentric{1, 0, 0}, Barycentric{0.5, 0.5, 0}}) {
    const Vec3 centre = pointOn(s, facet, b);
    EXPECT_TRUE(centre.x == 0.0 || centre.y == 0.0);
    EXPECT_GT(norm(firstMomentGap(kernelOf(0.4, KernelCorrection::none), s, facet, b)), 0.05);
  }
}

TEST(SurfaceCorrection, SpreadLoadsKeepForceAndMoment) {
  const TestSurface s = boxSurface({2, 4, 3}, {0.8, 1.6, 1.2});
  testing::RandomState random(8);
  const Vec3 force = random.vector(-1.0, 1.0), pole = random.vector(-1.0, 1.0);
  for (int facet = 0; facet < static_cast<int>(s.facets.size()); facet += 7) {
    std::vector<int> column;
    std::vector<double> weight;
    surfaceKernelRow(kernelOf(0.6, KernelCorrection::linear), s.vertices, s.facets, s.patchOfFacet, s.localMap, facet,
                     {0.7, 0.2, 0.1}, column, weight);
    std::vector<Vec3> load(s.nodes.size());
    scatterRow<Vec3>(column, weight, force, load);
    Vec3 total, moment;
    for (std::size_t i = 0; i < load.size(); ++i) {
      total += load[i];
      moment += cross(s.nodes[i] - pole, load[i]);
    }
    EXPECT_LT(norm(total - force), 1e-14);
    EXPECT_LT(norm(moment - cross(pointOn(s, facet, {0.7, 0.2, 0.1}) - pole, force)), 1e-12);
  }
}

TEST(SurfaceCorrection, RestoresTheNormalMomentOfACurvedPatchToo) {
  TestSurface s = boxSurface({4, 4, 1}, {1.0, 1.0, 0.2});
  for (Vec3& x : s.nodes) x.z += 0.15 * std::sin(2.0 * x.x) * std::cos(1.5 * x.y);
  for (Vec3& x : s.vertices) x = {};
  apply(s.localMap, s.nodes, s.vertices);
  for (int facet = 0; facet < static_cast<int>(s.facets.size()); ++facet) {
    if (s.patchOfFacet[facet] != 5) continue;
    const Barycentric b{0.2, 0.3, 0.5};
    EXPECT_LT(norm(firstMomentGap(kernelOf(0.6, KernelCorrection::linear), s, facet, b)), 1e-12);
    EXPECT_GT(norm(firstMomentGap(kernelOf(0.6, KernelCorrection::none), s, facet, b)), 1e-4);
  }
}

TEST(SurfaceCorrection, RoundOffInAFlatPatchDoesNotCount) {
  // A normal thickness at round-off must not be resolved: weights stay what they are on the exact plane.
  TestSurface s = boxSurface({4, 4, 1}, {1.0, 1.0, 0.2});
  const TestSurface exact = s;
  testing::RandomState random(9);
  for (Vec3& x : s.vertices) x.z += random.number(-1e-14, 1e-14);
  for (int facet = 0; facet < static_cast<int>(s.facets.size()); ++facet) {
    if (s.patchOfFacet[facet] != 5) continue;
    std::vector<int> column, columnExact;
    std::vector<double> weight, weightExact;
    const SurfaceKernel kernel = kernelOf(0.6, KernelCorrection::linear);
    const Barycentric b{0.2, 0.3, 0.5};
    surfaceKernelRow(kernel, s.vertices, s.facets, s.patchOfFacet, s.localMap, facet, b, column, weight);
    surfaceKernelRow(kernel, exact.vertices, s.facets, s.patchOfFacet, s.localMap, facet, b, columnExact, weightExact);
    ASSERT_EQ(column, columnExact);
    for (std::size_t k = 0; k < weight.size(); ++k) EXPECT_NEAR(weight[k], weightExact[k], 1e-12);
  }
}

}  // namespace
}  // namespace dovetail::cg
