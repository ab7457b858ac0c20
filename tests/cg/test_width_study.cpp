// The width that fields ask for, of clouds whose answer is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dovetail/cg/width_study.hpp"
#include "dovetail/core/error.hpp"
#include "random_cloud.hpp"

namespace dovetail::cg::testing {
namespace {

constexpr double pi = std::numbers::pi;
constexpr int grains = 8000;
constexpr double noise = 0.5;  // standard deviation of each component of velocity, over the flow's amplitude

/// Grains without order in a periodic cube of edge 1, that flow as sin k x along y, each with noise of its own.
Cloud flow(RandomState& random, double wavelength) {
  Cloud cloud;
  cloud.space = {{{0, 0, 0}, {1, 1, 1}}, {true, true, true}};
  cloud.x = random.vectors(grains, 0.0, 1.0);
  cloud.mass.assign(grains, 2.0);
  for (const Vec3& x : cloud.x) {
    const double uniform = noise * std::sqrt(3.0);  // such numbers between ± this
    cloud.v.push_back(Vec3{0, std::sin(2.0 * pi * x.x / wavelength), 0} + random.vector(-uniform, uniform));
  }
  return cloud;
}

/// 4π ∫ f(q) q² dq over the kernel's support.
template <class Function>
double overSupport(Function&& f) {
  return 4.0 * pi * integrate(0.0, 1.0, 30, [&](double q) { return f(q) * q * q; });
}

double sinc(double x) { return x > 0.0 ? std::sin(x) / x : 1.0; }

/// What the study should find at a width: the variance of sums over grains without order, Σ m a(x_i) ∂W/∂ln w, and the
/// part of the wave that a kernel lets through, Ŵ(k w).
struct Theory {
  double k;
  double peak = peakNumber(KernelShape::lucy, 3), spread2 = 0.5 + 3.0 * noise * noise;

  double slope(double q) const {  // of W w³ by ln w
    return -peak * (3.0 * profile(KernelShape::lucy, q) + q * profileDerivative(KernelShape::lucy, q));
  }
  double through(double kw) const {
    return peak * overSupport([&](double q) { return profile(KernelShape::lucy, q) * sinc(kw * q); });
  }
  double density(double w) const {
    const double squares = overSupport([&](double q) { return std::pow(slope(q), 2); });
    const double own = overSupport([&](double q) { return std::pow(peak * profile(KernelShape::lucy, q), 2); });
    const double count = grains * w * w * w;
    return std::sqrt(squares / count / (1.0 + own / count));
  }
  double velocity(double w) const {
    const double kw = k * w, passes = through(kw), count = grains * w * w * w;
    const double lost = (through(1.001 * kw) - through(0.999 * kw)) / 0.002;
    const double scatter = overSupport([&](double q) {
      return std::pow(slope(q), 2) *
             (3.0 * noise * noise + 0.5 * (1.0 + passes * passes - 2.0 * passes * sinc(kw * q)));
    });
    return std::sqrt((scatter / count + 0.5 * lost * lost) / spread2);
  }
  double measure(double w) const { return std::hypot(density(w), velocity(w)); }
  double best(const WidthRange& range) const {
    double best = range.least;
    for (double w = range.least; w < range.most; w *= 1.01)
      if (measure(w) < measure(best)) best = w;
    return best;
  }
};

// From widths on that hold so many grains that their scatter is small, as the theory takes it to be.
constexpr WidthRange range{.least = 0.11, .most = 0.4};

WidthStudy studyOf(const Cloud& cloud, std::span<const Vec3> points) {
  return studyWidths(KernelShape::lucy, 3, points, cloud.snapshot(), range);
}

TEST(WidthStudy, FindsTheCurveAndTheOptimumOfTheory) {
  RandomState random(11);
  std::vector<double> found;
  for (const double wavelength : {1.0, 0.5}) {
    const WidthStudy study = studyOf(flow(random, wavelength), random.vectors(250, 0.0, 1.0));
    const Theory theory{2.0 * pi / wavelength};
    ASSERT_EQ(study.curve.at.size(), static_cast<std::size_t>(range.samples));
    for (std::size_t s = 0; s < study.curve.at.size(); ++s) {
      const double w = study.curve.at[s];
      EXPECT_NEAR(study.velocity[s], theory.velocity(w), 0.12 * theory.velocity(w)) << w;
      EXPECT_NEAR(study.density[s], theory.density(w), 0.25 * theory.density(w)) << w;  // few kernels fill the cube
    }
    const double best = theory.best(range);
    EXPECT_LT(study.curve.lower, best);
    EXPECT_GT(study.curve.upper, best);
    EXPECT_FALSE(study.curve.lowerOpen || study.curve.upperOpen);
    EXPECT_GT(study.curve.curvature, 0.0);
    found.push_back(study.curve.best);
  }
  // Noise falls as w^(−3/2), what is lost of the wave grows as (k w)²: least at w ~ k^(−4/7).
  EXPECT_NEAR(found[0] / found[1], std::pow(2.0, 4.0 / 7.0), 0.2);
}

TEST(WidthStudy, ChoosesAWidthWhoseVelocityIsNearlyAsGoodAsAnyCouldBe) {
  RandomState random(12);
  const Cloud cloud = flow(random, 0.5);
  const std::vector<Vec3> points = random.vectors(250, 0.0, 1.0);
  const auto error = [&](double width) {
    const Fields fields = sample({KernelShape::lucy, 3, width}, points, cloud.snapshot());
    double sum = 0.0;
    for (std::size_t p = 0; p < points.size(); ++p)
      sum += squaredNorm(fields.velocity[p] - Vec3{0, std::sin(4.0 * pi * points[p].x), 0});
    return std::sqrt(sum / static_cast<double>(points.size()));
  };
  double least = 1.0;
  for (double width = range.least; width < range.most; width *= 1.08) least = std::min(least, error(width));
  EXPECT_LT(error(studyOf(cloud, points).curve.best), 1.15 * least);
}

TEST(WidthStudy, IsTheSameTurnedFarAwayAndInAMovingFrame) {
  RandomState random(13);
  Cloud cloud = randomCloud(random, 2000, 3);
  std::vector<Vec3> points = random.vectors(100, -0.1, 0.1);
  const WidthStudy study = studyOf(cloud, points);
  const auto turned = [](const Vec3& a) { return Vec3{0.6 * a.x - 0.8 * a.y, 0.8 * a.x + 0.6 * a.y, a.z}; };
  for (Vec3& v : cloud.v) v = turned(v) + Vec3{3, -4, 5};
  for (auto* places : {&cloud.x, &points})
    for (Vec3& x : *places) x = turned(x) + Vec3{1e3, -2e3, 4e2};
  const WidthStudy other = studyOf(cloud, points);
  EXPECT_EQ(other.curve.best, study.curve.best);
  for (std::size_t s = 0; s < study.density.size(); ++s) {
    EXPECT_NEAR(other.density[s], study.density[s], 1e-9 * study.density[s]);
    EXPECT_NEAR(other.velocity[s], study.velocity[s], 1e-9 * study.velocity[s]);
  }
  std::ranges::fill(cloud.v, Vec3{1, 2, 3});
  EXPECT_EQ(studyOf(cloud, points).velocity, std::vector<double>(study.velocity.size(), 0.0));
}

TEST(WidthStudy, RefusesRangesAndPointsWithoutAnAnswer) {
  RandomState random(14);
  const Cloud cloud = randomCloud(random, 50, 3);
  const std::vector<Vec3> here{{0, 0, 0}}, nowhere{{9, 9, 9}};
  const auto study = [&](std::span<const Vec3> points, const WidthRange& widths) {
    return studyWidths(KernelShape::lucy, 3, points, cloud.snapshot(), widths);
  };
  EXPECT_THROW(study(here, {.least = 0.2, .most = 0.1}), InputError);
  EXPECT_THROW(study(here, {.least = 0.0, .most = 0.1}), InputError);
  EXPECT_THROW(study(here, {.least = 0.1, .most = 0.2, .samples = 2}), InputError);
  EXPECT_THROW(study(nowhere, {.least = 0.1, .most = 0.2}), InputError);
  EXPECT_THROW(study({}, {.least = 0.1, .most = 0.2}), InputError);
}

}  // namespace
}  // namespace dovetail::cg::testing
