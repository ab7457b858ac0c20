// The tangent of an enhanced brick: of its displacements, of its modes, and what is left without the modes.
#pragma once

#include "cell_kernels.hpp"
#include "enhanced_modes.hpp"

namespace dovetail::fem::detail::enhanced {

/// Ĥ at a point.
DOVETAIL_INLINE void enhancementAt(const EnhancedCells& cells, const State& s, std::size_t q, Lane* H) {
  const Lane x = cells.scale(q, 0), y = cells.scale(q, 1), z = cells.scale(q, 2);
  for (std::size_t k = 0; k < 9; ++k)
    H[k] = x * s.enhancement[k] + y * s.enhancement[9 + k] + z * s.enhancement[18 + k];
}

/// A_p,kL with the second pair of indices along the modes, that pair first.
DOVETAIL_INLINE void alongModes(const Lane* A, const State& s, const EnhancedCells& cells, Lane* result) {
  const auto& row = cells.centre.map0;
  for (std::size_t p = 0; p < 9; ++p) {
    Lane half[9];  // Σ_s A_p,sL c_sk
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t L = 0; L < 3; ++L)
        half[3 * k + L] =
            A[9 * p + L] * s.F0left[k] + A[9 * p + 3 + L] * s.F0left[3 + k] + A[9 * p + 6 + L] * s.F0left[6 + k];
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t l = 0; l < 3; ++l)
        result[9 * (3 * k + l) + p] =
            half[3 * k] * row[3 * l] + half[3 * k + 1] * row[3 * l + 1] + half[3 * k + 2] * row[3 * l + 2];
  }
}

/// Second derivatives by the modes and the displacements.
struct ModeCouplings {
  Lanes<3 * N * M> toModes;    ///< ∂r_m/∂u, [24 m + 3 a + i]
  Lanes<3 * N * M> fromModes;  ///< ∂f/∂α_m, [24 m + 3 a + i]
};

/// ∂ψ_a/∂X + Ĥᵀ ∂ψ_a/∂X at the centre: δF = Σ δu_a ⊗ g_a at fixed α.
DOVETAIL_INLINE void effectiveGradients(const EnhancedCells& cells, const State& s, std::size_t q, Lane* g) {
  const auto& map = cells.point[q].map;
  const auto& g0 = cells.centre.gradient;
  Lane H[9];
  enhancementAt(cells, s, q, H);
  for (std::size_t a = 0; a < N; ++a) {
    const Vec3& parent = cells.gradients(q)[a];
    for (std::size_t J = 0; J < 3; ++J)
      g[3 * a + J] = parent.x * map[J] + parent.y * map[3 + J] + parent.z * map[6 + J] + H[J] * g0[3 * a] +
                     H[3 + J] * g0[3 * a + 1] + H[6 + J] * g0[3 * a + 2];
  }
}

/// K_ab += weight g_a · A · g_b, of the blocks a ≤ b if the moduli are symmetric.
template <bool symmetric>
DOVETAIL_INLINE void addDisplacementTangent(const Lane* A, Lane weight, const Lane* g, Lane* K) {
  for (std::size_t b = 0; b < N; ++b) {
    Lane T[27];  // A · g_b, [9 i + 3 k + J]
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t J = 0; J < 3; ++J)
        for (std::size_t k = 0; k < 3; ++k) {
          const Lane* const row = A + 9 * (3 * i + J) + 3 * k;
          T[9 * i + 3 * k + J] = weight * (row[0] * g[3 * b] + row[1] * g[3 * b + 1] + row[2] * g[3 * b + 2]);
        }
    const std::size_t last = symmetric ? b + 1 : N;
    for (std::size_t a = 0; a < last; ++a)
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
          const Lane* const t = T + 9 * i + 3 * k;
          K[3 * N * (3 * a + i) + 3 * b + k] += t[0] * g[3 * a] + t[1] * g[3 * a + 1] + t[2] * g[3 * a + 2];
        }
  }
}

/// result[24 m + 3 a + i] += scale_m Σ_J moduli_m,iJ g_aJ.
DOVETAIL_INLINE void addAlongGradients(const EnhancedCells& cells, std::size_t q, const Lane* moduli, const Lane* g,
                                       Lane* result) {
  for (std::size_t m = 0; m < M; ++m) {
    const Lane scale = cells.point[q].weight * cells.scale(q, m / 3);
    Lane scaled[9];
    for (std::size_t k = 0; k < 9; ++k) scaled[k] = scale * moduli[9 * m + k];
    for (std::size_t a = 0; a < N; ++a)
      for (std::size_t i = 0; i < 3; ++i)
        result[3 * N * m + 3 * a + i] +=
            scaled[3 * i] * g[3 * a] + scaled[3 * i + 1] * g[3 * a + 1] + scaled[3 * i + 2] * g[3 * a + 2];
  }
}

/// What the moduli of one point give; symmetric ones leave toModes alone.
template <bool symmetric>
DOVETAIL_INLINE void addModeCouplings(const EnhancedCells& cells, const State& s, std::size_t q, const Lane* A,
                                      const Lane* g, ModeCouplings& modes) {
  Lane turned[81];
  alongModes(A, s, cells, turned);
  addAlongGradients(cells, q, turned, g, modes.fromModes.data());
  if (symmetric) return;
  Lane transposed[81];
  for (std::size_t r = 0; r < 9; ++r)
    for (std::size_t c = 0; c < 9; ++c) transposed[9 * r + c] = A[9 * c + r];
  alongModes(transposed, s, cells, turned);
  addAlongGradients(cells, q, turned, g, modes.toModes.data());
}

/// What the stress gives, because F₀ turns the modes.
DOVETAIL_INLINE void addModeRotation(const EnhancedCells& cells, const State& s, ModeCouplings& modes) {
  const EnhancedGeometry& e = cells.centre;
  for (std::size_t m = 0; m < M; ++m) {
    const Lane *const stress = s.stress + 9 * (m / 3), *const row = &e.map0[3 * (m % 3)];
    Lane along[3];
    for (std::size_t i = 0; i < 3; ++i)
      along[i] = stress[3 * i] * row[0] + stress[3 * i + 1] * row[1] + stress[3 * i + 2] * row[2];
    for (std::size_t a = 0; a < N; ++a) {
      const Lane* const g0 = &e.gradient[3 * a];
      const Lane turn = e.left[m / 3] * g0[0] + e.left[3 + m / 3] * g0[1] + e.left[6 + m / 3] * g0[2];
      for (std::size_t i = 0; i < 3; ++i) {
        modes.fromModes[3 * N * m + 3 * a + i] += along[i] * turn;
        modes.toModes[3 * N * m + 3 * a + i] += along[i] * turn;
      }
    }
  }
}

/// K −= ∂f/∂α (∂r/∂α)⁻¹ ∂r/∂u, of the columns from the block of the row on if symmetric.
template <bool symmetric>
DOVETAIL_INLINE void condense(const ModeMatrix& inverse, const ModeCouplings& modes, Lane* K) {
  const Lane* const to = symmetric ? modes.fromModes.data() : modes.toModes.data();
  std::array<Lane, 3 * N * M> answer{};
  for (std::size_t m = 0; m < M; ++m)
    for (std::size_t n = 0; n < M; ++n)
      for (std::size_t c = 0; c < 3 * N; ++c) answer[3 * N * m + c] += inverse[M * m + n] * to[3 * N * n + c];
  for (std::size_t r = 0; r < 3 * N; ++r)
    for (std::size_t c = symmetric ? 3 * (r / 3) : 0; c < 3 * N; ++c) {
      Lane sum = modes.fromModes[r] * answer[c];
      for (std::size_t m = 1; m < M; ++m) sum += modes.fromModes[3 * N * m + r] * answer[3 * N * m + c];
      K[3 * N * r + c] -= sum;
    }
}

}  // namespace dovetail::fem::detail::enhanced
