#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "dovetail/cg/projection.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "random_state.hpp"

namespace dovetail::cg {
namespace {

using testing::RandomState;

Projection randomMap(RandomState& random, int rowCount, int columns) {
  std::vector<ProjectionRow> rows(static_cast<std::size_t>(rowCount));
  for (auto& row : rows) {
    double sum = 0.0;
    for (int k = 0; k < 6; ++k) {
      row.emplace_back(static_cast<int>(random.number(0.0, columns - 1e-9)), random.number(0.1, 1.0));
      sum += row.back().second;
    }
    for (auto& entry : row) entry.second /= sum;
  }
  return fromRows(columns, rows);
}

TEST(Projection, TransposedIsTheAdjoint) {
  RandomState random(1);
  for (int trial = 0; trial < 20; ++trial) {
    const Projection map = randomMap(random, 31, 17);
    const auto v = random.vectors(17, -1.0, 1.0), f = random.vectors(31, -1.0, 1.0);
    std::vector<Vec3> there(31), back(17);
    apply(map, v, there);
    applyTransposed(map, f, back);
    double powerThere = 0.0, powerBack = 0.0, size = 0.0;
    for (int i = 0; i < 31; ++i) powerThere += dot(there[i], f[i]);
    for (int i = 0; i < 17; ++i) powerBack += dot(v[i], back[i]);
    for (int i = 0; i < 17; ++i) size += std::abs(dot(v[i], back[i]));
    EXPECT_NEAR(powerThere, powerBack, 1e-14 * size);
  }
}

TEST(Projection, SingleRowsDoTheSame) {
  RandomState random(2);
  const Projection map = randomMap(random, 9, 12);
  const auto v = random.vectors(12, -1.0, 1.0), f = random.vectors(9, -1.0, 1.0);
  std::vector<Vec3> there(9), back(12), backByRow(12);
  apply(map, v, there);
  applyTransposed(map, f, back);
  for (int row = 0; row < 9; ++row) {
    EXPECT_EQ(applyRow(map, row, v), there[row]);
    scatterRow(map, row, f[row], backByRow);
  }
  EXPECT_EQ(back, backByRow);
}

TEST(Projection, ConsistentMapsKeepConstantsAndTotals) {
  RandomState random(3);
  const Projection map = randomMap(random, 40, 15);
  EXPECT_LT(rowSumError(map), 1e-14);
  const std::vector<double> constant(15, 2.5);
  std::vector<double> there(40);
  apply(map, constant, there);
  for (double value : there) EXPECT_NEAR(value, 2.5, 1e-14);
  std::vector<double> load(40, 1.0), nodes(15, 0.5);
  applyTransposed(map, load, nodes);
  double total = 0.0;
  for (double value : nodes) total += value - 0.5;
  EXPECT_NEAR(total, 40.0, 1e-13);
}

TEST(Projection, ProductActsLikeOneMapAfterTheOther) {
  RandomState random(4);
  const Projection a = randomMap(random, 11, 8), b = randomMap(random, 8, 14), ab = product(a, b);
  requireValid(ab);
  const auto x = random.vectors(14, -1.0, 1.0);
  std::vector<Vec3> bx(8), abx(11), direct(11);
  apply(b, x, bx);
  apply(a, bx, abx);
  apply(ab, x, direct);
  for (int i = 0; i < 11; ++i) EXPECT_LT(norm(abx[i] - direct[i]), 1e-14);
  EXPECT_LT(rowSumError(ab), 1e-14);
  const Projection same = product(identityProjection(11), ab);
  EXPECT_EQ(same.column, ab.column);
  EXPECT_EQ(same.weight, ab.weight);
  EXPECT_THROW(product(b, a), InputError);
}

TEST(Projection, RowsAreSortedAndMerged) {
  const std::vector<ProjectionRow> rows{{{3, 0.25}, {0, 0.5}, {3, 0.25}}, {}, {{1, 1.0}}};
  const Projection map = fromRows(4, rows);
  EXPECT_EQ(map.rows(), 3);
  EXPECT_EQ(map.offsets, (std::vector<int>{0, 2, 2, 3}));
  EXPECT_EQ(map.column, (std::vector<int>{0, 3, 1}));
  EXPECT_EQ(map.weight, (std::vector<double>{0.5, 0.5, 1.0}));
  EXPECT_NO_THROW(requireValid(map));
  EXPECT_EQ(rowSumError(map), 1.0);
  try {
    requireRowsSumToOne(map);
    FAIL() << "no error for an empty row";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("projection row 1"), std::string::npos);
  }
}

TEST(Projection, BadInputIsRefused) {
  EXPECT_THROW(fromRows(2, std::vector<ProjectionRow>{{{2, 1.0}}}), InputError);
  EXPECT_THROW(fromRows(2, std::vector<ProjectionRow>{{{-1, 1.0}}}), InputError);
  EXPECT_THROW(fromRows(2, std::vector<ProjectionRow>{{{0, std::numeric_limits<double>::quiet_NaN()}}}), InputError);
  Projection map = identityProjection(3);
  std::vector<Vec3> two(2), three(3);
  EXPECT_THROW(apply(map, two, three), InputError);
  EXPECT_THROW(apply(map, three, two), InputError);
  EXPECT_THROW(applyTransposed(map, two, three), InputError);
  map.column[1] = 5;
  EXPECT_THROW(requireValid(map), InputError);
  map = fromRows(3, std::vector<ProjectionRow>{{{0, 0.5}, {1, 0.5}}});
  std::swap(map.column[0], map.column[1]);
  EXPECT_THROW(requireValid(map), InputError);
  map.weight.pop_back();
  EXPECT_THROW(requireValid(map), InputError);
}

TEST(Projection, EmptyMapsAreAllowed) {
  const Projection none;
  EXPECT_EQ(none.rows(), 0);
  EXPECT_NO_THROW(requireValid(none));
  std::vector<Vec3> nothing;
  EXPECT_NO_THROW(apply(none, nothing, nothing));
  EXPECT_NO_THROW(applyTransposed(none, nothing, nothing));
}

TEST(Projection, ResultsDoNotDependOnTheNumberOfThreads) {
  RandomState random(7);
  const Projection map = randomMap(random, 3000, 200);
  const auto v = random.vectors(200, -1.0, 1.0);
  std::vector<Vec3> one(3000), many(3000);
  apply(map, v, one);
  for (int count : {2, 3}) {
    setThreads(count);
    apply(map, v, many);
    EXPECT_EQ(one, many);
  }
  setThreads(1);
}

TEST(Projection, TheTransposedMapGathersWhatTheMapScatters) {
  const std::vector<ProjectionRow> rows{{{2, 0.5}, {0, 0.25}}, {}, {{1, 1.0}, {2, -0.5}}};
  const Projection map = fromRows(4, rows), back = transposed(map);
  requireValid(back);
  const std::vector<double> in{1.0, 2.0, 3.0};
  std::vector<double> scattered(4, 0.0), gathered(4);
  applyTransposed(map, in, scattered);
  apply(back, in, gathered);
  EXPECT_EQ(scattered, gathered);
  EXPECT_EQ(transposed(back).weight, map.weight);
}

}  // namespace
}  // namespace dovetail::cg
