// Stable sorting into buckets by many threads.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "dovetail/core/parallel.hpp"
#include "dovetail/core/raw_vector.hpp"

namespace dovetail {

/// Items bucket after bucket: bucket b holds items[begin[b]] … items[begin[b + 1] − 1].
template <class Item>
struct Buckets {
  RawVector<Item> items;
  std::vector<std::size_t> begin;

  std::size_t count() const { return begin.size() - 1; }
  std::size_t size() const { return begin.back(); }
  std::span<Item> operator[](std::size_t b) { return {items.data() + begin[b], begin[b + 1] - begin[b]}; }
  std::span<const Item> operator[](std::size_t b) const { return {items.data() + begin[b], begin[b + 1] - begin[b]}; }
};

namespace detail {
/// Turns what tasks have counted for buckets, task after task, into the places where their items begin; where the
/// buckets begin.
inline std::vector<std::size_t> placesOf(std::vector<std::size_t>& counted, std::size_t tasks, std::size_t buckets) {
  std::vector<std::size_t> begin(buckets + 1, 0);
  const std::size_t chunkSize = std::max<std::size_t>(1, 8192 / std::max<std::size_t>(1, tasks));
  parallelFor(buckets, chunkSize, [&](std::size_t first, std::size_t last) {
    for (std::size_t task = 0; task < tasks; ++task)
      for (std::size_t b = first; b < last; ++b) begin[b + 1] += counted[task * buckets + b];
  });
  for (std::size_t b = 0; b < buckets; ++b) begin[b + 1] += begin[b];
  parallelFor(buckets, chunkSize, [&](std::size_t first, std::size_t last) {
    std::vector<std::size_t> next(begin.begin() + static_cast<std::ptrdiff_t>(first),
                                  begin.begin() + static_cast<std::ptrdiff_t>(last));
    for (std::size_t task = 0; task < tasks; ++task)
      for (std::size_t b = first; b < last; ++b) {
        const std::size_t count = counted[task * buckets + b];
        counted[task * buckets + b] = next[b - first];
        next[b - first] += count;
      }
  });
  return begin;
}
}  // namespace detail

/// Within a bucket items lie in the order of the tasks and, within a task, in the order in which it sends them: the
/// result does not depend on the number of threads. Takes memory for tasks × buckets numbers besides.
/// @param count  count(task, sink) calls sink(bucket) for each item of the task
/// @param send   send(task, sink) calls sink(bucket, item) for the same items, in the order in which they shall lie
template <class Item, class Count, class Send>
Buckets<Item> distribute(std::size_t tasks, std::size_t buckets, Count&& count, Send&& send) {
  Buckets<Item> sorted;
  std::vector<std::size_t> next(tasks * buckets, 0);
  parallelFor(tasks, 1, [&](std::size_t task, std::size_t) {
    std::size_t* const counted = next.data() + task * buckets;
    count(task, [counted](std::size_t bucket) { ++counted[bucket]; });
  });
  sorted.begin = detail::placesOf(next, tasks, buckets);
  sorted.items.resize(sorted.size());
  Item* const items = sorted.items.data();
  parallelFor(tasks, 1, [&](std::size_t task, std::size_t) {
    std::size_t* const place = next.data() + task * buckets;
    send(task, [items, place](std::size_t bucket, const Item& item) { items[place[bucket]++] = item; });
  });
  return sorted;
}

/// The same where counting is as cheap as sending: `send` is called twice for every task, and must say the same.
template <class Item, class Send>
Buckets<Item> distribute(std::size_t tasks, std::size_t buckets, Send&& send) {
  const auto count = [&](std::size_t task, auto&& sink) {
    send(task, [&](std::size_t bucket, const Item&) { sink(bucket); });
  };
  return distribute<Item>(tasks, buckets, count, send);
}

}  // namespace dovetail
