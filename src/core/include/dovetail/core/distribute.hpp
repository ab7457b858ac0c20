// Stable sorting into buckets by many threads.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "dovetail/core/parallel.hpp"

namespace dovetail {

/// Items bucket after bucket: bucket b holds items[begin[b]] … items[begin[b + 1] − 1].
template <class Item>
struct Buckets {
  std::unique_ptr<Item[]> items;
  std::vector<std::size_t> begin;

  std::size_t count() const { return begin.size() - 1; }
  std::size_t size() const { return begin.back(); }
  std::span<Item> operator[](std::size_t b) const { return {items.get() + begin[b], begin[b + 1] - begin[b]}; }
};

/// Within a bucket items lie in the order of the tasks and, within a task, in the order in which it sends them: the
/// result does not depend on the number of threads. Takes memory for tasks × buckets numbers besides.
/// @param send  send(task, sink) calls sink(bucket, item) for each item of the task. It is called twice for every task,
///        to count and to place, and must say the same both times.
template <class Item, class Send>
Buckets<Item> distribute(std::size_t tasks, std::size_t buckets, Send&& send) {
  Buckets<Item> sorted;
  std::vector<std::size_t> next(tasks * buckets, 0);
  parallelFor(tasks, 1, [&](std::size_t task, std::size_t) {
    std::size_t* const count = next.data() + task * buckets;
    send(task, [count](std::size_t bucket, const Item&) { ++count[bucket]; });
  });
  std::size_t total = 0;
  for (std::size_t b = 0; b < buckets; ++b) {
    sorted.begin.push_back(total);
    for (std::size_t task = 0; task < tasks; ++task) {
      const std::size_t count = next[task * buckets + b];
      next[task * buckets + b] = total;
      total += count;
    }
  }
  sorted.begin.push_back(total);
  sorted.items = std::make_unique_for_overwrite<Item[]>(total);
  Item* const items = sorted.items.get();
  parallelFor(tasks, 1, [&](std::size_t task, std::size_t) {
    std::size_t* const place = next.data() + task * buckets;
    send(task, [items, place](std::size_t bucket, const Item& item) { items[place[bucket]++] = item; });
  });
  return sorted;
}

}  // namespace dovetail
