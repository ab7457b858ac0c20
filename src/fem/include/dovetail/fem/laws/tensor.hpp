// 3 × 3 tensors of any number type, row-major.
#pragma once

#include <array>
#include <cstddef>

namespace dovetail::fem {

template <class T>
using Tensor = std::array<T, 9>;

template <class T>
T determinant(const Tensor<T>& a) {
  return a[0] * (a[4] * a[8] - a[5] * a[7]) + a[1] * (a[5] * a[6] - a[3] * a[8]) + a[2] * (a[3] * a[7] - a[4] * a[6]);
}

/// det(A) A⁻ᵀ = ∂ det A / ∂A.
template <class T>
Tensor<T> cofactor(const Tensor<T>& a) {
  return {a[4] * a[8] - a[5] * a[7], a[5] * a[6] - a[3] * a[8], a[3] * a[7] - a[4] * a[6],
          a[2] * a[7] - a[1] * a[8], a[0] * a[8] - a[2] * a[6], a[1] * a[6] - a[0] * a[7],
          a[1] * a[5] - a[2] * a[4], a[2] * a[3] - a[0] * a[5], a[0] * a[4] - a[1] * a[3]};
}

template <class T>
T trace(const Tensor<T>& a) {
  return a[0] + a[4] + a[8];
}

/// A : B.
template <class T>
T contraction(const Tensor<T>& a, const Tensor<T>& b) {
  T sum = a[0] * b[0];
  for (std::size_t i = 1; i < 9; ++i) sum += a[i] * b[i];
  return sum;
}

/// s A.
template <class S, class T>
Tensor<T> scaled(const S& s, const Tensor<T>& a) {
  Tensor<T> b;
  for (std::size_t i = 0; i < 9; ++i) b[i] = s * a[i];
  return b;
}

template <class T>
Tensor<T> transposed(const Tensor<T>& a) {
  return {a[0], a[3], a[6], a[1], a[4], a[7], a[2], a[5], a[8]};
}

/// A B.
template <class T>
Tensor<T> product(const Tensor<T>& a, const Tensor<T>& b) {
  Tensor<T> c;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      c[3 * i + j] = a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
  return c;
}

/// Aᵀ A; of F it is the right Cauchy–Green tensor C.
template <class T>
Tensor<T> gram(const Tensor<T>& a) {
  Tensor<T> c;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) c[3 * i + j] = a[i] * a[j] + a[3 + i] * a[3 + j] + a[6 + i] * a[6 + j];
  return c;
}

/// Green's strain ½(FᵀF − 1).
template <class T>
Tensor<T> greenStrain(const Tensor<T>& F) {
  Tensor<T> E = gram(F);
  for (const std::size_t i : {0, 4, 8}) E[i] = E[i] - 1.0;
  return scaled(0.5, E);
}

}  // namespace dovetail::fem
