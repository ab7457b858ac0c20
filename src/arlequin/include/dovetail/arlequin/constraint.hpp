// Constraints: from the gap at the coarse nodes to the forces λ that hold the two models together.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dovetail/arlequin/gap_operator.hpp"
#include "dovetail/arlequin/overlap.hpp"
#include "dovetail/core/vec3.hpp"
#include "dovetail/fem/model/model_mass.hpp"

namespace dovetail::arlequin {

/// Input of a constraint, one entry per row of the gap operator.
struct GapRates {
  std::span<const Vec3> gap;           ///< accumulated, m
  std::span<const Vec3> increment;     ///< of the last step, m
  std::span<const Vec3> velocity;      ///< of the gap, m/s; only for a constraint with needsRates()
  std::span<const Vec3> acceleration;  ///< of the gap without this constraint, m/s²; only with needsRates()
  double dt;                           ///< s
};

class Constraint {
public:
  virtual ~Constraint() = default;
  /// λ per row, N: positive along the gap; the particles get −Πᵀλ, the nodes Bᵀλ.
  virtual void evaluate(const GapRates& rates, std::span<Vec3> lambda) const = 0;
  virtual bool needsRates() const { return false; }
  /// Whether λ is linear in the accumulated gap and derives from the energy ½ Σ gap · λ, J; others store nothing.
  virtual bool stores() const { return false; }
  /// lambda = ∂λ/∂gap · gap, untouched by constraints without stiffness. For the critical step.
  virtual void applyStiffness(std::span<const Vec3>, std::span<Vec3>) const {}
};

/// λ_i = p V_i g_i on the accumulated gap: stores ½ Σ p V_i |g_i|², loses nothing. With weights w and 1 − w of density
/// ρ and no other stiffness it is stable for p dt²/(ρ w (1 − w)) < 4.
/// @param stiffness  p V_i per row, N/m
/// @throws InputError unless all are finite and > 0
std::unique_ptr<Constraint> makePenalty(std::vector<double> stiffness);

/// The penalty for wide kernels, whose rows overlap so much that the sum over rows sees long waves only: the energy is
/// ½ p ∫|r|² of the part r of the particles' gap field that the rows of Π can see at all, ½ p gᵀ (Π D Πᵀ)⁺ g with D the
/// inverse volumes of the particles. It does not depend on the width as long as no direction is lost to round-off.
/// Solved by sparse factors; where rows depend on each other, 1e-11 of the metric's diagonal is added to it.
/// @param volume  of each overlap particle, m³
/// @throws InputError unless the penalty is finite and > 0; NumericalError for rows that no factors can be found of
std::unique_ptr<Constraint> makeMetricPenalty(const GapOperator& gap, std::span<const double> volume, double penalty);

/// λ_i = ε V_i Δg_i on the increments of one step, or ε Σ_j ∫ψ_iψ_j Δg_j (`consistent`) (Cheng et al. 2023, Eqs.
/// 29–32). It acts as a dashpot of ε dt V: halving dt halves it, and it loses what it damps. Stable, with weights w and
/// 1 − w of density ρ and no stiffness, for ε dt²/(ρ w (1 − w)) < 2.
/// @param penalty  ε, Pa/m²
/// @throws InputError unless ε is finite and > 0
std::unique_ptr<Constraint> makeDashpot(const GapOperator& gap, double penalty, bool consistent);

/// Lagrange multipliers that keep the gap's rate at zero: λ = A⁺ (g̈ + ġ/dt) with A = Π M_DE⁻¹ Πᵀ + B M_FE⁻¹ Bᵀ.
/// Workless. Conjugate gradients to 1e-12 of the load, led by sparse factors of A with lumped masses, made once: one or
/// two iterations where these are the masses. A closer initial λ gives a more accurate one. Linearly dependent rows do
/// no harm, as the load has no component in their null space.
/// @param particleMass  of all particles, weighted, kg; ∞ for one that is fixed
/// @param solid   gives M_FE⁻¹; must live as long as the constraint
/// @param before  multipliers that these replace: their analysis is reused where the pattern is the same
/// @throws NumericalError, also in evaluate, if no factors can be found or the iteration does not converge
std::unique_ptr<Constraint> makeMultiplier(const GapOperator& gap, const Overlap& overlap,
                                           std::span<const double> particleMass, const fem::ModelMass& solid,
                                           std::unique_ptr<Constraint> before = nullptr);

/// 20 E/h², Pa/m²: the waveform is then within a tenth of a percentage point of the multipliers', and the critical step
/// of cubes with a weight floor of 1e-3 is a seventeenth of h over the wave speed or more.
double automaticPenalty(double youngsModulus, double elementSize);

}  // namespace dovetail::arlequin
