// Viscosity beside any other law.
#pragma once

#include <cstddef>
#include <memory>

#include "dovetail/fem/laws/point_material.hpp"

namespace dovetail::fem {

/// Kelvin–Voigt: the stress of `base` plus F S with S = κ_v tr(Ė) 1 + 2η dev Ė and E = ½(FᵀF − 1), Ė by the difference
/// over the step: that of the middle of the step. Where rates are asked for at its end (PointBatch::rateAtEnd: implicit
/// schemes but the conserving one) it goes on along the line through the differences of this step and the last. Rigid
/// motion is not resisted, whatever its size. Dissipates ΔE : (mean stress of the step) ≥ 0 per step; no stress for
/// dt = 0. A solid that starts deformed would feel a jump: commit() its term once with dt = 0.
///
/// Explicit steps must be shorter than those of `base`: √(τ² + h²) − τ, with the stable step h without viscosity and
/// the ratio τ of viscosity to modulus, s; stableStep() does so with the moduli at rest.
/// The history is FᵀF at the start of the step, 11, 22, 33, 12, 23, 31, the mean Ė of the step before, its length, and
/// then that of `base`.
struct KelvinVoigt {
  std::shared_ptr<const PointMaterial> base;
  double bulkViscosity;   ///< κ_v ≥ 0, Pa s
  double shearViscosity;  ///< η ≥ 0, Pa s
};

/// Numbers of its history before those of `base`.
inline constexpr std::size_t viscousHistory = 13;

/// Viscosities that are `time` times the elastic moduli: small motions at ω are damped by the ratio ω time/2.
/// @param time  s
/// @throws InputError unless time ≥ 0, youngsModulus > 0, −1 < poissonRatio < 0.5
KelvinVoigt kelvinVoigt(std::shared_ptr<const PointMaterial> base, double time, double youngsModulus,
                        double poissonRatio);

/// @throws InputError without a base or for negative viscosities
std::shared_ptr<const PointMaterial> pointMaterial(const KelvinVoigt& law);

}  // namespace dovetail::fem
