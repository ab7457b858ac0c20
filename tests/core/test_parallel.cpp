#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"

namespace dovetail {
namespace {

double sumOfRoots(std::size_t n) {
  return parallelSum(n, 64, [](std::size_t begin, std::size_t end) {
    double sum = 0.0;
    for (std::size_t i = begin; i < end; ++i) sum += 1.0 / std::sqrt(static_cast<double>(i + 1));
    return sum;
  });
}

TEST(Parallel, EveryItemIsVisitedOnce) {
  for (int count : {1, 2, 3}) {
    setThreads(count);
    std::vector<int> visits(1001, 0);
    parallelFor(visits.size(), 10, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) ++visits[i];
    });
    EXPECT_EQ(std::accumulate(visits.begin(), visits.end(), 0), 1001);
    EXPECT_EQ(*std::max_element(visits.begin(), visits.end()), 1);
  }
  setThreads(1);
}

TEST(Parallel, SumsAreBitwiseEqualForAnyNumberOfThreads) {
  setThreads(1);
  const double one = sumOfRoots(12345);
  setThreads(2);
  EXPECT_EQ(one, sumOfRoots(12345));
  setThreads(3);
  EXPECT_EQ(one, sumOfRoots(12345));
  setThreads(1);
}

TEST(Parallel, AnEmptyRangeSumsToZero) { EXPECT_EQ(sumOfRoots(0), 0.0); }

TEST(Parallel, NoThreadsIsRefused) { EXPECT_THROW(setThreads(0), InputError); }

}  // namespace
}  // namespace dovetail
