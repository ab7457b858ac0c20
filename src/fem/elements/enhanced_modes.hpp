// The nine modes of an enhanced brick: their linear systems and the search for their equilibrium.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "lane.hpp"

namespace dovetail::fem::detail::enhanced {

inline constexpr int N = 8;
inline constexpr std::size_t Q = 8, M = 9;  // points, modes: α_ij is mode 3 i + j
inline constexpr int maxIterations = 40;
inline constexpr double relativeTolerance = 1e-10;
using Tensors = std::array<Lane, 9 * Q>;
using Modes = std::array<Lane, M>;

struct alignas(laneBytes) EnhancedGeometry {
  std::array<Lane, 9> map0, left;    ///< J₀⁻¹ = ∂ξ/∂X at the centre, J₀⁻ᵀ
  std::array<Lane, Q> ratio;         ///< j₀/j
  std::array<Lane, 3 * N> gradient;  ///< ∂ψ_a/∂X at the centre, [3 a + J]
};

/// State of a batch at given u and α.
struct State {
  Tensors F, P;
  Lane F0[9], F0left[9];    ///< F₀; F₀ J₀⁻ᵀ
  Lane enhancement[9 * Q];  ///< Ĥ
};

/// Solves A x = b for each lane without pivoting (A is close to a symmetric positive definite matrix).
inline void solveModes(std::array<Lane, M * M>& A, Modes& b, std::size_t columns = 0, Lane* more = nullptr) {
  for (std::size_t k = 0; k < M; ++k)
    for (std::size_t r = k + 1; r < M; ++r) {
      const Lane factor = A[M * r + k] / A[M * k + k];
      for (std::size_t c = k + 1; c < M; ++c) A[M * r + c] -= factor * A[M * k + c];
      b[r] -= factor * b[k];
      for (std::size_t c = 0; c < columns; ++c) more[columns * r + c] -= factor * more[columns * k + c];
    }
  for (std::size_t k = M; k-- > 0;) {
    for (std::size_t c = k + 1; c < M; ++c) {
      b[k] -= A[M * k + c] * b[c];
      for (std::size_t d = 0; d < columns; ++d) more[columns * k + d] -= A[M * k + c] * more[columns * c + d];
    }
    b[k] /= A[M * k + k];
    for (std::size_t d = 0; d < columns; ++d) more[columns * k + d] /= A[M * k + k];
  }
}

/// Largest share of the residual in its tolerance, per lane; ≤ 1 is zero.
inline Lane excess(const Modes& residual, const Modes& tolerance) {
  Lane worst{};
  for (std::size_t m = 0; m < M; ++m)
    for (int lane = 0; lane < laneCount; ++lane) {
      const double share = std::abs(residual[m][lane]) / std::max(tolerance[m][lane], 1e-300);
      if (!(share <= worst[lane]) && !std::isnan(worst[lane])) worst[lane] = share;  // NaN stays
    }
  return worst;
}

/// Bits of the lanes whose residual is not yet zero.
inline unsigned openLanes(const Lane& excess) {
  unsigned open = 0;
  for (int lane = 0; lane < laneCount; ++lane)
    if (!(excess[lane] <= 1.0)) open |= 1u << lane;
  return open;
}

/// Newton's step of a lane, and half of it where that made things much worse.
struct Search {
  Modes base{}, step{};
  Lane before{};

  void advance(Modes& alpha, const Modes& newton, const Lane& now, unsigned open, int iteration) {
    const double patience = iteration < maxIterations / 2 ? 100.0 : 1.0;  // κ ≫ μ: the first step overshoots
    for (int lane = 0; lane < laneCount; ++lane) {
      if (!(open >> lane & 1)) continue;
      const bool worse = iteration > 0 && !(now[lane] <= patience * before[lane]);
      for (std::size_t m = 0; m < M; ++m) {
        if (!worse) base[m][lane] = alpha[m][lane];
        step[m][lane] = worse ? 0.5 * step[m][lane] : newton[m][lane];
        alpha[m][lane] = base[m][lane] - step[m][lane];
      }
      if (!worse) before[lane] = now[lane];
    }
  }
};

inline bool hasNaN(const Lane& x) {
  return std::isnan(x[0]) || std::isnan(x[1]) || std::isnan(x[2]) || std::isnan(x[3]);
}

}  // namespace dovetail::fem::detail::enhanced
