// Tangent of laws for Green's strain.
#pragma once

#include "dovetail/fem/laws/tensor.hpp"

namespace dovetail::fem::detail {

/// Calls visit(r, c ≥ r, value) for δ_ik S_JL + λ F_iJ F_kL + μ (b_ik δ_JL + F_iL F_kJ), r = 3i + J, c = 3k + L: the
/// tangent of P = F S where S changes by λ tr(dE) 1 + 2μ dE. It is symmetric.
template <class T, class Visit>
[[gnu::always_inline]] inline void forGreenModuli(const Tensor<T>& F, const Tensor<T>& S, const T& lambda, const T& mu,
                                                  Visit&& visit) {
  const Tensor<T> b = gram(transposed(F));
  for (std::size_t r = 0; r < 9; ++r)
    for (std::size_t c = r; c < 9; ++c) {
      const std::size_t i = r / 3, J = r % 3, k = c / 3, L = c % 3;
      T entry = lambda * F[r] * F[c] + mu * F[3 * i + L] * F[3 * k + J];
      if (i == k) entry += S[3 * J + L];
      if (J == L) entry += mu * b[3 * i + k];
      visit(r, c, entry);
    }
}

}  // namespace dovetail::fem::detail
