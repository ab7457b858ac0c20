// Fields of a scene that is moved, turned, drifting, repeated, cut into parts or averaged over time.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "dovetail/core/error.hpp"
#include "random_cloud.hpp"

namespace dovetail::cg {
namespace {

using namespace testing;

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
  // Fields are sums over particles, so the mean over frames is one scene with all their particles, each with the
  // fraction of its frame's time in its mass.
  RandomState random(10);
  const Kernel kernel{KernelShape::lucy, 3, 0.2};  // some points are empty in some frames
  const auto points = random.vectors(60, -0.7, 0.7);
  TimeMean mean;
  Cloud all;
  const std::vector<double> duration{0.3, 0.1, 0.4, 0.2};
  for (const double time : duration) {
    const Cloud frame = randomContacts(random, 30);
    addFrame(mean, sample(kernel, points, frame.snapshot()), time);
    const auto append = [&](auto& to, const auto& values, double fraction) {
      for (const auto& value : values) to.push_back(fraction * value);
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

}  // namespace
}  // namespace dovetail::cg
