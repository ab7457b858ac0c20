#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "box_surface.hpp"
#include "dovetail/cg/surface_kernel.hpp"
#include "dovetail/cg/surface_quadrature.hpp"
#include "dovetail/cg/symmetric_kernel.hpp"
#include "dovetail/core/error.hpp"
#include "random_state.hpp"

namespace dovetail::cg {
namespace {

using testing::TestSurface;

/// One patch of nx × ny faces over [0, a] × [0, b].
TestSurface sheet(int nx, int ny, double a, double b) {
  TestSurface s;
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) s.nodes.push_back({a * i / nx, b * j / ny, 0.0});
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const int k = i + (nx + 1) * j;
      s.quads.push_back({k, k + 1, k + nx + 2, k + nx + 1});
      s.patchOfQuad.push_back(7);
    }
  testing::triangulate(s);
  return s;
}

TestSurface moved(TestSurface s, Vec3 (*to)(const Vec3&)) {
  for (Vec3& x : s.nodes) x = to(x);
  std::vector<Vec3> vertices(s.vertices.size());
  apply(s.localMap, s.nodes, vertices);
  s.vertices = vertices;
  return s;
}
Vec3 tilted(const Vec3& x) { return {0.8 * x.x - 0.6 * x.y + 3.0, 0.6 * x.x + 0.8 * x.y - 1.0, 2.0}; }
Vec3 sheared(const Vec3& x) { return {x.x + 0.4 * x.y, x.y, 0.0}; }
Vec3 humped(const Vec3& x) { return {x.x, x.y, 0.3 * std::sin(2.0 * x.x) * std::cos(1.3 * x.y)}; }

/// A rectangle as it is and turned in space; a parallelogram; a curved patch.
std::vector<TestSurface> sheets() {
  const TestSurface plain = sheet(3, 8, 0.8, 3.0);
  return {plain, moved(plain, tilted), moved(plain, sheared), moved(plain, humped)};
}

std::vector<double> areas(const TestSurface& s) {
  std::vector<double> area(s.vertices.size(), 0.0);
  for (const auto& f : s.facets)
    for (int v : f)
      area[v] += norm(cross(s.vertices[f[1]] - s.vertices[f[0]], s.vertices[f[2]] - s.vertices[f[0]])) / 6.0;
  return area;
}

Kernel lucy(double width) { return {KernelShape::lucy, 2, width}; }
Projection symmetricMap(const TestSurface& s, const Kernel& kernel) {
  return symmetricKernelMap(kernel, s.vertices, s.facets, s.patchOfFacet, s.localMap);
}
Projection vertexMap(const TestSurface& s, const Kernel& kernel) {
  return symmetricKernelMap(kernel, s.vertices, s.facets, s.patchOfFacet,
                            identityProjection(static_cast<int>(s.vertices.size())));
}
Projection plainMap(const TestSurface& s, const Kernel& kernel) {
  SurfaceKernelRows rows({kernel, KernelCorrection::none}, s.vertices, s.facets, s.patchOfFacet, s.localMap);
  Projection map{s.localMap.columns, {0}, {}, {}};
  for (int v = 0; v < static_cast<int>(s.vertices.size()); ++v) {
    const auto facet = std::find_if(s.facets.begin(), s.facets.end(),
                                    [&](const auto& f) { return std::find(f.begin(), f.end(), v) != f.end(); });
    std::array<double, 3> corner{};
    for (int k = 0; k < 3; ++k) corner[k] = (*facet)[k] == v ? 1.0 : 0.0;
    rows.row(static_cast<int>(facet - s.facets.begin()), corner, map.column, map.weight);
    map.offsets.push_back(static_cast<int>(map.column.size()));
  }
  return map;
}

/// Largest departure of the nodal loads under an even traction from those of the local map, over the largest of them.
double unevenness(const TestSurface& s, const Projection& map) {
  const std::vector<double> traction = areas(s);
  std::vector<double> even(s.nodes.size(), 0.0), load(s.nodes.size(), 0.0);
  applyTransposed(s.localMap, traction, even);
  applyTransposed(map, traction, load);
  double largest = 0.0;
  for (std::size_t i = 0; i < load.size(); ++i) largest = std::max(largest, std::abs(load[i] - even[i]));
  return largest / *std::max_element(even.begin(), even.end());
}

const std::vector<double> widths{1e-6, 0.05, 0.3, 0.8, 2.0, 10.0, 1e6};

TEST(SymmetricKernel, RowsSumToOneAndWeightsAreNotNegative) {
  for (const TestSurface& s : sheets())
    for (double width : widths)
      for (KernelShape shape : {KernelShape::lucy, KernelShape::gauss}) {
        const Projection map = symmetricMap(s, {shape, 2, width});
        requireValid(map);
        EXPECT_LT(rowSumError(map), 1e-13) << "width " << width;
        EXPECT_GE(*std::min_element(map.weight.begin(), map.weight.end()), 0.0) << "width " << width;
      }
}

TEST(SymmetricKernel, IsSymmetricWithRespectToArea) {
  for (const TestSurface& s : sheets()) {
    const std::vector<double> area = areas(s);
    for (double width : {0.3, 0.8, 10.0}) {
      const Projection map = vertexMap(s, lucy(width));
      std::vector<std::vector<double>> dense(s.vertices.size(), std::vector<double>(s.vertices.size(), 0.0));
      for (int v = 0; v < map.rows(); ++v)
        for (std::size_t k = 0; k < map.rowColumns(v).size(); ++k)
          dense[v][map.rowColumns(v)[k]] = map.rowWeights(v)[k];
      for (std::size_t v = 0; v < dense.size(); ++v)
        for (std::size_t l = 0; l < v; ++l)
          EXPECT_NEAR(area[v] * dense[v][l], area[l] * dense[l][v], 1e-15) << v << " " << l;
    }
  }
}

TEST(SymmetricKernel, AnEvenTractionStaysEven) {
  for (const TestSurface& s : sheets())
    for (double width : widths) EXPECT_LT(unevenness(s, symmetricMap(s, lucy(width))), 1e-12) << "width " << width;
}

TEST(SymmetricKernel, WhichItDoesNotWithoutCorrection) {
  const TestSurface s = sheet(3, 8, 0.8, 3.0);
  for (double width : {0.3, 0.8, 2.0}) EXPECT_GT(unevenness(s, plainMap(s, lucy(width))), 0.01) << "width " << width;
}

/// With mirror images the spread along a rectangle is the same for every vertex across, so that a cylindrically bent
/// sheet stays cylindrical; without, it is not.
TEST(SymmetricKernel, BendsNoCylinderAcross) {
  const TestSurface s = sheet(3, 12, 0.8, 6.0);
  std::vector<double> bent;
  for (const Vec3& x : s.nodes) bent.push_back((x.y - 3.0) * (x.y - 3.0));
  for (double width : {0.8, 2.0}) {
    const auto spreadAcross = [&](const Projection& map) {
      std::vector<double> after(s.vertices.size());
      apply(map, bent, after);
      double largest = 0.0;
      for (int j = 0; j <= 12; ++j)
        for (int i = 1; i <= 3; ++i) largest = std::max(largest, std::abs(after[4 * j + i] - after[4 * j]));
      return largest;
    };
    const double plain = spreadAcross(plainMap(s, lucy(width)));
    EXPECT_GT(plain, 3e-3 * width * width) << "width " << width;
    EXPECT_LT(spreadAcross(symmetricMap(s, lucy(width))), 0.02 * plain) << "width " << width;
  }
}

TEST(SymmetricKernel, TheWidestIsTheMeanOverThePatch) {
  for (const TestSurface& s : sheets()) {
    const std::vector<double> area = areas(s);
    double total = 0.0;
    for (double a : area) total += a;
    std::vector<double> mean(s.nodes.size(), 0.0);
    applyTransposed(s.localMap, area, mean);
    const Projection map = symmetricMap(s, lucy(1e6));
    for (int v = 0; v < map.rows(); ++v)
      for (std::size_t k = 0; k < map.rowColumns(v).size(); ++k)
        EXPECT_NEAR(map.rowWeights(v)[k], mean[map.rowColumns(v)[k]] / total, 1e-10);
  }
}

TEST(SymmetricKernel, WidthZeroIsTheLocalMapAndSmallWidthsTendToIt) {
  const TestSurface s = sheet(3, 8, 0.8, 3.0);
  const Projection zero = symmetricMap(s, lucy(0.0));
  EXPECT_EQ(zero.column, s.localMap.column);
  EXPECT_EQ(zero.weight, s.localMap.weight);
  const auto distance = [&](double width) {
    testing::RandomState random(3);
    std::vector<double> field, here(s.vertices.size()), local(s.vertices.size());
    for (std::size_t i = 0; i < s.nodes.size(); ++i) field.push_back(random.number(-1.0, 1.0));
    apply(symmetricMap(s, lucy(width)), field, here);
    apply(s.localMap, field, local);
    double largest = 0.0;
    for (std::size_t v = 0; v < here.size(); ++v) largest = std::max(largest, std::abs(here[v] - local[v]));
    return largest;
  };
  EXPECT_LT(distance(1e-3), 1e-2);
  EXPECT_NEAR(distance(1e-5) / distance(1e-3), 1e-2, 1e-3);
}

TEST(SymmetricKernel, RefusesWhatItCannotDo) {
  const TestSurface s = sheet(2, 2, 1.0, 1.0);
  const auto map = [&](const Kernel& kernel, std::vector<int> patches, std::vector<Vec3> vertices) {
    return symmetricKernelMap(kernel, vertices, s.facets, patches, s.localMap);
  };
  EXPECT_THROW(map(lucy(-1.0), s.patchOfFacet, s.vertices), InputError);
  EXPECT_THROW(map(lucy(std::numeric_limits<double>::quiet_NaN()), s.patchOfFacet, s.vertices), InputError);
  EXPECT_THROW(map(lucy(0.3), {1, 2}, s.vertices), InputError);
  std::vector<int> two = s.patchOfFacet;
  two[0] = 8;
  EXPECT_THROW(map(lucy(0.3), two, s.vertices), InputError);
  std::vector<Vec3> lone = s.vertices;
  lone.push_back({5.0, 5.0, 5.0});
  Projection longer = s.localMap;
  longer.column.push_back(0);
  longer.weight.push_back(1.0);
  longer.offsets.push_back(static_cast<int>(longer.column.size()));
  EXPECT_THROW(symmetricKernelMap(lucy(0.3), lone, s.facets, s.patchOfFacet, longer), InputError);
  EXPECT_THROW(
      (SurfaceKernelRows{{lucy(0.3), KernelCorrection::symmetric}, s.vertices, s.facets, s.patchOfFacet, s.localMap}),
      InputError);
}

}  // namespace
}  // namespace dovetail::cg
