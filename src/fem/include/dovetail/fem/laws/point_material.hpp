// What elements ask of a material: deformation gradient and history in, stress, tangent and energy out.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "dovetail/fem/laws/materials.hpp"

namespace dovetail::fem {

/// Points are handed over in groups of four, side by side, for vector registers.
inline constexpr std::size_t pointLanes = 4;

/// A batch of points; the number of groups is `groups`. Tensors are row-major and component-first:
/// entry (i, J) of F of lane l of group g is F[(9 g + 3 i + J) · 4 + l]. Lanes beyond those in use repeat a valid
/// point.
struct PointBatch {
  std::size_t groups;
  const double* F;  ///< ∂x/∂X
  double* P;        ///< out: first Piola–Kirchhoff stress ∂W/∂F, Pa
  double*
      tangent;  ///< out: ∂P_iJ/∂F_kL, 9 × 9 row-major per point, [(81 g + 9 (3i + J) + 3k + L) · 4 + l], Pa; or null
  double* energy;      ///< out: stored energy per reference volume, J/m³, [4 g + l]; or null
  double* dissipated;  ///< out: energy dissipated in this step per reference volume, J/m³, ≥ 0, [4 g + l]; or null
  const double* history;  ///< at the start of the step, historySize per point, [(4 g + l) · historySize + k]
  double* newHistory;     ///< out: at its end, same layout; may not overlap `history`
  double dt;              ///< length of the step, s; 0 where no time passes
  /// Rates are asked for at the end of the step, as schemes of second order need them that weigh forces at both ends of
  /// a step; else their means over the step, which are never sharper than what happened in it.
  bool rateAtEnd = false;
};

/// A material at a point. One virtual call per batch; implementations keep no state of their own (everything that
/// changes is in the history), so one object may serve many threads and solids.
///
/// Whatever can answer for F may stand behind this: a law, a table, a cell of particles.
class PointMaterial {
public:
  virtual ~PointMaterial() = default;
  /// For reports: "neo-Hookean".
  virtual std::string name() const = 0;
  /// Reference density, kg/m³.
  virtual double density() const = 0;
  /// Numbers remembered per point; 0 takes no memory.
  virtual std::size_t historySize() const { return 0; }
  /// Writes the history of a point that has never been loaded.
  virtual void startHistory(std::span<double> /*history*/) const {}
  /// Whether P = ∂W/∂F with the reported energy, always (elastic).
  virtual bool isElastic() const { return historySize() == 0; }
  /// Whether the stress depends on how fast F changes, not on its past alone: dt counts, and so do velocities at the
  /// start of a run.
  virtual bool feelsRates() const { return false; }
  /// Largest ratio of viscosity to modulus, s: it shortens explicit steps.
  virtual double dampingTime() const { return 0.0; }
  /// Whether the tangent has the symmetry (iJ)(kL); if not, solvers factorise without it.
  virtual bool isSymmetric() const { return true; }
  /// The law, if it is one that the hand-written kernels of bricks know.
  virtual std::optional<Material> brickLaw() const { return {}; }
  /// A NaN in the stress means that the law has no answer for F; elements report the point.
  virtual void evaluate(const PointBatch& batch) const = 0;
  /// Why the answer for F (nine numbers, row-major) cannot be trusted, and what to do; empty if it can. Says more than
  /// a NaN does: a law may be past its limit point and still have a stress. Elements ask it of accepted states.
  virtual std::string whyInvalid(const double* F) const;  // by default as whyInverted()
};

/// The sentence for F (nine numbers, row-major) with det F ≤ 0 or NaN; empty for others.
std::string whyInverted(const double* F);

}  // namespace dovetail::fem
