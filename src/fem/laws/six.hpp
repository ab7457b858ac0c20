// Symmetric tensors as six numbers, and isotropic elasticity in them.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "dovetail/fem/laws/tensor.hpp"

namespace dovetail::fem::detail {

/// 11, 22, 33, √2·12, √2·23, √2·31, so that A:B is a dot product.
template <class T>
using SixOf = std::array<T, 6>;
template <class T>
using SixBySixOf = std::array<T, 36>;
using Six = SixOf<double>;
using SixBySix = SixBySixOf<double>;

inline constexpr std::array<std::array<std::size_t, 3>, 3> sixEntry = {{{0, 3, 5}, {3, 1, 4}, {5, 4, 2}}};
/// Tensor component per entry.
constexpr double sixWeight(std::size_t a, std::size_t b) { return a == b ? 1.0 : 1.0 / std::numbers::sqrt2; }

template <class T>
T dot(const SixOf<T>& a, const SixOf<T>& b) {
  T sum = a[0] * b[0];
  for (std::size_t i = 1; i < 6; ++i) sum += a[i] * b[i];
  return sum;
}
template <class T>
T trace(const SixOf<T>& a) {
  return a[0] + a[1] + a[2];
}
template <class T>
SixOf<T> deviator(SixOf<T> a) {
  const T mean = trace(a) / 3.0;
  for (std::size_t i = 0; i < 3; ++i) a[i] -= mean;
  return a;
}
template <class T>
Tensor<T> tensorOf(const SixOf<T>& a) {
  Tensor<T> t;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) t[3 * i + j] = sixWeight(i, j) * a[sixEntry[i][j]];
  return t;
}
inline Six sixOf(const Tensor<double>& t) {
  constexpr double root = std::numbers::sqrt2;
  return {t[0], t[4], t[8], root * t[1], root * t[5], root * t[2]};
}

/// Hooke's law: κ tr ε 1 + 2μ dev ε.
struct HenckyElasticity {
  double kappa, mu;

  template <class T>
  SixOf<T> stress(const SixOf<T>& strain) const {
    SixOf<T> s = deviator(strain);
    for (std::size_t i = 0; i < 6; ++i) s[i] = 2.0 * mu * s[i];
    for (std::size_t i = 0; i < 3; ++i) s[i] += kappa * trace(strain);
    return s;
  }
  template <class T>
  T energy(const SixOf<T>& strain) const {
    return 0.5 * dot(stress(strain), strain);
  }
};

/// bulk 1⊗1 + shear (1 − ⅓ 1⊗1).
template <class T = double>
SixBySixOf<T> isotropicStiffness(double bulk, double shear) {
  SixBySixOf<T> D;
  D.fill(T(0.0));
  for (std::size_t i = 0; i < 6; ++i) D[7 * i] = shear;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) D[6 * i + j] += bulk - shear / 3.0;
  return D;
}
/// D += a ⊗ b.
inline void addOuterProduct(SixBySix& D, const Six& a, const Six& b) {
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 6; ++j) D[6 * i + j] += a[i] * b[j];
}

}  // namespace dovetail::fem::detail
