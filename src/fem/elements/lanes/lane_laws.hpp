// Strain and stress of four elements at one Gauss point. Symmetric tensors are 11, 22, 33, 12, 23, 31;
// `strain` is 2E = FᵀF − 1 throughout, so that no factor ½ is spent on it.
#pragma once

#include "trilinear.hpp"

namespace dovetail::fem::detail::bricks {

using Symmetric = std::array<Lane, 6>;

/// Symmetric entry of (i, j).
inline constexpr std::array<std::array<std::size_t, 3>, 3> entryOf = {{{0, 3, 5}, {3, 1, 4}, {5, 4, 2}}};

/// 2E from H = ∂u/∂X; exactly zero for H = 0.
DOVETAIL_INLINE Symmetric doubleStrain(const Tensor& H) {
  const auto entry = [&](std::size_t i, std::size_t j) __attribute__((always_inline)) {
    return H[i][j] + H[j][i] + H[0][i] * H[0][j] + H[1][i] * H[1][j] + H[2][i] * H[2][j];
  };
  return {entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(1, 2), entry(2, 0)};
}

/// A·B of symmetric tensors that commute (the product is symmetric).
DOVETAIL_INLINE Symmetric commutingProduct(const Symmetric& a, const Symmetric& b) {
  const auto entry = [&](std::size_t i, std::size_t j) __attribute__((always_inline)) {
    return a[entryOf[i][0]] * b[entryOf[0][j]] + a[entryOf[i][1]] * b[entryOf[1][j]] +
           a[entryOf[i][2]] * b[entryOf[2][j]];
  };
  return {entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(1, 2), entry(2, 0)};
}

DOVETAIL_INLINE Symmetric inverseOf(const Symmetric& c) {
  const Lane c00 = c[1] * c[2] - c[4] * c[4], c01 = c[5] * c[4] - c[3] * c[2], c02 = c[3] * c[4] - c[5] * c[1];
  const Lane s = 1.0 / (c[0] * c00 + c[3] * c01 + c[5] * c02);
  return {s * c00, s * (c[0] * c[2] - c[5] * c[5]), s * (c[0] * c[1] - c[3] * c[3]),
          s * c01, s * (c[3] * c[5] - c[0] * c[4]), s * c02};
}

/// weight · (λ tr(E) 1 + 2μ E).
DOVETAIL_INLINE Symmetric kirchhoffStress(const LawConstants& law, Lane weight, const Symmetric& strain) {
  const Lane mu = law.mu * weight;
  const Lane pressure = law.halfLambda * weight * (strain[0] + strain[1] + strain[2]);
  return {pressure + mu * strain[0],
          pressure + mu * strain[1],
          pressure + mu * strain[2],
          mu * strain[3],
          mu * strain[4],
          mu * strain[5]};
}

/// weight · (λ tr(C⁻¹E) C⁻¹ + 2μ C⁻¹EC⁻¹); C⁻¹ and E commute because C = 1 + 2E.
DOVETAIL_INLINE Symmetric deformedMetricStress(const LawConstants& law, Lane weight, const Symmetric& strain) {
  const Symmetric B = inverseOf({1.0 + strain[0], 1.0 + strain[1], 1.0 + strain[2], strain[3], strain[4], strain[5]});
  const Symmetric mixed = commutingProduct(B, strain);
  Symmetric stress = commutingProduct(mixed, B);
  const Lane pressure = law.halfLambda * weight * (mixed[0] + mixed[1] + mixed[2]);
  const Lane mu = law.mu * weight;
  for (std::size_t i = 0; i < 6; ++i) stress[i] = mu * stress[i] + pressure * B[i];
  return stress;
}

DOVETAIL_INLINE Lane rootOf(Lane x) {
  Lane root;
  for (int lane = 0; lane < laneCount; ++lane) root[lane] = __builtin_sqrt(x[lane]);
  return root;
}

/// weight · (E (1 − 1/λ_i) on the diagonal, 2μ E_ij beside it), λ_i² = 1 + 2E_ii; written without cancellation.
DOVETAIL_INLINE Symmetric springStress(const LawConstants& law, Lane weight, const Symmetric& strain) {
  const Lane young = 2.0 * law.halfYoung * weight, mu = law.mu * weight;
  Symmetric stress;
  for (std::size_t i = 0; i < 3; ++i) {
    const Lane stretch = rootOf(1.0 + strain[i]);
    stress[i] = young * strain[i] / (stretch * (1.0 + stretch));
    stress[3 + i] = mu * strain[3 + i];
  }
  return stress;
}

/// Four times the energy of springStress.
DOVETAIL_INLINE Lane springEnergy(const LawConstants& law, Lane weight, const Symmetric& strain) {
  Lane normal{}, shear{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Lane elongation = strain[i] / (1.0 + rootOf(1.0 + strain[i]));
    normal += elongation * elongation;
    shear += strain[3 + i] * strain[3 + i];
  }
  return weight * (4.0 * law.halfYoung * normal + 2.0 * law.mu * shear);
}

/// S : 2E.
DOVETAIL_INLINE Lane contraction(const Symmetric& s, const Symmetric& strain) {
  return s[0] * strain[0] + s[1] * strain[1] + s[2] * strain[2] +
         2.0 * (s[3] * strain[3] + s[4] * strain[4] + s[5] * strain[5]);
}

/// Row i of S + H S, the first Piola–Kirchhoff stress.
DOVETAIL_INLINE std::array<Lane, 3> firstStressRow(const std::array<Lane, 3>& h, std::size_t i, const Symmetric& s) {
  std::array<Lane, 3> row;
  for (std::size_t j = 0; j < 3; ++j)
    row[j] = s[entryOf[i][j]] + h[0] * s[entryOf[0][j]] + h[1] * s[entryOf[1][j]] + h[2] * s[entryOf[2][j]];
  return row;
}

}  // namespace dovetail::fem::detail::bricks
