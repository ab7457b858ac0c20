// Sums in eight lanes, so that their order is not that of the registers.
#pragma once

#include <cstddef>

namespace dovetail {

inline constexpr std::size_t lanes = 8;

struct LaneSum {
  double lane[lanes] = {};

  /// Σ a, of n numbers.
  [[gnu::always_inline]] void add(const double* a, std::size_t n) {
    forLanes(n, [&](std::size_t i, std::size_t l) { lane[l] += a[i]; });
  }
  /// Σ a b.
  [[gnu::always_inline]] void addProducts(const double* a, const double* b, std::size_t n) {
    forLanes(n, [&](std::size_t i, std::size_t l) { lane[l] += a[i] * b[i]; });
  }
  double total() const {
    double sum = 0.0;
    for (const double part : lane) sum += part;
    return sum;
  }

private:
  template <class Body>
  [[gnu::always_inline]] static void forLanes(std::size_t n, const Body& body) {
    std::size_t i = 0;
    for (; i + lanes <= n; i += lanes)
      for (std::size_t l = 0; l < lanes; ++l) body(i + l, l);
    for (std::size_t l = 0; i + l < n; ++l) body(i + l, l);
  }
};

}  // namespace dovetail
