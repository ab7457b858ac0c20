#include <gtest/gtest.h>

#include <cmath>

#include "../../src/cg/facet_integral.hpp"
#include "dovetail/core/vec3.hpp"

namespace dovetail::cg {
namespace {

/// By the midpoints of n strips across the first edge, each of a few pieces.
FacetIntegral sampled(const Kernel& kernel, const std::array<Vec3, 3>& corner, int n) {
  FacetIntegral sum;
  const double area = 0.5 * norm(cross(corner[1] - corner[0], corner[2] - corner[0]));
  constexpr int across = 1000;
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < across; ++k) {
      const double s = (i + 0.5) / n, t = (k + 0.5) / across;  // from corner 0 to the edge opposite
      const double l1 = s * (1.0 - t), l2 = s * t, dA = 2.0 * area * s / n / across;
      const Vec3 x = (1.0 - l1 - l2) * corner[0] + l1 * corner[1] + l2 * corner[2];
      const double w = profile(kernel.shape, norm(x) / kernel.width) * dA;
      sum.w += w;
      sum.w1 += w * l1;
      sum.w2 += w * l2;
      sum.w11 += w * l1 * l1;
      sum.w12 += w * l1 * l2;
      sum.w22 += w * l2 * l2;
    }
  return sum;
}

/// Needles whose edges have any order, two of them of one length too; they end within the support and beyond.
TEST(FacetIntegral, NeedlesAreIntegratedAsOtherFacets) {
  const Kernel kernel{KernelShape::lucy, 2, 0.1};
  const std::array<std::array<Vec3, 3>, 3> needles{{{Vec3{-0.2, 0.003, 0.01}, {0.3, 0.0, 0.0}, {0.3, 0.004, 0.0}},
                                                    {Vec3{-0.05, 0.0, 0.0}, {0.04, 0.001, 0.0}, {0.01, 0.0, 0.002}},
                                                    {Vec3{0.0, 0.02, 0.0}, {0.3, 0.021, 0.0}, {0.6, 0.02, 0.01}}}};
  FacetIntegrator integrator(kernel);
  for (const auto& needle : needles)
    for (int first = 0; first < 3; ++first) {
      std::array<Vec3, 3> corner;
      for (int k = 0; k < 3; ++k)
        corner[static_cast<std::size_t>(k)] = needle[static_cast<std::size_t>((first + k) % 3)];
      const FacetIntegral found = integrator.integrate(corner), expected = sampled(kernel, corner, 1000);
      EXPECT_GT(expected.w, 0.0);
      for (const auto& member : {&FacetIntegral::w, &FacetIntegral::w1, &FacetIntegral::w2, &FacetIntegral::w11,
                                 &FacetIntegral::w12, &FacetIntegral::w22})
        EXPECT_NEAR(found.*member, expected.*member, 2e-4 * expected.w);
    }
}

}  // namespace
}  // namespace dovetail::cg
