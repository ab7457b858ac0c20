#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "clouds.hpp"
#include "dovetail/core/error.hpp"

namespace dovetail::geometry {
namespace {

/// Does [low, high], or an image of it, meet [x − h, x + h]? The images are tried one by one.
bool meets(double x, double h, double low, double high, bool periodic, double length) {
  for (int image = periodic ? -8 : 0; image <= (periodic ? 8 : 0); ++image)
    if (x + image * length - h <= high && x + image * length + h >= low) return true;
  return false;
}

std::vector<int> bruteForce(const Cloud& c, double skin, const Box& box, const Periodicity& p = {}) {
  std::vector<int> ids;
  for (std::size_t i = 0; i < c.x.size(); ++i) {
    bool all = true;
    for (int k = 0; k < 3; ++k)
      all = all && meets(c.x[i][k], c.radius[i] + 0.5 * skin, box.lower[k], box.upper[k],
                         p.axes[static_cast<std::size_t>(k)], p.length(k));
    if (all) ids.push_back(static_cast<int>(i));
  }
  return ids;
}

Box randomBox(std::mt19937_64& engine, double size, double range) {
  std::uniform_real_distribution<double> place(-range, range), edge(0.0, size);
  const Vec3 lower{place(engine), place(engine), place(engine)};
  return {lower, lower + Vec3{edge(engine), edge(engine), edge(engine)}};
}

TEST(GridQueries, BoxesOfAnySizeEqualBruteForce) {
  std::mt19937_64 engine(1);
  for (double ratio : {1.0, 40.0, 1000.0}) {
    const Cloud cloud = randomCloud(1500, ratio, 1.0 / ratio, -4.0, 4.0, 2);
    HierarchicalGrid grid;
    grid.build(cloud.x, cloud.radius, 0.01);
    std::size_t hits = 0;
    for (double size : {0.0, 0.01, 0.3, 2.0, 20.0})
      for (int trial = 0; trial < 40; ++trial) {
        const Box box = randomBox(engine, size, 5.0);
        const auto ids = grid.query(box);
        EXPECT_EQ(ids, bruteForce(cloud, 0.01, box));
        hits += ids.size();
      }
    EXPECT_GT(hits, 1000u);
  }
}

TEST(GridQueries, FlatBoxesOfFacetsOnCellFaces) {
  Cloud cloud;
  for (int i = 0; i < 1000; ++i) {
    cloud.x.push_back({double(i % 10), double(i / 10 % 10), double(i / 100)});
    cloud.radius.push_back(0.5);
  }
  HierarchicalGrid grid;
  grid.build(cloud.x, cloud.radius);
  EXPECT_EQ(grid.query({{0, 0, 4.5}, {9, 9, 4.5}}).size(), 200u);  // touches two layers
  EXPECT_EQ(grid.query({{0, 0, 4.25}, {9, 9, 4.25}}).size(), 100u);
  EXPECT_EQ(grid.query({{-0.5, -0.5, -0.5}, {-0.5, -0.5, -0.5}}), std::vector<int>{0});
  EXPECT_TRUE(grid.query({{9.75, 0, 0}, {20, 9, 9}}).empty());
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(grid.query({{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}}).size(), 1000u);
}

TEST(GridQueries, PeriodicImagesAreFoundOnce) {
  std::mt19937_64 engine(3);
  const Periodicity periodicity{{{-4, -4, -4}, {4, 4, 4}}, {true, false, true}};
  for (double ratio : {1.0, 30.0}) {
    const Cloud cloud = randomCloud(800, ratio, 0.9 / ratio, -4.0, 4.0, 4);
    HierarchicalGrid grid(periodicity);
    grid.build(cloud.x, cloud.radius);
    for (double size : {0.01, 1.0, 6.0, 30.0})
      for (int trial = 0; trial < 40; ++trial) {
        const Box box = randomBox(engine, size, 12.0);
        EXPECT_EQ(grid.query(box), bruteForce(cloud, 0.0, box, periodicity));
      }
    const double infinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(grid.query({{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}}).size(), 800u);
  }
}

TEST(GridQueries, TheVisitorSeesEachSphereOnce) {
  const Cloud cloud = randomCloud(500, 10.0, 0.05, -1.0, 1.0, 5);
  HierarchicalGrid grid;
  grid.build(cloud.x, cloud.radius);
  const Box box{{-0.5, -0.2, 0.1}, {0.6, 0.0, 0.3}};
  std::vector<int> seen;
  grid.query(box, [&seen](int i) { seen.push_back(i); });
  std::sort(seen.begin(), seen.end());
  EXPECT_EQ(seen, grid.query(box));
  EXPECT_EQ(seen, bruteForce(cloud, 0.0, box));
}

TEST(GridQueries, BoxesUpsideDownOrNotANumberAreRefused) {
  const Cloud cloud = randomCloud(5, 1.0, 0.1, 0.0, 1.0, 6);
  HierarchicalGrid grid;
  grid.build(cloud.x, cloud.radius);
  EXPECT_THROW(grid.query({{0, 1, 0}, {1, 0, 1}}), InputError);
  EXPECT_THROW(grid.query({{0, std::nan(""), 0}, {1, 1, 1}}), InputError);
}

}  // namespace
}  // namespace dovetail::geometry
