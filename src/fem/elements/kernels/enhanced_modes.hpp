// The nine modes of an enhanced brick: what they do to F, and the stress and the stiffness that they meet.
#pragma once

#include <array>
#include <cstddef>

#include "elements/lanes/small_tensors.hpp"
#include "elements/solids/solid_base.hpp"

namespace dovetail::fem::detail::enhanced {

inline constexpr int N = 8;
inline constexpr std::size_t Q = 8, M = 9;  // points, modes: α_ij is mode 3 i + j
using Tensors = Lanes<9 * Q>;
using Moduli = Lanes<81 * Q>;
using Displacements = Lanes<3 * N>;
using Modes = Lanes<M>;
using ModeMatrix = Lanes<M * M>;

struct alignas(laneBytes) EnhancedGeometry {
  std::array<Lane, 9> map0, left;    ///< J₀⁻¹ = ∂ξ/∂X at the centre, J₀⁻ᵀ
  std::array<Lane, Q> ratio;         ///< j₀/j
  std::array<Lane, 3> mean;          ///< of ξ under the fraction: modes do no work on a uniform stress
  std::array<Lane, 3 * N> gradient;  ///< ∂ψ_a/∂X at the centre, [3 a + J]
};

/// A batch: its points and what belongs to its centre.
struct EnhancedCells {
  const CellRule& rule;
  const PointGeometry* point;
  const EnhancedGeometry& centre;
  std::size_t inUse;  ///< lanes

  const Vec3* gradients(std::size_t q) const { return &rule.gradient[N * q]; }
  /// (j₀/j) (ξ_i − its mean).
  DOVETAIL_INLINE Lane scale(std::size_t q, std::size_t i) const {
    return centre.ratio[q] * (rule.point[q][static_cast<int>(i)] - centre.mean[i]);
  }
};

/// State of a batch at given u and α.
struct alignas(laneBytes) State {
  Tensors compatible;  ///< F_u
  Tensors F, P;
  Lane F0[9], F0left[9];  ///< F₀; F₀ J₀⁻ᵀ
  Lane enhancement[27];   ///< Ĥ = Σ_i (j₀/j) ξ_i H_i, [9 i + 3 r + J]
  Lane stress[27];        ///< S_i = Σ weight (j₀/j) ξ_i P, [9 i + 3 r + J]
};

/// Sets what of the state depends on u alone.
/// @param U  displacements of the nodes, [3 a + i], m
void setDisplacements(const EnhancedCells& cells, const Displacements& U, State& s);
/// Sets F at all points.
void setModes(const EnhancedCells& cells, const Modes& alpha, State& s);
/// r_m = Σ weight P : ∂F/∂α_m, ∂F/∂α_ij being column i of F₀J₀⁻ᵀ times row j of J₀⁻¹, scaled; and what of it counts as
/// zero: a fraction of the sum of magnitudes, and what round-off of F does.
/// @param resolution  of stress, Pa
void modeResidual(const EnhancedCells& cells, double fraction, double resolution, State& s, Modes& residual,
                  Modes& tolerance);
/// (∂r_m/∂α_n)⁻¹; one in lanes that repeat an element.
void inverseOfModes(const EnhancedCells& cells, const State& s, const Moduli& A, ModeMatrix& inverse);
/// step = K⁻¹ r.
void modeStep(const ModeMatrix& inverse, const Modes& residual, Modes& step);
/// ∂U/∂u, N, [3 a + i].
void modeForces(const EnhancedCells& cells, const State& s, Lane* f);
/// ∂²U/∂u∂u with the modes in equilibrium, N/m, [24 (3 a + i) + 3 b + k].
template <bool symmetric>
void condensedTangent(const EnhancedCells& cells, const State& s, const Moduli& A, Lane* K);

}  // namespace dovetail::fem::detail::enhanced
