// Which dashpot gives which restitution.
#pragma once

namespace dovetail::dem {

/// Restitution of a damped oscillator whose contact lasts until the overlap has gone: e = exp(−π ζ/√(1 − ζ²)), ζ being
/// the damping over the critical one. Here the inverse, ζ = −ln e/√(π² + ln²e); 0 < e ≤ 1.
double dampingRatioOf(double restitution);

/// Restitution if the contact may not pull, so that it ends when the force has dropped to zero:
///   ζ < 1: e = exp(−ζ/√(1 − ζ²) (π − 2 asin ζ)),   ζ > 1: e = exp(−ζ/√(ζ² − 1) ln((ζ + √(ζ² − 1))/(ζ − √(ζ² − 1))))
/// (Schwager & Pöschel, Granular Matter 9, 2007). Falls from 1 (ζ = 0) through e⁻² (ζ = 1) to 0 (ζ → ∞).
double reboundWithoutTension(double dampingRatio);

/// The ζ ≥ 0 for which reboundWithoutTension is e; 0 < e ≤ 1.
double dampingRatioWithoutTension(double restitution);

}  // namespace dovetail::dem
