#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "dovetail/cg/fields.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "random_cloud.hpp"

namespace dovetail::cg {
namespace {

using namespace testing;

/// Largest relative error of ∫ρ = Σm and ∫j = Σmv on a grid of n points per direction that holds all supports.
double totalsError(const Kernel& kernel, const Cloud& cloud, int n) {
  const double half = 0.5 + kernel.width, h = 2.0 * half / n;
  Grid grid{{-half + 0.5 * h, 0, 0}, {h, h, h}, {n, 1, 1}};
  for (int c = 1; c < kernel.dimension; ++c) {
    grid.count[c] = n;
    grid.lower[c] = grid.lower.x;
  }
  const Fields fields = sample(kernel, gridPoints(grid), cloud.snapshot());
  const double cell = std::pow(h, kernel.dimension);
  double mass = 0.0;
  Vec3 momentum;
  for (std::size_t p = 0; p < fields.density.size(); ++p) {
    mass += cell * fields.density[p];
    momentum += cell * fields.momentum[p];
  }
  double massExact = 0.0;
  Vec3 momentumExact;
  for (std::size_t i = 0; i < cloud.x.size(); ++i) {
    massExact += cloud.mass[i];
    momentumExact += cloud.mass[i] * cloud.v[i];
  }
  return std::max(std::abs(mass / massExact - 1.0), norm(momentum - momentumExact) / massExact);
}

TEST(Fields, TotalsAreTheParticlesForEveryWidth) {
  // Lucy has a jump in its third derivative, so sums over midpoints converge at least with h⁴.
  RandomState random(1);
  const int points[] = {4000, 600, 100};
  const double tolerance[] = {1e-10, 1e-8, 2e-6};
  for (int d = 1; d <= 3; ++d) {
    const Cloud cloud = randomCloud(random, 12, d);
    for (double width : {0.2, 0.5, 2.0}) {
      const Kernel kernel{KernelShape::lucy, d, width};
      const double fine = totalsError(kernel, cloud, points[d - 1]);
      EXPECT_LT(fine, tolerance[d - 1]) << "dimension " << d << ", width " << width;
      EXPECT_LT(fine, totalsError(kernel, cloud, points[d - 1] / 4) / 50.0 + 1e-14);
    }
  }
}

TEST(Fields, VelocityIsTheMassWeightedMean) {
  RandomState random(2);
  Cloud cloud = randomCloud(random, 200, 3);
  const Kernel kernel{KernelShape::gauss, 3, 0.4};
  const auto points = random.vectors(50, -0.6, 0.6);
  for (Vec3& v : cloud.v) v = {1.5, -2.0, 0.25};
  const Fields uniform = sample(kernel, points, cloud.snapshot());
  for (std::size_t p = 0; p < points.size(); ++p)
    if (uniform.density[p] > 0.0) {
      EXPECT_LT(norm(uniform.velocity[p] - Vec3{1.5, -2.0, 0.25}), 1e-14);
    }
  const Fields outside = sample(kernel, std::vector<Vec3>{{9, 9, 9}}, cloud.snapshot());
  EXPECT_EQ(outside.density[0], 0.0);
  EXPECT_EQ(outside.velocity[0], Vec3{});
}

TEST(Fields, MatchTheSumsWrittenOut) {
  RandomState random(3);
  const Cloud cloud = randomContacts(random, 300);
  const auto points = random.vectors(40, -0.9, 0.9);
  for (KernelShape shape : {KernelShape::lucy, KernelShape::gauss})
    for (double width : {0.1, 0.3, 3.0}) {
      const Kernel kernel{shape, 3, width};
      EXPECT_LT(difference(writtenOut(kernel, points, cloud), sample(kernel, points, cloud.snapshot())), 1e-12);
    }
}

TEST(Fields, AreTheSameForAnyNumberOfThreads) {
  RandomState random(4);
  const Cloud cloud = randomContacts(random, 300);
  const auto points = random.vectors(500, -0.6, 0.6);
  const Kernel kernel{KernelShape::lucy, 3, 0.3};
  const Fields one = sample(kernel, points, cloud.snapshot());
  for (int count : {2, 3}) {
    setThreads(count);
    const Fields many = sample(kernel, points, cloud.snapshot());
    EXPECT_EQ(one.density, many.density);
    EXPECT_EQ(one.solidFraction, many.solidFraction);
    EXPECT_EQ(one.momentum, many.momentum);
    EXPECT_EQ(one.temperature, many.temperature);
    EXPECT_EQ(one.kineticStress, many.kineticStress);
    EXPECT_EQ(one.contactStress, many.contactStress);
    EXPECT_EQ(one.wallForce, many.wallForce);
  }
  setThreads(1);
}

TEST(Fields, DensityChangesByWhatMomentumCarriesAway) {
  // ∂t ρ + ∇·j = 0 at every point: central differences in time and space err at second order only.
  RandomState random(6);
  const Cloud cloud = randomCloud(random, 300, 3);
  const Kernel kernel{KernelShape::lucy, 3, 0.4};
  const auto points = random.vectors(20, -0.5, 0.5);
  const auto residual = [&](double h) {
    const auto density = [&](double t) {
      Cloud moved = cloud;
      for (std::size_t i = 0; i < moved.x.size(); ++i) moved.x[i] += t * moved.v[i];
      return sample(kernel, points, moved.snapshot()).density;
    };
    const auto momentum = [&](int axis, double s) {
      auto shifted = points;
      for (Vec3& x : shifted) x[axis] += s;
      return sample(kernel, shifted, cloud.snapshot()).momentum;
    };
    const auto later = density(h), before = density(-h);
    std::vector<double> sum(points.size());
    double size = 0.0, worst = 0.0;
    for (std::size_t p = 0; p < points.size(); ++p) {
      sum[p] = (later[p] - before[p]) / (2.0 * h);
      size = std::max(size, std::abs(sum[p]));
    }
    for (int c = 0; c < 3; ++c) {
      const auto ahead = momentum(c, h), behind = momentum(c, -h);
      for (std::size_t p = 0; p < points.size(); ++p) sum[p] += (ahead[p][c] - behind[p][c]) / (2.0 * h);
    }
    for (const double r : sum) worst = std::max(worst, std::abs(r) / size);
    return worst;
  };
  const double coarse = residual(4e-3), fine = residual(1e-3);
  EXPECT_LT(fine, 1e-3);
  EXPECT_LT(fine, coarse / 12.0);
}

TEST(Fields, TemperatureIsTheVarianceOfOneComponent) {
  RandomState random(7);
  Cloud cloud = randomCloud(random, 20000, 3);
  const Kernel kernel{KernelShape::lucy, 3, 0.5};
  const std::vector<Vec3> points{{0, 0, 0}, {0.2, -0.1, 0.1}};
  const Fields gas = sample(kernel, points, cloud.snapshot());
  for (std::size_t p = 0; p < 2; ++p) {
    EXPECT_NEAR(gas.temperature[p], 1.0 / 3.0, 0.02);  // some 2000 particles count
    EXPECT_LT((gas.kineticStress[p] + gas.density[p] / 3.0 * Eigen::Matrix3d::Identity()).norm(),
              0.05 * gas.density[p]);
  }
  // Opposite velocities u at one place: v = 0 and T = |u|²/3, exactly.
  const std::vector<Vec3> x(2, Vec3{0.1, 0, 0}), v{{1, 2, -2}, {-1, -2, 2}};
  const std::vector<double> mass(2, 0.7);
  const Fields pair = sample(kernel, points, {.particles = {x, v, mass}});
  EXPECT_NEAR(pair.temperature[0], 3.0, 1e-14);
  EXPECT_EQ(pair.velocity[0], Vec3{});
}

TEST(Fields, GridsRunWithXFastest) {
  const auto points = gridPoints({{1, 2, 3}, {0.5, 0, 0.25}, {2, 1, 2}});
  ASSERT_EQ(points.size(), 4u);
  EXPECT_EQ(points[1], (Vec3{1.5, 2, 3}));
  EXPECT_EQ(points[2], (Vec3{1, 2, 3.25}));
  EXPECT_THROW(gridPoints({{}, {1, 1, 1}, {2, 0, 2}}), InputError);
  EXPECT_THROW(gridPoints({{}, {1, -1, 1}, {2, 2, 2}}), InputError);
}

TEST(Fields, NothingGivesZeros) {
  const std::vector<Vec3> points(3);
  const Fields fields = sample({KernelShape::lucy, 3, 0.5}, points, {});
  EXPECT_EQ(fields.size(), 3u);
  EXPECT_TRUE(fields.solidFraction.empty());
  EXPECT_EQ(fields.density[2], 0.0);
  EXPECT_EQ(fields.stress(1).norm(), 0.0);
  EXPECT_EQ(sample({KernelShape::lucy, 3, 0.5}, {}, {}).size(), 0u);
}

TEST(Fields, BadInputIsRefusedByName) {
  RandomState random(11);
  const Cloud good = randomContacts(random, 8);
  const std::vector<Vec3> points(2);
  const Kernel kernel{KernelShape::lucy, 3, 0.5};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double width : {0.0, -1.0, 1e-200, nan})
    EXPECT_THROW(sample({KernelShape::lucy, 3, width}, points, good.snapshot()), InputError) << width;
  const auto refused = [&](auto&& spoil, const std::string& name) {
    Cloud bad = good;
    auto at = points;
    spoil(bad, at);
    try {
      sample(kernel, at, bad.snapshot());
      ADD_FAILURE() << "no error for " << name;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    }
  };
  refused([&](Cloud& c, auto&) { c.x[3].y = nan; }, "particle 3");
  refused([&](Cloud& c, auto&) { c.v[4].z = nan; }, "velocity");
  refused([&](Cloud& c, auto&) { c.mass[2] = -1.0; }, "mass");
  refused([&](Cloud& c, auto&) { c.volume[1] = nan; }, "volume");
  refused([&](Cloud& c, auto&) { c.to[5].x = nan; }, "contact branch 5");
  refused([&](Cloud& c, auto&) { c.force[5].x = nan; }, "force");
  refused([&](Cloud& c, auto&) { c.wallPoint[1].x = nan; }, "wall contact 1");
  refused([&](Cloud&, auto& at) { at[1].x = nan; }, "point 1");
  refused([&](Cloud& c, auto&) { c.mass.pop_back(); }, "masses");
  refused([&](Cloud& c, auto&) { c.to.pop_back(); }, "branches");
  refused([&](Cloud& c, auto&) { c.wallForce.pop_back(); }, "walls");
}

}  // namespace
}  // namespace dovetail::cg
