// Eigenvalues of symmetric 3 × 3 tensors and divided differences of the logarithm, for one tensor (T = double) or four
// side by side (T = Four): no decision but the number of sweeps depends on the values.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "dovetail/fem/laws/lanes.hpp"
#include "dovetail/fem/laws/tensor.hpp"

namespace dovetail::fem::detail {

inline Tensor<double> asTensor(const double* a) {
  Tensor<double> tensor;
  std::copy(a, a + 9, tensor.begin());
  return tensor;
}

template <class T>
DOVETAIL_ALWAYS_INLINE T larger(const T& a, const T& b) {
  return wherePositive(a - b, a, b);
}
template <class T>
DOVETAIL_ALWAYS_INLINE T magnitude(const T& a) {
  return wherePositive(a, a, -a);
}
inline bool anyPositive(double x) { return x > 0.0; }
inline bool anyPositive(const Four& x) { return x.v[0] > 0.0 || x.v[1] > 0.0 || x.v[2] > 0.0 || x.v[3] > 0.0; }

/// A = Σ value_a v_a ⊗ v_a; column a of `vectors` is v_a. In no order.
template <class T>
struct Spectrum {
  std::array<T, 3> value;
  Tensor<T> vectors;
};

/// Turns rows and columns p and q so that a_pq becomes zero.
template <std::size_t p, std::size_t q, class T>
DOVETAIL_ALWAYS_INLINE void rotate(Tensor<T>& a, Tensor<T>& v) {
  using std::sqrt;
  constexpr std::size_t r = 3 - p - q;
  const T apq = a[3 * p + q], gap = a[4 * q] - a[4 * p], twice = 2.0 * apq;
  const T t =
      wherePositive(-gap, T(-1.0), T(1.0)) * twice / (magnitude(gap) + sqrt(gap * gap + twice * twice) + 1e-300);
  const T c = 1.0 / sqrt(t * t + 1.0), s = t * c;
  const T arp = a[3 * r + p], arq = a[3 * r + q];
  a[4 * p] -= t * apq;
  a[4 * q] += t * apq;
  a[3 * p + q] = a[3 * q + p] = 0.0;
  a[3 * r + p] = a[3 * p + r] = c * arp - s * arq;
  a[3 * r + q] = a[3 * q + r] = s * arp + c * arq;
  for (std::size_t i = 0; i < 3; ++i) {
    const T vip = v[3 * i + p], viq = v[3 * i + q];
    v[3 * i + p] = c * vip - s * viq;
    v[3 * i + q] = s * vip + c * viq;
  }
}

/// Jacobi's method: to round-off, also for equal eigenvalues.
template <class T>
Spectrum<T> spectrum(Tensor<T> a) {
  Tensor<T> v = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  const T negligible = 1e-36 * contraction(a, a);
  for (int sweep = 0; sweep < 20; ++sweep) {
    if (!anyPositive(a[1] * a[1] + a[2] * a[2] + a[5] * a[5] - negligible)) break;
    rotate<0, 1>(a, v);
    rotate<0, 2>(a, v);
    rotate<1, 2>(a, v);
  }
  return {{a[0], a[4], a[8]}, v};
}

/// Divided differences of f = ½ ln at three positive places, however close.
template <class T>
class LogDifferences {
public:
  explicit LogDifferences(const std::array<T, 3>& x) : x_(x) {
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = a; b < 3; ++b) first_[3 * a + b] = first_[3 * b + a] = firstOf(x[a], x[b]);
  }

  /// f[x_a, x_b].
  const T& operator()(std::size_t a, std::size_t b) const { return first_[3 * a + b]; }

  /// f[x_a, x_b, x_c].
  T operator()(std::size_t a, std::size_t b, std::size_t c) const {
    if (a == b && b == c) return -first_[4 * a] * first_[4 * a];
    // Over the greatest gap.
    T gap = x_[a] - x_[c], rise = first_[3 * a + b] - first_[3 * b + c];
    const auto take = [&](std::size_t p, std::size_t q, std::size_t r) __attribute__((always_inline)) {
      const T other = x_[p] - x_[r], wider = magnitude(other) - magnitude(gap);
      rise = wherePositive(wider, first_[3 * p + q] - first_[3 * q + r], rise);
      gap = wherePositive(wider, other, gap);
    };
    take(a, c, b);
    take(b, a, c);
    const T mean = (x_[a] + x_[b] + x_[c]) / 3.0;
    return wherePositive(magnitude(gap) - 0.02 * mean, rise / gap,
                         series(x_[a] / mean, x_[b] / mean, x_[c] / mean) / (2.0 * mean * mean));
  }

private:
  static T firstOf(const T& x, const T& y) {
    using std::log;
    // ln(1 + r)/r, exact to round-off if the same rounded 1 + r stands in both (Kahan)
    const T u = 1.0 + (x - y) / y, off = u - 1.0;
    return wherePositive(magnitude(off), log(u) / off, T(1.0)) / (2.0 * y);
  }
  /// Twice f[x, y, z] for places close to their mean 1: Σ_k f^(k)(1)/k! h_(k−2), with h the complete symmetric
  /// polynomials of the deviations, whose sum is zero.
  static T series(const T& x, const T& y, const T& z) {
    const T a = x - 1.0, b = y - 1.0, c = z - 1.0;
    const T e2 = a * b + b * c + c * a, e3 = a * b * c;
    return -1.0 / 2.0 + e2 / 4.0 + e3 / 5.0 - e2 * e2 / 6.0 - 2.0 / 7.0 * e2 * e3 + (e2 * e2 * e2 - e3 * e3) / 8.0;
  }

  std::array<T, 3> x_;
  std::array<T, 9> first_;
};

}  // namespace dovetail::fem::detail
