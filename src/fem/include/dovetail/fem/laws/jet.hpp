// Numbers that carry their derivatives by the nine entries of F (forward differentiation).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "dovetail/fem/laws/lanes.hpp"

namespace dovetail::fem {

/// A value with its gradient and, for order 2, its curvature by nine variables. T is double or Four.
/// Curvature holds the upper triangle by rows: (i, j ≥ i) at 9 i − i (i + 1)/2 + j.
template <class T, int order>
struct Jet {
  static constexpr std::size_t variables = 9;
  static constexpr std::size_t curvatures = order == 2 ? 45 : 0;
  T value{};
  std::array<T, variables> gradient{};
  std::array<T, curvatures> curvature{};

  Jet() = default;
  Jet(double x) : value(x) {}
  /// The variable number i, with the value x.
  static Jet variable(const T& x, std::size_t i) {
    Jet jet;
    jet.value = x;
    jet.gradient[i] = T(1.0);
    return jet;
  }
  static constexpr std::size_t place(std::size_t i, std::size_t j) {
    return i <= j ? 9 * i - i * (i + 1) / 2 + j : place(j, i);
  }

  Jet& operator+=(const Jet& b) { return *this = *this + b; }
  Jet& operator-=(const Jet& b) { return *this = *this - b; }
  Jet& operator*=(const Jet& b) { return *this = *this * b; }
  Jet& operator/=(const Jet& b) { return *this = *this / b; }

  friend Jet operator+(const Jet& a, const Jet& b) {
    return map2(a, b, [](const T& x, const T& y) { return x + y; });
  }
  friend Jet operator-(const Jet& a, const Jet& b) {
    return map2(a, b, [](const T& x, const T& y) { return x - y; });
  }
  friend Jet operator-(const Jet& a) { return -1.0 * a; }
  friend Jet operator*(const Jet& a, const Jet& b) {
    Jet c = map2(a, b, [&](const T& x, const T& y) { return b.value * x + a.value * y; });
    c.value = a.value * b.value;
    if constexpr (order == 2)
      for (std::size_t i = 0, k = 0; i < variables; ++i)
        for (std::size_t j = i; j < variables; ++j, ++k)
          c.curvature[k] += a.gradient[i] * b.gradient[j] + a.gradient[j] * b.gradient[i];
    return c;
  }
  friend Jet operator/(const Jet& a, const Jet& b) {
    const T r = 1.0 / b.value;
    return a * chain(b, r, -r * r, 2.0 * r * r * r);
  }
  friend Jet operator*(double s, const Jet& a) {
    return map2(a, a, [s](const T& x, const T&) { return s * x; });
  }
  friend Jet operator*(const Jet& a, double s) { return s * a; }
  friend Jet operator/(const Jet& a, double s) { return (1.0 / s) * a; }
  friend Jet operator+(const Jet& a, double s) {
    Jet b = a;
    b.value = b.value + s;
    return b;
  }
  friend Jet operator+(double s, const Jet& a) { return a + s; }
  friend Jet operator-(const Jet& a, double s) { return a + (-s); }
  friend Jet operator-(double s, const Jet& a) { return -a + s; }

  friend bool operator<(const Jet& a, const Jet& b) { return a.value < b.value; }
  friend bool operator>(const Jet& a, const Jet& b) { return a.value > b.value; }
  friend bool operator<(const Jet& a, double b) { return a.value < b; }
  friend bool operator>(const Jet& a, double b) { return a.value > b; }

  friend Jet sqrt(const Jet& a) {
    using std::sqrt;
    const T root = sqrt(a.value), slope = 0.5 / root;
    return chain(a, root, slope, -0.5 * slope / a.value);
  }
  friend Jet log(const Jet& a) {
    using std::log;
    const T r = 1.0 / a.value;
    return chain(a, log(a.value), r, -r * r);
  }
  friend Jet exp(const Jet& a) {
    using std::exp;
    const T e = exp(a.value);
    return chain(a, e, e, e);
  }
  friend Jet pow(const Jet& a, double p) {
    using std::pow;
    const T y = pow(a.value, p), r = 1.0 / a.value;
    return chain(a, y, p * y * r, p * (p - 1.0) * y * r * r);
  }

  /// g(a) from the value and the first two derivatives of g at a. For functions that are not here.
  friend Jet chain(const Jet& a, const T& g, const T& slope, const T& bend) {
    Jet c = map2(a, a, [&](const T& x, const T&) { return slope * x; });
    c.value = g;
    if constexpr (order == 2)
      for (std::size_t i = 0, k = 0; i < variables; ++i)
        for (std::size_t j = i; j < variables; ++j, ++k) c.curvature[k] += bend * a.gradient[i] * a.gradient[j];
    return c;
  }

private:
  template <class Function>
  static Jet map2(const Jet& a, const Jet& b, Function&& function) {
    Jet c;
    c.value = function(a.value, b.value);
    for (std::size_t i = 0; i < variables; ++i) c.gradient[i] = function(a.gradient[i], b.gradient[i]);
    for (std::size_t i = 0; i < curvatures; ++i) c.curvature[i] = function(a.curvature[i], b.curvature[i]);
    return c;
  }
};

/// The number without its derivatives, for history and decisions.
inline double valueOf(double x) { return x; }
template <int order>
double valueOf(const Jet<double, order>& x) {
  return x.value;
}

}  // namespace dovetail::fem
