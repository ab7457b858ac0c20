#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "dovetail/cg/kernel.hpp"
#include "dovetail/core/error.hpp"
#include "random_state.hpp"

namespace dovetail::cg {
namespace {

using testing::integrate;
using testing::RandomState;

constexpr double pi = std::numbers::pi;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr KernelShape shapes[] = {KernelShape::lucy, KernelShape::gauss};

double sphereArea(int dimension, double r) {
  return dimension == 1 ? 2.0 : dimension == 2 ? 2 * pi * r : 4 * pi * r * r;
}

TEST(Kernel, LucyPeaksTimesWidthToTheDimension) {
  const double expected[] = {1.25, 1.59155, 2.08891};
  for (int d = 1; d <= 3; ++d) {
    const double width = 0.37;
    EXPECT_NEAR((Kernel{KernelShape::lucy, d, width}(0.0) * std::pow(width, d)), expected[d - 1], 5e-6);
  }
}

TEST(Kernel, IntegratesToOneInEveryDimension) {
  for (double width : {1e-6, 0.4, 25.0})
    for (int d = 1; d <= 3; ++d)
      for (KernelShape shape : shapes) {
        const Kernel kernel{shape, d, width};
        const double mass = integrate(0.0, width, 2000, [&](double r) { return kernel(r) * sphereArea(d, r); });
        EXPECT_NEAR(mass, 1.0, 1e-12) << "dimension " << d << ", width " << width;
      }
}

TEST(Kernel, TheUnnormalisedGaussianLosesItsTail) {
  const double percent[] = {0.27, 1.11, 2.93};
  for (int d = 1; d <= 3; ++d) {
    const double inside = integrate(0.0, 3.0, 2000, [&](double r) {
      return std::exp(-0.5 * r * r) / std::pow(2.0 * pi, 0.5 * d) * sphereArea(d, r);
    });
    EXPECT_NEAR(100.0 * (1.0 - inside), percent[d - 1], 0.005);
    EXPECT_NEAR(gaussTailMass(d), 1.0 - inside, 1e-12);
  }
}

TEST(Kernel, IsNonNegativeAndVanishesAtItsWidth) {
  for (KernelShape shape : shapes) {
    const Kernel kernel{shape, 3, 0.4};
    for (int i = 0; i <= 1000; ++i) EXPECT_GE(kernel(0.0006 * i), 0.0);
    EXPECT_GT(kernel(0.3999), 0.0);
    EXPECT_EQ(kernel(0.4), 0.0);
    EXPECT_EQ(kernel(7.0), 0.0);
    EXPECT_EQ(kernel.derivative(0.4), 0.0);
  }
}

double gradientError(const Kernel& kernel, const Vec3& x, double h) {
  double error = 0.0;
  for (int c = 0; c < 3; ++c) {
    Vec3 forward = x, backward = x;
    forward[c] += h;
    backward[c] -= h;
    const double difference = (kernel(norm(forward)) - kernel(norm(backward))) / (2.0 * h);
    error = std::max(error, std::abs(difference - kernel.gradient(x)[c]));
  }
  return error * std::pow(kernel.width, kernel.dimension + 1);
}

TEST(Kernel, GradientMatchesFiniteDifferencesAtSecondOrder) {
  RandomState random(3);
  for (KernelShape shape : shapes)
    for (int d = 1; d <= 3; ++d)
      for (int trial = 0; trial < 20; ++trial) {
        const Kernel kernel{shape, d, 0.4};
        const Vec3 x = random.number(0.05, 0.35) * normalized(random.vector(-1.0, 1.0));
        const double coarse = gradientError(kernel, x, 4e-3), fine = gradientError(kernel, x, 2e-3);
        EXPECT_NEAR(coarse / fine, 4.0, 0.1);
        EXPECT_LT(gradientError(kernel, x, 1e-5), 1e-7);
      }
  EXPECT_EQ((Kernel{KernelShape::lucy, 3, 0.4}.gradient({})), Vec3{});
}

TEST(Kernel, SegmentMeanMatchesQuadrature) {
  RandomState random(5);
  for (int trial = 0; trial < 200; ++trial) {
    const Kernel lucy{KernelShape::lucy, 3, 0.5};
    const Vec3 a = random.vector(-0.6, 0.6), b = random.vector(-0.6, 0.6);
    const auto mean = [&](const Kernel& kernel, const Vec3& from, const Vec3& to) {
      return integrate(0.0, 1.0, 4000, [&](double s) { return kernel(norm(from + s * (to - from))); });
    };
    EXPECT_NEAR(lucy.segmentMean(a, b), mean(lucy, a, b), 1e-10 * lucy.peak());
    // A segment inside the support does not meet the Gaussian's jump, which no quadrature resolves.
    const Kernel gauss{KernelShape::gauss, 3, 0.5};
    EXPECT_NEAR(gauss.segmentMean(0.4 * a, 0.4 * b), mean(gauss, 0.4 * a, 0.4 * b), 1e-12 * gauss.peak());
  }
}

TEST(Kernel, SegmentMeanIsAdditiveAndExactForRadialAndTinySegments) {
  RandomState random(6);
  for (KernelShape shape : shapes) {
    const Kernel kernel{shape, 2, 0.5};
    for (int trial = 0; trial < 200; ++trial) {
      const Vec3 a = random.vector(-0.6, 0.6), b = random.vector(-0.6, 0.6);
      const double s = random.number(0.1, 0.9);
      const Vec3 middle = a + s * (b - a);
      EXPECT_NEAR(kernel.segmentMean(a, b), s * kernel.segmentMean(a, middle) + (1 - s) * kernel.segmentMean(middle, b),
                  1e-13 * kernel.peak());
      // 2e-4 of the width takes the closed form, half of it the Gauss points.
      const Vec3 inside = 0.3 * a, step = 1e-4 * normalized(b);
      EXPECT_NEAR(kernel.segmentMean(inside, inside + step),
                  0.5 * (kernel.segmentMean(inside, inside + 0.5 * step) +
                         kernel.segmentMean(inside + 0.5 * step, inside + step)),
                  1e-11 * kernel.peak());
    }
    // Through the centre, end to end: the 1-D integral of the profile over the diameter.
    const double diameter = integrate(-1.0, 1.0, 2000, [&](double q) { return profile(shape, std::abs(q)); });
    EXPECT_NEAR(kernel.segmentMean({-0.5, 0, 0}, {0.5, 0, 0}), 0.5 * diameter * kernel.peak(), 1e-12 * kernel.peak());
    EXPECT_NEAR(kernel.segmentMean({0.1, 0, 0}, {0.1, 0, 0}), kernel(0.1), 1e-15 * kernel.peak());
    EXPECT_EQ(kernel.segmentMean({-1.0, 0.5, 0}, {1.0, 0.5, 0}), 0.0);
  }
}

TEST(Kernel, BadWidthOrDimensionIsRefused) {
  for (double width : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()})
    EXPECT_THROW((Kernel{KernelShape::lucy, 3, width}(0.1)), InputError);
  for (int dimension : {0, 4, -1}) {
    EXPECT_THROW((Kernel{KernelShape::gauss, dimension, 0.4}(0.1)), InputError);
    EXPECT_THROW(peakNumber(KernelShape::lucy, dimension), InputError);
  }
  EXPECT_NO_THROW(requireValid({KernelShape::lucy, 2, 0.0}, true));
  EXPECT_THROW(requireValid({KernelShape::lucy, 2, -1e-300}, true), InputError);
}

}  // namespace
}  // namespace dovetail::cg
