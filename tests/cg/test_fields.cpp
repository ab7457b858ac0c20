#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "dovetail/cg/fields.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "random_state.hpp"

namespace dovetail::cg {
namespace {

using testing::RandomState;

struct Cloud {
  std::vector<Vec3> x, v;
  std::vector<double> mass;
  ParticleView view() const { return {x, v, mass}; }
};

Cloud randomCloud(RandomState& random, int n, int dimension) {
  Cloud cloud{random.vectors(n, -0.5, 0.5), random.vectors(n, -1.0, 1.0), {}};
  for (int i = 0; i < n; ++i) {
    cloud.mass.push_back(random.number(0.5, 2.0));
    for (int c = dimension; c < 3; ++c) cloud.x[i][c] = 0.0;
  }
  return cloud;
}

/// Largest relative error of ∫ρ = Σm and ∫j = Σmv on a grid of n points per direction that holds all supports.
double totalsError(const Kernel& kernel, const Cloud& cloud, int n) {
  const double half = 0.5 + kernel.width, h = 2.0 * half / n;
  Grid grid{{-half + 0.5 * h, 0, 0}, {h, h, h}, {n, 1, 1}};
  for (int c = 1; c < kernel.dimension; ++c) {
    grid.count[c] = n;
    grid.lower[c] = grid.lower.x;
  }
  const Fields fields = particleFields(kernel, gridPoints(grid), cloud.view());
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
  const Fields uniform = particleFields(kernel, points, cloud.view());
  for (std::size_t p = 0; p < points.size(); ++p)
    if (uniform.density[p] > 0.0) {
      EXPECT_LT(norm(uniform.velocity[p] - Vec3{1.5, -2.0, 0.25}), 1e-14);
    }
  const Fields outside = particleFields(kernel, std::vector<Vec3>{{9, 9, 9}}, cloud.view());
  EXPECT_EQ(outside.density[0], 0.0);
  EXPECT_EQ(outside.velocity[0], Vec3{});
}

TEST(Fields, MatchTheSumWrittenOut) {
  RandomState random(3);
  const Cloud cloud = randomCloud(random, 300, 3);
  const Kernel kernel{KernelShape::lucy, 3, 0.3};
  const auto points = random.vectors(40, -0.6, 0.6);
  const Fields fields = particleFields(kernel, points, cloud.view());
  for (std::size_t p = 0; p < points.size(); ++p) {
    double density = 0.0;
    Vec3 momentum;
    for (std::size_t i = 0; i < cloud.x.size(); ++i) {
      density += cloud.mass[i] * kernel(norm(points[p] - cloud.x[i]));
      momentum += cloud.mass[i] * kernel(norm(points[p] - cloud.x[i])) * cloud.v[i];
    }
    EXPECT_NEAR(fields.density[p], density, 1e-13 * kernel.peak());
    EXPECT_LT(norm(fields.momentum[p] - momentum), 1e-12 * kernel.peak());
  }
}

TEST(Fields, AreTheSameForAnyNumberOfThreads) {
  RandomState random(4);
  const Cloud cloud = randomCloud(random, 300, 3);
  const auto points = random.vectors(500, -0.6, 0.6);
  const Kernel kernel{KernelShape::lucy, 3, 0.3};
  const Fields one = particleFields(kernel, points, cloud.view());
  for (int count : {2, 3}) {
    setThreads(count);
    const Fields many = particleFields(kernel, points, cloud.view());
    EXPECT_EQ(one.density, many.density);
    EXPECT_EQ(one.momentum, many.momentum);
  }
  setThreads(1);
}

TEST(Fields, GridsRunWithXFastest) {
  const auto points = gridPoints({{1, 2, 3}, {0.5, 0, 0.25}, {2, 1, 2}});
  ASSERT_EQ(points.size(), 4u);
  EXPECT_EQ(points[1], (Vec3{1.5, 2, 3}));
  EXPECT_EQ(points[2], (Vec3{1, 2, 3.25}));
  EXPECT_THROW(gridPoints({{}, {1, 1, 1}, {2, 0, 2}}), InputError);
  EXPECT_THROW(gridPoints({{}, {1, -1, 1}, {2, 2, 2}}), InputError);
}

TEST(Fields, BoundaryLoadsIntegrateToTheReactionOfTheContacts) {
  const std::vector<Vec3> contact{{0.1, 0.05, 0}, {-0.2, 0.15, 0}}, force{{1, 2, 30}, {-4, 0.5, 12}};
  const int n = 400;
  const double h = 2.0 / n;
  const auto plane = gridPoints({{-1 + 0.5 * h, -1 + 0.5 * h, 0}, {h, h, 0}, {n, n, 1}});
  Vec3 total;
  for (const Vec3& t : surfaceTraction({KernelShape::lucy, 2, 0.6}, plane, contact, force)) total += h * h * t;
  EXPECT_LT(norm(total - Vec3{3, -2.5, -42}), 1e-7);
  const Kernel volume{KernelShape::lucy, 3, 0.6};
  const auto density = boundaryForceDensity(volume, contact, contact, force);
  const double other = volume(norm(contact[1] - contact[0]));
  EXPECT_LT(norm(density[0] + volume(0.0) * force[0] + other * force[1]), 1e-12 * volume.peak());
}

TEST(Fields, KineticTractionIsThePressureOfTheFluctuations) {
  // Pairs of particles at one place with opposite velocities: v = 0, so t = −Σ m u (u·n) W exactly, for any drift.
  RandomState random(6);
  Cloud cloud;
  for (int i = 0; i < 40; ++i) {
    const Vec3 place = random.vector(-0.5, 0.5), u = random.vector(-1.0, 1.0);
    for (double sign : {1.0, -1.0}) {
      cloud.x.push_back(place);
      cloud.v.push_back(sign * u);
      cloud.mass.push_back(0.7);
    }
  }
  const Kernel kernel{KernelShape::lucy, 3, 0.5};
  const std::vector<Vec3> points{{0, 0, 0}, {0.2, -0.1, 0.3}}, normal{{0, 0, 1}, {0.6, 0.8, 0}};
  std::vector<Vec3> traction(2, Vec3{1, 1, 1}), moving(2), expected(2);
  addKineticTraction(kernel, points, normal, cloud.view(), traction);
  for (std::size_t p = 0; p < 2; ++p) {
    for (std::size_t i = 0; i < cloud.x.size(); ++i)
      expected[p] -= 0.7 * kernel(norm(points[p] - cloud.x[i])) * dot(cloud.v[i], normal[p]) * cloud.v[i];
    EXPECT_LT(norm(traction[p] - Vec3{1, 1, 1} - expected[p]), 1e-12 * norm(expected[p]));
    EXPECT_LT(dot(expected[p], normal[p]), 0.0);
  }
  for (Vec3& v : cloud.v) v += {3, -7, 2};
  addKineticTraction(kernel, points, normal, cloud.view(), moving);
  for (std::size_t p = 0; p < 2; ++p) EXPECT_LT(norm(moving[p] - expected[p]), 1e-12 * norm(expected[p]));
}

TEST(Fields, BadInputIsRefused) {
  RandomState random(7);
  Cloud cloud = randomCloud(random, 5, 3);
  const std::vector<Vec3> points(2);
  EXPECT_THROW(particleFields({KernelShape::lucy, 3, 0.0}, points, cloud.view()), InputError);
  EXPECT_THROW(surfaceTraction({KernelShape::lucy, 3, 0.5}, points, cloud.x, cloud.v), InputError);
  EXPECT_THROW(boundaryForceDensity({KernelShape::lucy, 3, 0.5}, points, cloud.x, points), InputError);
  cloud.x[3].y = std::numeric_limits<double>::quiet_NaN();
  try {
    particleFields({KernelShape::lucy, 3, 0.5}, points, cloud.view());
    FAIL() << "no error for a NaN";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("particle 3"), std::string::npos);
  }
  cloud.mass.pop_back();
  EXPECT_THROW(particleFields({KernelShape::lucy, 3, 0.5}, points, cloud.view()), InputError);
}

}  // namespace
}  // namespace dovetail::cg
