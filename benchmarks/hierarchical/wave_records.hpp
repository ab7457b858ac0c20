// Two records of the same motion.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace dovetail::benchmark {

/// √Σ(a − b)²/√Σb², %.
inline double difference(const std::vector<double>& a, const std::vector<double>& b) {
  double squares = 0.0, whole = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    squares += (a[k] - b[k]) * (a[k] - b[k]);
    whole += b[k] * b[k];
  }
  return 100.0 * std::sqrt(squares / whole);
}

}  // namespace dovetail::benchmark
