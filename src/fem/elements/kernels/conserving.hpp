// The discrete gradient of a stored energy in the right Cauchy–Green tensor, for energy–momentum steps.
//
// With C̄ = ½(C₀ + C₁), S̄ = S(C̄): S_alg = S̄ + (2(W₁ − W₀) − S̄:ΔC) ΔC / ΔC:ΔC (Gonzalez 2000, Eq. 37). Then
// ½ S_alg : ΔC = W₁ − W₀ exactly, and P = F̄ S_alg conserves both momenta (Simo & Tarnow 1992).
#pragma once

#include "cell_kernels.hpp"

namespace dovetail::fem::detail {

/// C = FᵀF, row-major.
DOVETAIL_INLINE void rightCauchyGreen(const Lane* F, Lane* C) {
  for (std::size_t I = 0; I < 3; ++I)
    for (std::size_t J = 0; J < 3; ++J) C[3 * I + J] = F[I] * F[J] + F[3 + I] * F[3 + J] + F[6 + I] * F[6 + J];
}

DOVETAIL_INLINE Lane squareRoot(Lane x) {
  Lane root;
  for (int lane = 0; lane < laneCount; ++lane) root[lane] = __builtin_sqrt(x[lane]);
  return root;
}

/// An upper triangular U with UᵀU = C: a deformation gradient whose right Cauchy–Green tensor is C.
DOVETAIL_INLINE void factorMetric(const Lane* C, Lane* U) {
  U[3] = U[6] = U[7] = Lane{};
  U[0] = squareRoot(C[0]);
  U[1] = C[1] / U[0];
  U[2] = C[2] / U[0];
  U[4] = squareRoot(C[4] - U[1] * U[1]);
  U[5] = (C[5] - U[1] * U[2]) / U[4];
  U[8] = squareRoot(C[8] - U[2] * U[2] - U[5] * U[5]);
}

/// x ← U⁻¹ x for the three columns of a row-major matrix.
DOVETAIL_INLINE void solveUpper(const Lane* U, Lane* x) {
  for (std::size_t c = 0; c < 3; ++c) {
    x[6 + c] /= U[8];
    x[3 + c] = (x[3 + c] - U[5] * x[6 + c]) / U[4];
    x[c] = (x[c] - U[1] * x[3 + c] - U[2] * x[6 + c]) / U[0];
  }
}

/// S = U⁻¹ P, row-major.
DOVETAIL_INLINE void secondStress(const Lane* U, const Lane* P, Lane* S) {
  for (std::size_t k = 0; k < 9; ++k) S[k] = P[k];
  solveUpper(U, S);
}

/// Below this |ΔC| the work of S on the straight path from C₀ to C₁ by three Gauss points, the mean metric among them,
/// is as exact as W₁ − W₀ (its error is of seventh order), and free of the cancellation of that difference.
inline constexpr double shortPath = 1e-2;
/// The places of the first and the last point on the path.
inline constexpr double pathPoints[2] = {0.11270166537925831148, 0.88729833462074168852};

/// ΔC:ΔC.
DOVETAIL_INLINE Lane squaredChange(const Lane* C0, const Lane* C1) {
  Lane square{};
  for (std::size_t k = 0; k < 9; ++k) square += (C1[k] - C0[k]) * (C1[k] - C0[k]);
  return square;
}

/// Turns S̄ into S_alg.
/// @param W0, W1  stored energies, for lanes with a longer path
/// @param Sa, Sb  stresses at pathPoints, for lanes with a short one
/// @param S       S̄ at the mean metric, row-major; overwritten
DOVETAIL_INLINE void correctStress(const Lane* C0, const Lane* C1, Lane W0, Lane W1, const Lane* Sa, const Lane* Sb,
                                   Lane* S) {
  const Lane square = squaredChange(C0, C1);
  Lane work{}, pathGap{};
  Lane change[9];
  for (std::size_t k = 0; k < 9; ++k) {
    change[k] = C1[k] - C0[k];
    work += S[k] * change[k];
    pathGap += 5.0 / 18.0 * ((Sa[k] - S[k]) + (Sb[k] - S[k])) * change[k];
  }
  for (int lane = 0; lane < laneCount; ++lane) {
    if (!(square[lane] > 0.0)) continue;
    const bool isShort = square[lane] < shortPath * shortPath;
    const double factor = (isShort ? pathGap[lane] : 2.0 * (W1[lane] - W0[lane]) - work[lane]) / square[lane];
    for (std::size_t k = 0; k < 9; ++k) S[k][lane] += factor * change[k][lane];
  }
}

/// The moduli ∂P/∂F₁ = ½(1 ⊗ S + F̄ D F₁), D = 2 ∂S/∂C at the mean metric, from A = ∂P/∂F at U. The second leg is the
/// gradient at the end: without it rigid turns in a step would seem stiff. Not symmetric, therefore; what the
/// correction adds is left out, a fraction |ΔC| of D.
/// @param mean, end  F̄ and F₁
/// @param A          overwritten
DOVETAIL_INLINE void conservingModuli(const Lane* U, const Lane* mean, const Lane* end, const Lane* meanStress,
                                      const Lane* S, Lane* A) {
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t J = 0; J < 3; ++J)
      for (std::size_t L = 0; L < 3; ++L) A[9 * (3 * i + J) + 3 * i + L] -= meanStress[3 * J + L];
  // B = mean · U⁻¹ carries the first index of each pair from U to the mean gradient: Bᵀ = U⁻ᵀ meanᵀ.
  Lane inverse[9] = {};
  addIdentity(inverse);
  solveUpper(U, inverse);
  Lane B[9], E[9];
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      B[3 * i + j] = mean[3 * i] * inverse[j] + mean[3 * i + 1] * inverse[3 + j] + mean[3 * i + 2] * inverse[6 + j];
      E[3 * i + j] = end[3 * i] * inverse[j] + end[3 * i + 1] * inverse[3 + j] + end[3 * i + 2] * inverse[6 + j];
    }
  Lane half[81];
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t J = 0; J < 3; ++J)
      for (std::size_t q = 0; q < 9; ++q)
        half[9 * (3 * i + J) + q] =
            B[3 * i] * A[9 * J + q] + B[3 * i + 1] * A[9 * (3 + J) + q] + B[3 * i + 2] * A[9 * (6 + J) + q];
  for (std::size_t p = 0; p < 9; ++p)
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t L = 0; L < 3; ++L)
        A[9 * p + 3 * k + L] = 0.5 * (E[3 * k] * half[9 * p + L] + E[3 * k + 1] * half[9 * p + 3 + L] +
                                      E[3 * k + 2] * half[9 * p + 6 + L]);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t J = 0; J < 3; ++J)
      for (std::size_t L = 0; L < 3; ++L) A[9 * (3 * i + J) + 3 * i + L] += 0.5 * S[3 * J + L];
}

}  // namespace dovetail::fem::detail
