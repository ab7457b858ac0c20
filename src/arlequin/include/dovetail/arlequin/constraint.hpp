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
#include "dovetail/fem/blended_mass.hpp"
#include "dovetail/fem/nodes.hpp"

namespace dovetail::arlequin {

/// What a constraint may look at, one entry per row of the gap operator.
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
  /// J, a function of the accumulated gap; 0 for constraints that store nothing.
  virtual double storedEnergy(std::span<const Vec3>) const { return 0.0; }
  /// ∂λ/∂gap per row on the diagonal, N/m; 0 for constraints without stiffness. For the critical step.
  virtual double stiffness(std::size_t) const { return 0.0; }
};

/// λ_i = p V_i g_i on the accumulated gap: stores ½ Σ p V_i |g_i|², loses nothing. With shares w and 1 − w of density ρ
/// and no other stiffness it is stable for p dt²/(ρ w (1 − w)) < 4.
/// @param penalty  p, Pa/m² (N/m per m³)
/// @throws InputError unless p is finite and > 0
std::unique_ptr<Constraint> makePenalty(const GapOperator& gap, double penalty);

/// λ_i = ε V_i Δg_i on the increments of one step, or ε Σ_j ∫ψ_iψ_j Δg_j (`consistent`) (Cheng et al. 2023, Eqs.
/// 29–32). It acts as a dashpot of ε dt V: halving dt halves it, and it loses what it damps. Stable, with shares w and
/// 1 − w of density ρ and no stiffness, for ε dt²/(ρ w (1 − w)) < 2.
/// @param penalty  ε, Pa/m²
/// @throws InputError unless ε is finite and > 0
std::unique_ptr<Constraint> makeDashpot(const GapOperator& gap, double penalty, bool consistent);

/// Lagrange multipliers that keep the gap's rate at zero: λ = A⁺ (g̈ + ġ/dt) with A = Π M_DE⁻¹ Πᵀ + B M_FE⁻¹ Bᵀ.
/// Workless. A is inverted once, by its eigenvalues: directions whose eigenvalue is below `rankTolerance` of the
/// largest (rows that depend on others) are left out.
/// @param particleMass  of all particles, weighted, kg   @param mass  the solid's mass if it is not lumped
/// @throws InputError for more than 4000 rows (take the penalty, which needs no solve)
std::unique_ptr<Constraint> makeMultiplier(const GapOperator& gap, const Overlap& overlap,
                                           std::span<const double> particleMass, const fem::Nodes& nodes,
                                           const fem::BlendedMass* mass, double rankTolerance = 1e-10);

/// 5 E/h²: stiff enough that the gap costs no accuracy, soft enough not to set the time step.
double automaticPenalty(double youngsModulus, double elementSize);

}  // namespace dovetail::arlequin
