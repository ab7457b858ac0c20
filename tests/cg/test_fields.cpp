#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "dovetail/cg/fields.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "random_state.hpp"

namespace dovetail::cg {
namespace {

using testing::RandomState;

/// Particles, branches and wall contacts at random.
struct Cloud {
  std::vector<Vec3> x, v;
  std::vector<double> mass, volume;
  std::vector<Vec3> from, to, force;
  std::vector<Vec3> wallPoint, wallForce;
  geometry::Periodicity space{};
  SnapshotView snapshot() const { return viewOf(*this); }
  /// What has a place, and what has a direction.
  template <class Act>
  void forEachPlace(Act&& act) {
    for (auto* places : {&x, &from, &to, &wallPoint})
      for (Vec3& place : *places) act(place);
  }
  template <class Act>
  void forEachDirection(Act&& act) {
    for (auto* directions : {&v, &force, &wallForce})
      for (Vec3& direction : *directions) act(direction);
  }
};

Cloud randomCloud(RandomState& random, int n, int dimension) {
  Cloud cloud;
  cloud.x = random.vectors(n, -0.5, 0.5);
  cloud.v = random.vectors(n, -1.0, 1.0);
  for (int i = 0; i < n; ++i) {
    cloud.mass.push_back(random.number(0.5, 2.0));
    cloud.volume.push_back(random.number(0.001, 0.002));
    for (int c = dimension; c < 3; ++c) cloud.x[i][c] = 0.0;
  }
  return cloud;
}

/// With branches from very short to longer than the cloud, and walls.
Cloud randomContacts(RandomState& random, int n) {
  Cloud cloud = randomCloud(random, n, 3);
  for (int i = 0; i < n; ++i) {
    cloud.from.push_back(random.vector(-0.5, 0.5));
    cloud.to.push_back(cloud.from.back() + std::pow(10.0, random.number(-6.0, 0.3)) * random.vector(-1.0, 1.0));
  }
  cloud.force = random.vectors(n, -1.0, 1.0);
  cloud.wallPoint = random.vectors(n / 4, -0.5, 0.5);
  cloud.wallForce = random.vectors(n / 4, -1.0, 1.0);
  return cloud;
}

/// Largest difference of any field over its own largest value.
double difference(const Fields& a, const Fields& b) {
  const auto relative = [](const auto& x, const auto& y, auto&& size) {
    double largest = 0.0, off = 0.0;
    for (std::size_t p = 0; p < x.size(); ++p) {
      largest = std::max(largest, size(x[p]));
      off = std::max(off, size(x[p] - y[p]));
    }
    return off > 0.0 ? off / largest : 0.0;
  };
  const auto number = [](double x) { return std::abs(x); };
  const auto vector = [](const Vec3& x) { return norm(x); };
  const auto matrix = [](const Eigen::Matrix3d& x) { return x.norm(); };
  return std::max({relative(a.density, b.density, number), relative(a.solidFraction, b.solidFraction, number),
                   relative(a.temperature, b.temperature, number), relative(a.momentum, b.momentum, vector),
                   relative(a.velocity, b.velocity, vector), relative(a.wallForce, b.wallForce, vector),
                   relative(a.kineticStress, b.kineticStress, matrix),
                   relative(a.contactStress, b.contactStress, matrix)});
}

Eigen::Vector3d eigen(const Vec3& a) { return {a.x, a.y, a.z}; }

/// Every field by sums over everything.
Fields writtenOut(const Kernel& kernel, std::span<const Vec3> points, const Cloud& cloud) {
  const std::size_t n = points.size();
  const std::vector<Eigen::Matrix3d> zero(n, Eigen::Matrix3d::Zero());
  Fields sums{std::vector<double>(n),
              std::vector<double>(n),
              std::vector<Vec3>(n),
              std::vector<Vec3>(n),
              std::vector<double>(n),
              zero,
              zero,
              std::vector<Vec3>(n)};
  for (std::size_t p = 0; p < n; ++p) {
    for (std::size_t i = 0; i < cloud.x.size(); ++i) {
      const double w = kernel(norm(points[p] - cloud.x[i]));
      sums.density[p] += cloud.mass[i] * w;
      sums.solidFraction[p] += cloud.volume[i] * w;
      sums.momentum[p] += cloud.mass[i] * w * cloud.v[i];
    }
    if (sums.density[p] > 0.0) sums.velocity[p] = sums.momentum[p] / sums.density[p];
    for (std::size_t i = 0; i < cloud.x.size(); ++i) {
      const Eigen::Vector3d v = eigen(cloud.v[i] - sums.velocity[p]);
      sums.kineticStress[p] -= cloud.mass[i] * kernel(norm(points[p] - cloud.x[i])) * v * v.transpose();
    }
    if (sums.density[p] > 0.0) sums.temperature[p] = -sums.kineticStress[p].trace() / 3.0 / sums.density[p];
    for (std::size_t b = 0; b < cloud.from.size(); ++b)
      sums.contactStress[p] -= kernel.segmentMean(points[p] - cloud.from[b], points[p] - cloud.to[b]) *
                               eigen(cloud.force[b]) * eigen(cloud.from[b] - cloud.to[b]).transpose();
    for (std::size_t c = 0; c < cloud.wallPoint.size(); ++c)
      sums.wallForce[p] += kernel(norm(points[p] - cloud.wallPoint[c])) * cloud.wallForce[c];
  }
  return sums;
}

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

TEST(Fields, AreThoseOfTheSceneElsewhereTurnedOrMoving) {
  RandomState random(5);
  const Cloud cloud = randomContacts(random, 200);
  auto points = random.vectors(30, -0.6, 0.6);
  const Kernel kernel{KernelShape::lucy, 3, 0.3};
  const Fields here = sample(kernel, points, cloud.snapshot());

  Cloud far = cloud;
  auto farPoints = points;
  const Vec3 shift{256.0, -512.0, 1024.0};  // 3000 widths: positions are off by 1e-13, a third of 1e-12 widths
  far.forEachPlace([&](Vec3& x) { x += shift; });
  for (Vec3& x : farPoints) x += shift;
  EXPECT_LT(difference(here, sample(kernel, farPoints, far.snapshot())), 1e-10);

  Cloud moving = cloud;
  const Vec3 drift{5, -3, 8};
  for (Vec3& v : moving.v) v += drift;
  Fields boosted = sample(kernel, points, moving.snapshot());
  for (std::size_t p = 0; p < points.size(); ++p) {
    boosted.momentum[p] -= boosted.density[p] * drift;
    if (boosted.density[p] > 0.0) boosted.velocity[p] -= drift;
  }
  EXPECT_LT(difference(here, boosted), 1e-12);

  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 3).normalized()).matrix();
  const auto turned = [&](Vec3& a) {
    const Eigen::Vector3d b = turn * eigen(a);
    a = {b[0], b[1], b[2]};
  };
  Cloud other = cloud;
  other.forEachPlace(turned);
  other.forEachDirection(turned);
  for (Vec3& x : points) turned(x);
  Fields wanted = here;
  for (std::size_t p = 0; p < points.size(); ++p) {
    for (auto* field : {&wanted.momentum, &wanted.velocity, &wanted.wallForce}) turned((*field)[p]);
    for (auto* field : {&wanted.kineticStress, &wanted.contactStress})
      (*field)[p] = turn * (*field)[p] * turn.transpose();
  }
  EXPECT_LT(difference(wanted, sample(kernel, points, other.snapshot())), 1e-11);
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

TEST(Fields, OfPeriodicSpaceAreThoseOfAllImages) {
  RandomState random(8);
  Cloud cell = randomContacts(random, 80);
  cell.space = {{{-0.4, 0, 0.1}, {0.5, 0.8, 0.2}}, {true, true, false}};  // things lie outside as well
  Cloud images;
  for (int a = -6; a <= 6; ++a)
    for (int b = -6; b <= 6; ++b) {
      const Vec3 shift{0.9 * a, 0.8 * b, 0};
      Cloud moved = cell;
      moved.forEachPlace([&](Vec3& x) { x += shift; });
      const auto append = [](auto& all, const auto& more) { all.insert(all.end(), more.begin(), more.end()); };
      append(images.x, moved.x), append(images.v, moved.v), append(images.mass, moved.mass);
      append(images.volume, moved.volume), append(images.from, moved.from), append(images.to, moved.to);
      append(images.force, moved.force), append(images.wallPoint, moved.wallPoint);
      append(images.wallForce, moved.wallForce);
    }
  auto points = random.vectors(20, -0.5, 0.8);
  for (double width : {0.2, 1.3}) {
    const Kernel kernel{KernelShape::lucy, 3, width};
    const Fields wanted = writtenOut(kernel, points, images);
    EXPECT_LT(difference(wanted, sample(kernel, points, cell.snapshot())), 1e-12);
    auto elsewhere = points;
    for (Vec3& x : elsewhere) x += {-0.9 * 7, 0.8 * 11, 0};
    EXPECT_LT(difference(wanted, sample(kernel, elsewhere, cell.snapshot())), 1e-11);
  }
  EXPECT_THROW(sample({KernelShape::lucy, 3, 30.0}, points, cell.snapshot()), InputError);
}

TEST(Fields, PartsOfAParticleAddUpToIt) {
  RandomState random(9);
  const Cloud whole = randomContacts(random, 50);
  Cloud parts = whole;
  for (std::size_t i = 0; i < whole.x.size(); ++i) {
    const double w = random.number(0.1, 0.9);
    parts.x.push_back(whole.x[i]);
    parts.v.push_back(whole.v[i]);
    parts.mass.push_back((1.0 - w) * whole.mass[i]);
    parts.mass[i] *= w;
    parts.volume.push_back((1.0 - w) * whole.volume[i]);
    parts.volume[i] *= w;
  }
  const Kernel kernel{KernelShape::gauss, 3, 0.4};
  const auto points = random.vectors(20, -0.5, 0.5);
  EXPECT_LT(difference(sample(kernel, points, whole.snapshot()), sample(kernel, points, parts.snapshot())), 1e-12);
}

TEST(TimeMean, IsTheFieldOfAllFramesAtOnce) {
  // Fields are sums over particles, so the mean over frames is one scene with all their particles, each with the share
  // of its frame's time in its mass.
  RandomState random(10);
  const Kernel kernel{KernelShape::lucy, 3, 0.2};  // some points are empty in some frames
  const auto points = random.vectors(60, -0.7, 0.7);
  TimeMean mean;
  Cloud all;
  const std::vector<double> duration{0.3, 0.1, 0.4, 0.2};
  for (const double time : duration) {
    const Cloud frame = randomContacts(random, 30);
    addFrame(mean, sample(kernel, points, frame.snapshot()), time);
    const auto append = [&](auto& to, const auto& values, double share) {
      for (const auto& value : values) to.push_back(share * value);
    };
    append(all.x, frame.x, 1), append(all.v, frame.v, 1), append(all.mass, frame.mass, time);
    append(all.volume, frame.volume, time), append(all.from, frame.from, 1), append(all.to, frame.to, 1);
    append(all.force, frame.force, time), append(all.wallPoint, frame.wallPoint, 1);
    append(all.wallForce, frame.wallForce, time);
  }
  EXPECT_NEAR(mean.time, 1.0, 1e-15);
  EXPECT_LT(difference(sample(kernel, points, all.snapshot()), mean.mean), 1e-12);
  const Fields other = sample(kernel, random.vectors(3, 0, 1), all.snapshot());
  EXPECT_THROW(addFrame(mean, other, 1.0), InputError);
  EXPECT_THROW(addFrame(mean, mean.mean, 0.0), InputError);
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
