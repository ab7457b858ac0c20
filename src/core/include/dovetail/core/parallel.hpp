// Parallel loops whose results do not depend on the number of threads.
#pragma once

#include <cstddef>
#include <type_traits>
#include <vector>

namespace dovetail {

/// Number of threads the loops below use; at least 1. Builds without OpenMP always use one.
int threads();
/// @throws InputError if count < 1
void setThreads(int count);

namespace detail {
/// Calls body(context, chunk) for chunk = 0 … chunks − 1, each exactly once.
void runChunks(std::size_t chunks, void (*body)(void* context, std::size_t chunk), void* context);
}  // namespace detail

/// Calls body(begin, end) over [0, n) in chunks of `grain` items; the chunks do not depend on the thread count.
/// The body must write only to places that belong to its own items.
template <class Body>
void parallelFor(std::size_t n, std::size_t grain, Body&& body) {
  if (n == 0) return;
  if (n <= grain || threads() == 1) {
    for (std::size_t begin = 0; begin < n; begin += grain) body(begin, begin + grain < n ? begin + grain : n);
    return;
  }
  struct Context {
    std::remove_reference_t<Body>* body;
    std::size_t n, grain;
  } context{&body, n, grain};
  detail::runChunks((n + grain - 1) / grain, [](void* raw, std::size_t chunk) {
    auto& c = *static_cast<Context*>(raw);
    const std::size_t begin = chunk * c.grain;
    (*c.body)(begin, begin + c.grain < c.n ? begin + c.grain : c.n);
  }, &context);
}

/// Sum over chunks of body(begin, end), added in the order of the chunks: bitwise the same for any thread count.
template <class Body>
auto parallelSum(std::size_t n, std::size_t grain, Body&& body) {
  using Value = decltype(body(std::size_t{}, std::size_t{}));
  std::vector<Value> partial((n + grain - 1) / grain);
  parallelFor(n, grain, [&](std::size_t begin, std::size_t end) { partial[begin / grain] = body(begin, end); });
  Value total{};
  for (const Value& value : partial) total += value;
  return total;
}

}  // namespace dovetail
