#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <string>

#include "clouds.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"

namespace dovetail::geometry {
namespace {

/// Grid and double loop agree pair by pair, and at least `least` pairs were there to be found.
void expectAllPairs(const Cloud& cloud, std::size_t least, double skin = 0.0, const Periodicity& periodicity = {}) {
  const Pairs expected = allPairs(cloud, skin, periodicity);
  EXPECT_GE(expected.size(), least);
  EXPECT_EQ(gridPairs(cloud, skin, periodicity), expected);
}

class SizeRatio : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Ratios, SizeRatio, testing::Values(1.0, 1.5, 40.0, 100.0, 1000.0));

TEST_P(SizeRatio, PairsEqualBruteForce) {
  for (unsigned seed : {1u, 2u, 3u}) {
    Cloud cloud = randomCloud(1500, GetParam(), 1e-3, -1.0, 1.0, seed);
    const double scale = 0.5 * cubeFor(cloud, 0.6);
    for (Vec3& x : cloud.x) x *= scale;
    expectAllPairs(cloud, 1000);
    expectAllPairs(cloud, 1000, 3e-4);
  }
}

TEST_P(SizeRatio, FarFromTheOriginAndInNegativeCoordinates) {
  Cloud cloud = randomCloud(800, GetParam(), 1e-3, -1.0, 1.0, 4);
  const double scale = 0.5 * cubeFor(cloud, 0.6);
  for (Vec3& x : cloud.x) x = scale * x + Vec3{-1000.0, -3.0, 1e5};
  expectAllPairs(cloud, 500);
}

TEST_P(SizeRatio, PermutedNumbersGiveTheSamePairs) {
  Cloud cloud = randomCloud(1000, GetParam(), 1.0, 0.0, 1.0, 5), permuted = cloud;
  const double edge = cubeFor(cloud, 0.6);
  std::vector<int> number(cloud.x.size());
  std::iota(number.begin(), number.end(), 0);
  std::shuffle(number.begin(), number.end(), std::mt19937_64(6));
  for (std::size_t i = 0; i < number.size(); ++i) {
    cloud.x[i] *= edge;
    permuted.x[static_cast<std::size_t>(number[i])] = cloud.x[i];
    permuted.radius[static_cast<std::size_t>(number[i])] = cloud.radius[i];
  }
  Pairs renumbered = gridPairs(cloud);
  ASSERT_GT(renumbered.size(), 500u);
  for (auto& pair : renumbered) {
    pair = {number[static_cast<std::size_t>(pair[0])], number[static_cast<std::size_t>(pair[1])]};
    std::sort(pair.begin(), pair.end());
  }
  std::sort(renumbered.begin(), renumbered.end());
  EXPECT_EQ(gridPairs(permuted), renumbered);
}

TEST_P(SizeRatio, PeriodicPairsEqualBruteForce) {
  for (int axes = 1; axes < 8; ++axes) {
    Cloud cloud = randomCloud(600, GetParam(), 1.0, 0.0, 1.0, static_cast<unsigned>(10 + axes));
    const double edge = std::max(cubeFor(cloud, 0.6), 4.0 * GetParam());
    const Periodicity periodicity{{{-0.3 * edge, 1.0, 0.0}, {0.7 * edge, 1.0 + edge, edge}},
                                  {(axes & 1) != 0, (axes & 2) != 0, (axes & 4) != 0}};
    // Also up to a box length outside of the box.
    for (Vec3& x : cloud.x) x = 1.5 * edge * x + Vec3{-0.5 * edge, 0.2 * edge, -edge};
    expectAllPairs(cloud, 40, 0.0, periodicity);
    EXPECT_GT(allPairs(cloud, 0.0, periodicity).size(), allPairs(cloud).size());
  }
}

TEST(HierarchicalGrid, ThousandSpheresOfRatioFortyAtSolidFractionSeventyPercent) {
  Cloud cloud = randomCloud(1000, 40.0, 1.0, 0.0, 1.0, 20);
  const double edge = cubeFor(cloud, 0.7);
  ASSERT_GT(edge, 160.0);
  for (Vec3& x : cloud.x) x *= edge;
  expectAllPairs(cloud, 1000, 0.0, {{{0, 0, 0}, {edge, edge, edge}}, {true, true, true}});
}

TEST(HierarchicalGrid, PeriodicBoxesOfAllSmallCellCounts) {
  for (double cells : {2.0, 2.0000001, 2.5, 3.0, 3.2, 4.0, 5.5}) {
    Cloud cloud = randomCloud(120, 4.0, 0.25, 0.0, 2.0 * cells, static_cast<unsigned>(10 * cells));
    cloud.radius[1] = 1.0;
    const double edge = 2.0 * cells;
    expectAllPairs(cloud, 10, 0.0, {{{0, 0, 0}, {edge, edge, edge}}, {true, true, true}});
    expectAllPairs(cloud, 10, 0.0, {{{0, 0, 0}, {edge, edge, edge}}, {false, true, false}});
  }
}

/// n³ spheres of diameter `spacing` on a lattice: each touches exactly its six neighbours.
Cloud lattice(int n, double spacing, const Vec3& origin) {
  Cloud cloud;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) {
        cloud.x.push_back(origin + spacing * Vec3{double(i), double(j), double(k)});
        cloud.radius.push_back(0.5 * spacing);
      }
  return cloud;
}

TEST(HierarchicalGrid, TouchingSpheresOnCellFacesAreFound) {
  for (double spacing : {1.0, 0.5, 0.1, 3e-3}) {
    const Cloud cloud = lattice(7, spacing, {-3.0 * spacing, 0.0, 5.0 * spacing});
    EXPECT_EQ(gridPairs(cloud), allPairs(cloud));
  }
  EXPECT_EQ(gridPairs(lattice(7, 0.5, {-1.5, 0.0, 2.5})).size(), 3u * 7 * 7 * 6);
  const Periodicity periodicity{{{-1.5, 0.0, 2.5}, {2.0, 3.5, 6.0}}, {true, true, true}};
  EXPECT_EQ(gridPairs(lattice(7, 0.5, {-1.5, 0.0, 2.5}), 0.0, periodicity).size(), 3u * 7 * 7 * 7);
}

TEST(HierarchicalGrid, PairsThatJustTouchFromBelowOneCellFaceToBeyondTheNextAreFound) {
  std::mt19937_64 engine(29);
  std::uniform_real_distribution<double> scale(0.5, 1.0);
  std::size_t touching = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const double diameter = scale(engine);
    HierarchicalGrid grid;
    grid.build(std::vector<Vec3>(1), std::vector<double>{0.5 * diameter});
    Cloud cloud{{{0, 0, 0}}, {0.5 * diameter}};
    for (int n = 1; n < 40; ++n) {
      const double x = std::nextafter(n * grid.cellSize(0), 0.0);
      cloud.x.insert(cloud.x.end(), {{x, 3.0 * n * diameter, 0}, {x + diameter, 3.0 * n * diameter, 0}});
      cloud.radius.insert(cloud.radius.end(), 2, 0.5 * diameter);
    }
    expectAllPairs(cloud, 0);
    touching += allPairs(cloud).size();
  }
  EXPECT_GT(touching, 2000u);
}

TEST(HierarchicalGrid, SmallSpheresThatJustTouchLargeOnesBeyondACellFaceAreFound) {
  std::mt19937_64 engine(28);
  std::uniform_real_distribution<double> scale(0.5, 1.0);
  std::size_t touching = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const double large = scale(engine), small = large / 16.0, reach = small + large;
    HierarchicalGrid grid;
    grid.build(std::vector<Vec3>(1), std::vector<double>{large});
    Cloud cloud{{{0, 0, 0}}, {large}};
    for (int n = 2; n < 40; ++n) {
      const double face = n * grid.cellSize(0), y = 6.0 * n * large;
      const double x = n % 2 == 0 ? face : std::nextafter(face, 0.0);
      cloud.x.insert(cloud.x.end(), {{x, y, 0}, {n % 2 == 0 ? x - reach : x + reach, y, 0}});
      cloud.radius.insert(cloud.radius.end(), {large, small});
    }
    expectAllPairs(cloud, 0);
    touching += allPairs(cloud).size();
  }
  EXPECT_GT(touching, 2000u);
}

TEST(HierarchicalGrid, RadiiAtTheBoundsOfLevels) {
  Cloud cloud = randomCloud(1200, 1.0, 1.0, -15.0, 15.0, 30);
  for (std::size_t i = 0; i < cloud.x.size(); ++i) {
    double bound = 4.0;  // levels are cut at 4, 4/3, 4/9 …
    for (std::size_t level = 0; level < i % 6; ++level) bound /= 3.0;
    const std::array<double, 3> radii{bound, std::nextafter(bound, 0.0), std::nextafter(bound, 5.0)};
    cloud.radius[i] = i % 6 == 0 ? bound : radii[i / 6 % 3];
    cloud.x[i] = {std::round(cloud.x[i].x), std::round(cloud.x[i].y), cloud.x[i].z};
  }
  HierarchicalGrid grid;
  grid.build(cloud.x, cloud.radius);
  EXPECT_GE(grid.levels(), 6u);
  expectAllPairs(cloud, 1000);
}

TEST(HierarchicalGrid, NoneOneAndTwoSpheres) {
  HierarchicalGrid grid;
  EXPECT_TRUE(grid.pairs().empty());
  grid.build({}, {});
  EXPECT_TRUE(grid.pairs().empty());
  EXPECT_TRUE(grid.query({{-1, -1, -1}, {1, 1, 1}}).empty());
  expectAllPairs({{{1, 2, 3}}, {0.5}}, 0);
  expectAllPairs({{{1, 2, 3}, {1, 2, 3.9}}, {0.5, 0.4}}, 1);
  expectAllPairs({{{1, 2, 3}, {1, 2, 3.9}}, {5e-3, 0.896}}, 1);
  EXPECT_TRUE(gridPairs({{{1, 2, 3}, {1, 2, 3.9}}, {5e-3, 0.89}}).empty());
}

TEST(HierarchicalGrid, AllAtOnePoint) {
  Cloud cloud = randomCloud(300, 50.0, 0.1, 0.0, 1.0, 31);
  for (Vec3& x : cloud.x) x = {0.1, -7.0, 3.0};
  expectAllPairs(cloud, 300 * 299 / 2);
}

TEST(HierarchicalGrid, OutliersNeitherCostMemoryNorHidePairs) {
  Cloud cloud = randomCloud(1000, 3.0, 0.5, -8.0, 8.0, 32);
  cloud.x[3] = {1e12, -4e9, 3.0};
  cloud.x[4] = {1e12, -4e9, 3.5};
  cloud.x[5] = {-1e12, 1e300, -1e250};
  const auto found = gridPairs(cloud);
  EXPECT_EQ(found, allPairs(cloud));
  EXPECT_TRUE(std::binary_search(found.begin(), found.end(), std::array<int, 2>{3, 4}));
}

TEST(HierarchicalGrid, MoreThanAMillionCellsAlongAnAxis) {
  Cloud cloud = randomCloud(1000, 2.0, 1e-3, 0.0, 1.0, 33);
  for (std::size_t i = 0; i < cloud.x.size(); ++i)
    cloud.x[i] = cloud.x[i] * 5e-3 + Vec3{5000.0 * static_cast<double>(i % 50), 0.0, 0.0};
  expectAllPairs(cloud, 500);
  const Periodicity periodicity{{{0, 0, 0}, {250000.0, 1.0, 1.0}}, {true, false, false}};
  expectAllPairs(cloud, 500, 0.0, periodicity);
}

TEST(HierarchicalGrid, OneSphereAmongAThousandTimesSmallerOnes) {
  Cloud cloud = randomCloud(2000, 1.0, 1e-3, -1.0, 1.0, 34);
  for (Vec3& x : cloud.x) x = (1.0 + 2e-3 * x.x) * normalized(x);  // a coat of dust
  cloud.x[777] = {0, 0, 0};
  cloud.radius[777] = 1.0;
  expectAllPairs(cloud, 1000);
}

TEST(HierarchicalGrid, TheVisitorSeesEachPairOnceInARepeatableOrder) {
  const Cloud cloud = randomCloud(2000, 20.0, 0.02, -1.0, 1.0, 35);
  HierarchicalGrid grid;
  grid.build(randomCloud(500, 3.0, 0.02, -1.0, 5.0, 36).x, randomCloud(500, 3.0, 0.02, -1.0, 5.0, 36).radius);
  const auto visit = [&] {
    Pairs seen;
    grid.build(cloud.x, cloud.radius, 1e-3);
    grid.forEachPair([&seen](int i, int j) { seen.push_back({i, j}); });
    return seen;
  };
  Pairs first = visit();
  EXPECT_EQ(visit(), first);
  std::sort(first.begin(), first.end());
  EXPECT_EQ(first, allPairs(cloud, 1e-3));
}

TEST(HierarchicalGrid, PairsAreTheSameForAnyNumberOfThreads) {
  const Cloud cloud = randomCloud(30000, 5.0, 0.02, -3.0, 3.0, 37);
  HierarchicalGrid grid;
  grid.build(cloud.x, cloud.radius);
  const Pairs one = grid.pairs();
  ASSERT_GT(one.size(), 10000u);
  for (int count : {2, 3}) {
    setThreads(count);
    EXPECT_EQ(grid.pairs(), one);
  }
  setThreads(1);
}

TEST(HierarchicalGrid, TheOrderIsAPermutation) {
  const Cloud cloud = randomCloud(1000, 9.0, 0.02, -1.0, 1.0, 38);
  HierarchicalGrid grid;
  grid.build(cloud.x, cloud.radius);
  std::vector<int> order(grid.order().begin(), grid.order().end()), all(1000);
  std::sort(order.begin(), order.end());
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(order, all);
}

template <class Call>
std::string inputError(Call&& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(HierarchicalGrid, BadSpheresAreRefusedByNumber) {
  const double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  const Cloud good = randomCloud(20, 2.0, 0.1, 0.0, 1.0, 40);
  HierarchicalGrid grid;
  grid.build(good.x, good.radius);
  const Pairs before = grid.pairs();
  for (double bad : {nan, infinity, -infinity})
    for (int axis = 0; axis < 3; ++axis) {
      Cloud cloud = good;
      cloud.x[13][axis] = bad;
      EXPECT_NE(inputError([&] { grid.build(cloud.x, cloud.radius); }).find("[particle 13]"), std::string::npos);
    }
  for (double bad : {nan, infinity, 0.0, -1.0}) {
    Cloud cloud = good;
    cloud.radius[7] = bad;
    EXPECT_NE(inputError([&] { grid.build(cloud.x, cloud.radius); }).find("[particle 7]"), std::string::npos);
  }
  for (double bad : {nan, infinity, -1e-9}) EXPECT_THROW(grid.build(good.x, good.radius, bad), InputError);
  EXPECT_THROW(grid.build(good.x, std::span(good.radius).first(19)), InputError);
  EXPECT_EQ(grid.pairs(), before);
}

TEST(HierarchicalGrid, PeriodicBoxesTooSmallOrWithoutLengthAreRefused) {
  EXPECT_THROW(HierarchicalGrid({{{0, 0, 0}, {1, 0, 1}}, {false, true, false}}), InputError);
  EXPECT_NO_THROW(HierarchicalGrid({{{0, 0, 0}, {1, 0, 1}}, {true, false, true}}));
  HierarchicalGrid grid({{{0, 0, 0}, {1, 1, 4}}, {false, false, true}});
  const std::vector<Vec3> x{{0, 0, 0}};
  EXPECT_NO_THROW(grid.build(x, std::vector<double>{1.0}));
  EXPECT_THROW(grid.build(x, std::vector<double>{1.0001}), InputError);
  EXPECT_THROW(grid.build(x, std::vector<double>{1.0}, 0.001), InputError);
}

}  // namespace
}  // namespace dovetail::geometry
