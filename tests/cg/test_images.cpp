// Which images of points a periodic cell has.
#include <gtest/gtest.h>

#include "dovetail/cg/images.hpp"
#include "dovetail/core/error.hpp"
#include "random_state.hpp"

namespace dovetail::cg {
namespace {

TEST(PeriodicImages, CountEachPointOnceWithoutReachAndAlongAxesThatDoNotRepeat) {
  const std::vector<Vec3> cloud = testing::RandomState(2).vectors(60, -0.4, 2.0);  // not all of them in the box
  const geometry::Box box{{0, 0, 0}, {1.0, 0.8, 0.9}};
  const geometry::Periodicity every{box, {true, true, true}};
  const PeriodicImages once = periodicImages(cloud, every, 0.0);
  ASSERT_EQ(once.size(), cloud.size());
  for (const Vec3& x : once.moved(cloud))
    for (int k = 0; k < 3; ++k) EXPECT_TRUE(x[k] >= box.lower[k] && x[k] <= box.upper[k]);
  EXPECT_EQ(periodicImages(cloud, {box, {false, false, false}}, 5.0).moved(cloud), cloud);
  EXPECT_THROW(periodicImages(cloud, {{{0, 0, 0}, {1, 0, 1}}, {true, true, true}}, 0.1), InputError);
  EXPECT_THROW(periodicImages(cloud, every, -0.1), InputError);
  EXPECT_THROW(periodicImages(cloud, every, 26.0), InputError);
}

}  // namespace
}  // namespace dovetail::cg
