// 3 × 3 tensors of four points side by side, row-major.
#pragma once

#include "lane.hpp"

namespace dovetail::fem::detail {

DOVETAIL_INLINE Lane magnitude(const Lane& x) { return x < 0.0 ? -x : x; }

/// F⁻¹ and det F.
DOVETAIL_INLINE Lane inverseOf(const Lane* F, Lane* inverse) {
  const Lane a = F[4] * F[8] - F[5] * F[7], b = F[5] * F[6] - F[3] * F[8], c = F[3] * F[7] - F[4] * F[6];
  const Lane J = F[0] * a + F[1] * b + F[2] * c, s = 1.0 / J;
  inverse[0] = s * a, inverse[1] = s * (F[2] * F[7] - F[1] * F[8]), inverse[2] = s * (F[1] * F[5] - F[2] * F[4]);
  inverse[3] = s * b, inverse[4] = s * (F[0] * F[8] - F[2] * F[6]), inverse[5] = s * (F[2] * F[3] - F[0] * F[5]);
  inverse[6] = s * c, inverse[7] = s * (F[1] * F[6] - F[0] * F[7]), inverse[8] = s * (F[0] * F[4] - F[1] * F[3]);
  return J;
}

DOVETAIL_INLINE Lane contraction(const Lane* a, const Lane* b) {
  Lane sum{};
  for (int k = 0; k < 9; ++k) sum += a[k] * b[k];
  return sum;
}

/// A : b of a 9 × 9 matrix.
DOVETAIL_INLINE void apply(const Lane* A, const Lane* b, Lane* result) {
  for (int p = 0; p < 9; ++p) result[p] = contraction(A + 9 * p, b);
}

/// b : A.
DOVETAIL_INLINE void applyTransposed(const Lane* A, const Lane* b, Lane* result) {
  for (int q = 0; q < 9; ++q) {
    Lane sum{};
    for (int p = 0; p < 9; ++p) sum += b[p] * A[9 * p + q];
    result[q] = sum;
  }
}

}  // namespace dovetail::fem::detail
