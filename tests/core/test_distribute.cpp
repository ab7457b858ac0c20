// Sorting into buckets by many threads: as a stable sort would, for any number of threads.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "dovetail/core/distribute.hpp"

namespace dovetail {
namespace {

using Item = std::array<std::uint32_t, 2>;  // key, place before

std::vector<Item> someItems(std::size_t n) {
  std::vector<Item> items;
  std::uint32_t state = 1;
  for (std::size_t i = 0; i < n; ++i) {
    state = 1664525u * state + 1013904223u;
    items.push_back({state >> 20, static_cast<std::uint32_t>(i)});
  }
  return items;
}

TEST(Distribute, IsAStableSortForAnyNumberOfThreads) {
  constexpr std::size_t perTask = 700, buckets = 300;
  const std::vector<Item> items = someItems(50000);
  const auto bucketOf = [](const Item& item) { return static_cast<std::size_t>(item[0]) % buckets; };
  std::vector<Item> expected = items;
  std::stable_sort(expected.begin(), expected.end(),
                   [&](const Item& a, const Item& b) { return bucketOf(a) < bucketOf(b); });
  const std::size_t tasks = (items.size() + perTask - 1) / perTask;
  const int here = detail::processors();
  detail::pretendProcessors(4);
  for (const int count : {1, 2, 3, 4}) {
    setThreads(count);
    const auto sorted = distribute<Item>(tasks, buckets, [&](std::size_t task, auto&& sink) {
      for (std::size_t i = task * perTask; i < std::min(items.size(), (task + 1) * perTask); ++i)
        sink(bucketOf(items[i]), items[i]);
    });
    ASSERT_EQ(sorted.size(), items.size());
    EXPECT_TRUE(std::equal(expected.begin(), expected.end(), sorted.items.begin())) << count;
    for (std::size_t b = 0; b < buckets; ++b)
      for (const Item& item : sorted[b]) ASSERT_EQ(bucketOf(item), b);
  }
  detail::pretendProcessors(here);
  setThreads(1);
}

TEST(Distribute, NothingAndEmptyBucketsAreNoTrouble) {
  const auto none = distribute<Item>(0, 3, [](std::size_t, auto&&) {});
  EXPECT_EQ(none.begin, (std::vector<std::size_t>{0, 0, 0, 0}));
  const auto one = distribute<Item>(1, 4, [](std::size_t, auto&& sink) { sink(2, Item{7, 0}); });
  EXPECT_EQ(one.begin, (std::vector<std::size_t>{0, 0, 0, 1, 1}));
  EXPECT_EQ(one.items, RawVector<Item>{(Item{7, 0})});
}

TEST(RawVector, KeepsWhatItHadAndTakesWhatItIsGiven) {
  RawVector<double> values{1.0, 2.0};
  values.resize(1000);
  EXPECT_EQ(values[0], 1.0);
  EXPECT_EQ(values[1], 2.0);
  values.resize(1002, 3.0);
  EXPECT_EQ(values[1000] + values[1001], 6.0);
  EXPECT_EQ(RawVector<double>(3, 0.0), (RawVector<double>{0.0, 0.0, 0.0}));
}

}  // namespace
}  // namespace dovetail
