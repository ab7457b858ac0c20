// Eigenvalues of symmetric 3 × 3 tensors, and the logarithm with its first two derivatives.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "dovetail/fem/tensor.hpp"

namespace dovetail::fem::detail {

inline Tensor<double> asTensor(const double* a) {
  Tensor<double> tensor;
  std::copy(a, a + 9, tensor.begin());
  return tensor;
}

/// A = Σ value_a v_a ⊗ v_a; column a of `vectors` is v_a. In no order.
struct Spectrum {
  std::array<double, 3> value;
  Tensor<double> vectors;
};

/// Jacobi's method: to round-off, also for equal eigenvalues.
inline Spectrum spectrum(Tensor<double> a) {
  Tensor<double> v = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const double size = contraction(a, a);
  for (int sweep = 0; sweep < 30; ++sweep) {
    const double off = a[1] * a[1] + a[2] * a[2] + a[5] * a[5];
    if (!(off > 1e-36 * size)) break;
    for (const auto& [p, q] : {std::pair<std::size_t, std::size_t>{0, 1}, {0, 2}, {1, 2}}) {
      const double apq = a[3 * p + q];
      if (apq == 0.0) continue;
      const double theta = (a[4 * q] - a[4 * p]) / (2.0 * apq);
      const double t = (theta < 0.0 ? -1.0 : 1.0) / (std::abs(theta) + std::sqrt(theta * theta + 1.0));
      const double c = 1.0 / std::sqrt(t * t + 1.0), s = t * c;
      const std::size_t r = 3 - p - q;
      const double arp = a[3 * r + p], arq = a[3 * r + q];
      a[4 * p] -= t * apq;
      a[4 * q] += t * apq;
      a[3 * p + q] = a[3 * q + p] = 0.0;
      a[3 * r + p] = a[3 * p + r] = c * arp - s * arq;
      a[3 * r + q] = a[3 * q + r] = s * arp + c * arq;
      for (std::size_t i = 0; i < 3; ++i) {
        const double vip = v[3 * i + p], viq = v[3 * i + q];
        v[3 * i + p] = c * vip - s * viq;
        v[3 * i + q] = s * vip + c * viq;
      }
    }
  }
  return {{a[0], a[4], a[8]}, v};
}

/// Divided difference f[x, y] of f = ½ ln, for positive x and y however close.
inline double logDifference(double x, double y) {
  const double r = (x - y) / y;
  return (r == 0.0 ? 1.0 : std::log1p(r) / r) / (2.0 * y);
}

/// f[x, y, z] of f = ½ ln.
inline double logSecondDifference(double x, double y, double z) {
  const double low = std::min({x, y, z}), high = std::max({x, y, z}), mean = (x + y + z) / 3.0;
  if (high - low > 0.02 * mean) {
    const double middle = std::max(std::min(x, y), std::min(std::max(x, y), z));
    return (logDifference(high, middle) - logDifference(middle, low)) / (high - low);
  }
  // Σ_k f^(k)(mean)/k! h_(k−2), with h the complete symmetric polynomials of the relative deviations, whose sum is
  // zero.
  const double a = x / mean - 1.0, b = y / mean - 1.0, c = z / mean - 1.0;
  const double e2 = a * b + b * c + c * a, e3 = a * b * c;
  const double series =
      -1.0 / 2.0 + e2 / 4.0 + e3 / 5.0 - e2 * e2 / 6.0 - 2.0 * e2 * e3 / 7.0 + (e2 * e2 * e2 - e3 * e3) / 8.0;
  return series / (2.0 * mean * mean);
}

}  // namespace dovetail::fem::detail
