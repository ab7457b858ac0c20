// Parallel loops whose results do not depend on the number of threads.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <vector>

namespace dovetail {

/// Number of threads that a loop started here may use; at least 1. Without setThreads: as many as OMP_NUM_THREADS says
/// and, where that is not set, one for every processor that the process may run on. Inside a parallel loop it is 1: the
/// loops within run on the thread that meets them, so a whole simulation can be the body of one.
/// @throws InputError if OMP_NUM_THREADS is no number
int threads();
/// Sets the number of threads for all later loops of the process. More than the process has processors are not taken.
/// @throws InputError if count < 1
void setThreads(int count);

namespace detail {
/// Calls body(context, chunk) for chunk = 0 … chunks − 1 on at most threads() threads and rethrows what the lowest
/// failing chunk threw. Chunks lie in ranges, one per thread, from which idle threads help themselves; `oneByOne`: they
/// are handed out in order.
void runChunks(std::size_t chunks, bool oneByOne, void (*body)(void* context, std::size_t chunk), void* context);

template <class Body>
void runChunks(std::size_t chunks, bool oneByOne, Body& body) {
  const auto call = [](void* context, std::size_t chunk) { (*static_cast<Body*>(context))(chunk); };
  runChunks(chunks, oneByOne, call, &body);
}

/// What OMP_NUM_THREADS asks for, at most `processors`; all of these if it is null or empty.
int threadsFromEnvironment(const char* text, int processors);
/// Processors that the affinity mask of the process allows.
int processors();
/// For tests on small machines: loops count on that many processors.
void pretendProcessors(int count);
}  // namespace detail

/// Calls body(begin, end) over [0, n) in chunks of `chunkSize` items; the chunks do not depend on the number of
/// threads. A chunk should be worth 10 µs or more: a loop uses no more threads than it has chunks, and one chunk starts
/// none. Who does a chunk is left open, so the body must write only to places that belong to its own items. If it
/// throws, the exception of the lowest throwing chunk comes out, for any number of threads; later chunks may or may not
/// have run.
template <class Body>
void parallelFor(std::size_t n, std::size_t chunkSize, Body&& body) {
  chunkSize = std::max<std::size_t>(chunkSize, 1);
  if (n <= chunkSize || threads() == 1) {
    for (std::size_t begin = 0; begin < n; begin += chunkSize) body(begin, std::min(begin + chunkSize, n));
    return;
  }
  auto chunk = [&body, n, chunkSize](std::size_t c) { body(c * chunkSize, std::min((c + 1) * chunkSize, n)); };
  detail::runChunks((n + chunkSize - 1) / chunkSize, false, chunk);
}

/// Calls body(task) for task = 0 … n − 1, handed out one by one in this order to whoever is idle: for few costly tasks
/// of unequal length. Sort them, longest first. Exceptions as in parallelFor.
template <class Body>
void parallelTasks(std::size_t n, Body&& body) {
  if (n <= 1 || threads() == 1) {
    for (std::size_t task = 0; task < n; ++task) body(task);
    return;
  }
  detail::runChunks(n, true, body);
}

namespace detail {
/// Calls combine(value) with body(begin, end) of each chunk, in the order of the chunks.
template <class Body, class Combine>
void inOrderOfChunks(std::size_t n, std::size_t chunkSize, Body&& body, Combine&& combine) {
  using Value = decltype(body(std::size_t{}, std::size_t{}));
  static_assert(!std::is_same_v<Value, bool>, "threads cannot write to neighbouring bits: count in an int");
  chunkSize = std::max<std::size_t>(chunkSize, 1);
  if (n <= chunkSize || threads() == 1) {
    for (std::size_t begin = 0; begin < n; begin += chunkSize) combine(body(begin, std::min(begin + chunkSize, n)));
    return;
  }
  constexpr std::size_t few = 32;
  const std::size_t chunks = (n + chunkSize - 1) / chunkSize;
  std::array<Value, few> onStack;
  std::vector<Value> onHeap(chunks > few ? chunks : 0);
  Value* const values = chunks > few ? onHeap.data() : onStack.data();
  parallelFor(n, chunkSize, [&](std::size_t begin, std::size_t end) { values[begin / chunkSize] = body(begin, end); });
  for (std::size_t chunk = 0; chunk < chunks; ++chunk) combine(values[chunk]);
}
}  // namespace detail

/// Sum over chunks of body(begin, end), added in the order of the chunks: bitwise the same for any number of threads.
template <class Body>
auto parallelSum(std::size_t n, std::size_t chunkSize, Body&& body) {
  decltype(body(std::size_t{}, std::size_t{})) total{};
  detail::inOrderOfChunks(n, chunkSize, body, [&](const auto& value) { total += value; });
  return total;
}

/// Largest body(begin, end) of the chunks, NaN if one of them is; the lowest number of the type if n = 0.
template <class Body>
auto parallelMax(std::size_t n, std::size_t chunkSize, Body&& body) {
  using Value = decltype(body(std::size_t{}, std::size_t{}));
  Value largest = std::numeric_limits<Value>::lowest();
  detail::inOrderOfChunks(n, chunkSize, body, [&](Value value) {
    if (value > largest || value != value) largest = value;
  });
  return largest;
}

}  // namespace dovetail
