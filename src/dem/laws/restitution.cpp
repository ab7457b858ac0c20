#include "dovetail/dem/laws/restitution.hpp"

#include <cmath>
#include <numbers>

namespace dovetail::dem {

double dampingRatioOf(double restitution) {
  const double lnE = std::log(restitution);
  return restitution == 1.0 ? 0.0 : -lnE / std::hypot(std::numbers::pi, lnE);
}

double reboundWithoutTension(double dampingRatio) {
  const double z = dampingRatio, root = std::sqrt(std::abs(1.0 - z * z));
  if (root < 1e-6) return std::exp(-2.0);
  if (z < 1.0) return std::exp(-z / root * 2.0 * std::atan2(root, z));
  return std::exp(-z / root * 2.0 * std::log(z + root));
}

double dampingRatioWithoutTension(double restitution) {
  if (restitution == 1.0) return 0.0;
  double low = 0.0, high = 1.0 + 1.0 / std::sqrt(restitution);
  for (int i = 0; i < 200 && low < high; ++i) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) break;
    (reboundWithoutTension(middle) > restitution ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace dovetail::dem
