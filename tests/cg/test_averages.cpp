// Solid fraction, coordination, fabric and the stress after Love and Weber.
#include <gtest/gtest.h>

#include <numbers>

#include "dovetail/cg/averages.hpp"
#include "dovetail/core/error.hpp"
#include "random_state.hpp"

namespace dovetail::cg {
namespace {

using Eigen::Matrix3d;
using testing::RandomState;

constexpr double pi = std::numbers::pi;

TEST(SphereInBox, HasItsClosedFormsForCapsQuartersAndCorners) {
  const double r = 0.7, full = 4.0 / 3.0 * pi * r * r * r;
  const Vec3 far{10, 10, 10};
  EXPECT_NEAR(sphereInBox({1, 2, 3}, r, {-far, far}), full, 1e-14);
  EXPECT_EQ(sphereInBox({1, 2, 3}, r, {{2, 2, 2}, far}), 0.0);
  for (const double h : {0.01, 0.3, 0.7, 1.1, 1.39}) {
    const double cap = pi * h * h * (3.0 * r - h) / 3.0;
    for (int k = 0; k < 3; ++k) {
      Vec3 lower = -far, upper = far;
      lower[k] = r - h;
      EXPECT_NEAR(sphereInBox({}, r, {lower, far}), cap, 1e-11 * full) << k << " " << h;
      upper[k] = h - r;
      EXPECT_NEAR(sphereInBox({}, r, {-far, upper}), cap, 1e-11 * full) << k << " " << h;
    }
  }
  EXPECT_NEAR(sphereInBox({}, r, {{0, 0, 0}, far}), full / 8.0, 1e-12);
  EXPECT_NEAR(sphereInBox({}, r, {{0, 0, -10}, far}), full / 4.0, 1e-12);
  EXPECT_NEAR(sphereInBox({}, r, {{-0.3, -0.2, -0.1}, {0.1, 0.2, 0.3}}), 0.4 * 0.4 * 0.4, 1e-12);
}

TEST(SphereInBox, PartsOfAPartitionAddUpAndAxesAreAlike) {
  RandomState random(2);
  for (int round = 0; round < 100; ++round) {
    const double r = random.number(0.2, 1.0), full = 4.0 / 3.0 * pi * r * r * r;
    const Vec3 x = random.vector(-0.6, 0.6), cut = random.vector(-0.6, 0.6);
    double sum = 0.0;
    for (int part = 0; part < 8; ++part) {
      AverageBox box{{-3, -3, -3}, {3, 3, 3}};
      for (int k = 0; k < 3; ++k) (part >> k & 1 ? box.lower : box.upper)[k] = cut[k];
      const double volume = sphereInBox(x, r, box);
      sum += volume;
      const auto turned = [](const Vec3& a) { return Vec3{a.y, a.z, a.x}; };
      ASSERT_NEAR(sphereInBox(turned(x), r, {turned(box.lower), turned(box.upper)}), volume, 2e-11 * full) << round;
    }
    ASSERT_NEAR(sum, full, 2e-11 * full) << round;
  }
}

TEST(SphereInBox, AgreesWithRandomPointsInNarrowBoxes) {
  RandomState random(3);
  for (int round = 0; round < 5; ++round) {
    const Vec3 lower = random.vector(-0.8, 0.2), upper = lower + random.vector(0.2, 0.7);
    const int n = 200000;
    int hits = 0;
    for (int i = 0; i < n; ++i) {
      const Vec3 p{random.number(lower.x, upper.x), random.number(lower.y, upper.y), random.number(lower.z, upper.z)};
      hits += squaredNorm(p) < 1.0;
    }
    const AverageBox box{lower, upper};
    EXPECT_NEAR(sphereInBox({}, 1.0, box) / box.volume(), double(hits) / n, 5.0 * 0.5 / std::sqrt(n));
  }
  EXPECT_THROW(sphereInBox({}, 1.0, {{0, 0, 0}, {1, 0, 1}}), InputError);
  EXPECT_THROW(sphereInBox({}, -1.0, {{0, 0, 0}, {1, 1, 1}}), InputError);
}

TEST(SolidFraction, OfALatticeIsExactForAnyBoxOfWholePeriodsAndItsFieldIntegratesToTheVolume) {
  std::vector<Vec3> x;
  for (int i = -1; i < 5; ++i)
    for (int j = -1; j < 5; ++j)
      for (int k = -1; k < 5; ++k) x.push_back({double(i), double(j), double(k)});
  const std::vector<double> radius(x.size(), 0.5);
  EXPECT_NEAR(solidFraction(x, radius, {{0.3, 0.1, 0.75}, {2.3, 3.1, 1.75}}), pi / 6.0, 1e-11);
  const std::vector<Vec3> one{{0.1, 0.2, 0.3}};
  const Kernel kernel{KernelShape::lucy, 3, 0.5};
  const double h = 0.02;
  double total = 0.0;
  const std::vector<Vec3> rest(1);
  const std::vector<double> mass(1), volume{4.0 / 3.0 * pi * 0.064};
  const auto points = gridPoints({{-0.5, -0.4, -0.3}, {h, h, h}, {61, 61, 61}});
  for (const double phi : sample(kernel, points, {.particles = {one, rest, mass, volume}}).solidFraction)
    total += phi * h * h * h;
  EXPECT_NEAR(total, 4.0 / 3.0 * pi * 0.064, 1e-5);
}

TEST(Coordination, CountsContactsAndLeavesRattlersOutOneAfterTheOther) {
  // A tetrahedron (3 contacts each) standing on a wall with all four; a chain hangs on it; one is alone.
  const std::vector<int> first{0, 0, 0, 1, 1, 2, 0, 1, 2, 3, 3, 4};
  const std::vector<int> second{1, 2, 3, 2, 3, 3, -1, -1, -1, -1, 4, 5};
  const Coordination c = coordination(first, second, 7);
  EXPECT_EQ(c.contacts, (std::vector<int>{4, 4, 4, 5, 2, 1, 0}));
  EXPECT_DOUBLE_EQ(c.mean, 20.0 / 7.0);
  EXPECT_EQ(c.rattlers, 3);
  EXPECT_DOUBLE_EQ(c.withoutRattlers, 4.0);
  EXPECT_EQ(coordination(first, second, 7, 2).rattlers, 3);
  EXPECT_EQ(coordination(first, second, 7, 5).rattlers, 7);
  EXPECT_THROW(coordination(first, second, 5), InputError);
}

TEST(Fabric, HasTraceOneAndIsIsotropicForACube) {
  const std::vector<Vec3> cube{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  EXPECT_LE((fabric(cube) - Matrix3d::Identity() / 3.0).norm(), 1e-15);
  RandomState random(5);
  std::vector<Vec3> normal, place;
  for (int i = 0; i < 4000; ++i) {
    Vec3 n = random.vector(-1.0, 1.0);
    while (squaredNorm(n) > 1.0) n = random.vector(-1.0, 1.0);
    normal.push_back(normalized(n));
    place.push_back(random.vector(-1.0, 1.0));
  }
  EXPECT_NEAR(fabric(normal).trace(), 1.0, 1e-12);
  EXPECT_LE((fabric(normal) - Matrix3d::Identity() / 3.0).norm(), 0.03);
  const std::vector<Vec3> points{{0, 0, 0}, {9, 9, 9}};
  const auto field = fabricField({KernelShape::lucy, 3, 0.8}, points, place, normal);
  EXPECT_NEAR(field[0].trace(), 1.0, 1e-12);
  EXPECT_EQ(field[1].norm(), 0.0);
  EXPECT_EQ(fabric({}).norm(), 0.0);
}

TEST(LoveWeber, OfAGasIsItsDensityTimesTheMeanSquareOfTheFluctuations) {
  RandomState random(6);
  const int n = 20000;
  std::vector<Vec3> x, v;
  std::vector<double> mass(n, 0.3);
  for (int i = 0; i < n; ++i) {
    x.push_back(random.vector(0.0, 2.0));
    v.push_back(Vec3{5, 0, 0} + random.vector(-1.0, 1.0));  // ⟨v′²⟩ = 1/3 per component
  }
  const AverageStress stress = loveWeberStress({}, {x, v, mass}, 8.0);
  const double density = n * 0.3 / 8.0;
  EXPECT_LE((stress.kinetic + density / 3.0 * Matrix3d::Identity()).norm(), 0.03 * density);
  EXPECT_NEAR(stress.pressure(), density / 3.0, 0.01 * density);
  double energy = 0.0;
  for (const Vec3& u : v) energy += 0.15 * squaredNorm(u);
  Vec3 mean;
  for (const Vec3& u : v) mean += u / n;
  EXPECT_NEAR(-stress.kinetic.trace() * 8.0, 2.0 * energy - 0.3 * n * squaredNorm(mean), 1e-10 * energy);
}

TEST(LoveWeber, BoxesSideBySideAddUpToTheWhole) {
  RandomState random(7);
  const std::vector<Vec3> from = random.vectors(300, 0.0, 1.0), to = random.vectors(300, 0.0, 1.0),
                          force = random.vectors(300, -1.0, 1.0);
  const Matrix3d whole = loveWeberStress({from, to, force}, {}, 1.0).contact;
  Matrix3d sum = Matrix3d::Zero();
  for (int part = 0; part < 27; ++part) {
    const Vec3 lower{part % 3 / 3.0, part / 3 % 3 / 3.0, part / 9 / 3.0};
    sum += loveWeberStress({from, to, force}, {}, AverageBox{lower, lower + Vec3{1 / 3.0, 1 / 3.0, 1 / 3.0}}).contact /
           27.0;
  }
  EXPECT_LE((sum - whole).norm(), 1e-12 * whole.norm());
}

TEST(LoveWeber, OfAWideBoxIsTheVolumeIntegralOfTheCoarseGrainedStress) {
  RandomState random(8);
  const std::vector<Vec3> from = random.vectors(20, -0.2, 0.2), to = random.vectors(20, -0.2, 0.2),
                          force = random.vectors(20, -1.0, 1.0);
  const double h = 0.04;
  const auto points = gridPoints({{-0.7, -0.7, -0.7}, {h, h, h}, {36, 36, 36}});
  Matrix3d integral = Matrix3d::Zero();
  const SnapshotView branches{.particles = {}, .branches = {from, to, force}};
  for (const Matrix3d& s : sample({KernelShape::lucy, 3, 0.4}, points, branches).contactStress)
    integral += h * h * h * s;
  const Matrix3d average = loveWeberStress({from, to, force}, {}, AverageBox{{-1, -1, -1}, {1, 1, 1}}).contact;
  EXPECT_LE((integral - 8.0 * average).norm(), 1e-4 * 8.0 * average.norm());
  EXPECT_THROW(loveWeberStress({from, to, force}, {}, 0.0), InputError);
}

}  // namespace
}  // namespace dovetail::cg
