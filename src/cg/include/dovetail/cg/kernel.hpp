// Smoothing kernels: how far, and how, a point quantity is spread in space.
#pragma once

#include <cmath>

#include "dovetail/core/vec3.hpp"

namespace dovetail::cg {

enum class KernelShape {
  lucy,  ///< −3q⁴ + 8q³ − 6q² + 1, twice continuously differentiable (Cheng et al. 2023, Eq. 10)
  gauss  ///< exp(−q²/(2 σ²)) with σ = 1/3, cut off at q = 1, where it jumps by 1.1 % of its peak (Eq. 9)
};

/// Profile of the kernel, 1 at q = 0 and 0 for q ≥ 1.
/// @param q  distance over width, ≥ 0
inline double profile(KernelShape shape, double q) {
  if (!(q < 1.0)) return 0.0;
  if (shape == KernelShape::gauss) return std::exp(-4.5 * q * q);
  const double t = 1.0 - q;
  return t * t * t * (1.0 + 3.0 * q);  // the same polynomial, without cancellation at q = 1
}
/// d profile / d q; for the cut-off Gaussian without the jump at q = 1.
inline double profileDerivative(KernelShape shape, double q) {
  if (!(q < 1.0)) return 0.0;
  if (shape == KernelShape::gauss) return -9.0 * q * std::exp(-4.5 * q * q);
  return -12.0 * q * (1.0 - q) * (1.0 - q);
}

/// W(r) = peak · profile(r / width): non-negative, zero for r ≥ width, and ∫ W dx = 1 over 1-, 2- or 3-D space.
/// The truncated Gaussian is normalised over its support, in closed form: it loses nothing.
struct Kernel {
  KernelShape shape = KernelShape::lucy;
  int dimension = 3;   ///< of the space it is normalised on: 1, 2 or 3
  double width = 0.0;  ///< cut-off radius c, m

  /// W at a distance ≥ 0 (m), in m^−dimension.
  double operator()(double distance) const;
  /// dW/dr at a distance ≥ 0 (m), in m^−(dimension + 1).
  double derivative(double distance) const;
  /// ∇W at the point x − x_α = offset (m); zero at offset 0.
  Vec3 gradient(const Vec3& offset) const;
  /// W(0).
  double peak() const;
  /// ∫₀¹ W(|from + s (to − from)|) ds, in closed form; W(|from|) for a segment without length.
  double segmentMean(const Vec3& from, const Vec3& to) const;
};
// Every member above throws InputError if the width is not a finite number > 0 or the dimension is not 1, 2 or 3.

/// Peak times width^dimension: 1.25, 5/π, 105/(16π) for Lucy.
/// @throws InputError if the dimension is not 1, 2 or 3
double peakNumber(KernelShape shape, int dimension);

/// Mass fraction that exp(−r²/(2σ²)) / (σ√(2π))^dimension loses when it is cut off at 3σ without normalising it anew:
/// 0.27, 1.11 and 2.93 % in 1, 2 and 3 dimensions.
double gaussTailMass(int dimension);

/// @throws InputError naming the field if dimension is not 1, 2 or 3, or the width is not finite, negative, or zero
///         (zero passes if allowZeroWidth, for builders that document the local limit)
void requireValid(const Kernel& kernel, bool allowZeroWidth = false);

}  // namespace dovetail::cg
