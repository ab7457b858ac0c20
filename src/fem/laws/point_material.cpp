#include "dovetail/fem/laws/point_material.hpp"

#include "dovetail/core/finite.hpp"

namespace dovetail::fem {

std::string whyInverted(const double* F) {
  const double J =
      F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) + F[2] * (F[3] * F[7] - F[4] * F[6]);
  if (J > 0.0) return {};
  return "det F is " + formatNumber(J) + ", the material is turned inside out: take smaller steps or a finer mesh";
}

std::string PointMaterial::whyInvalid(const double* F) const { return whyInverted(F); }

}  // namespace dovetail::fem
