#include "dovetail/cg/images.hpp"

#include <cmath>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::cg {

PeriodicImages periodicImages(std::span<const Vec3> x, const AverageBox& cell, const std::array<bool, 3>& axes,
                              double reach) {
  requireNonNegative(reach, "reach of periodic images");
  for (int k = 0; k < 3; ++k)
    if (!(std::isfinite(cell.lower[k]) && std::isfinite(cell.upper[k]) && cell.lower[k] < cell.upper[k]))
      throw InputError("the cell is empty or not finite along axis " + std::to_string(k), "periodic images",
                       "give lower < upper");
  PeriodicImages images;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!isFinite(x[i]))
      throw InputError("not a finite vector", "point " + std::to_string(i), "give three finite numbers");
    std::array<double, 3> first{}, last{};
    for (int k = 0; k < 3; ++k) {
      if (!axes[static_cast<std::size_t>(k)]) continue;
      const double length = cell.upper[k] - cell.lower[k];
      first[static_cast<std::size_t>(k)] = std::ceil((cell.lower[k] - reach - x[i][k]) / length);
      last[static_cast<std::size_t>(k)] = std::floor((cell.upper[k] + reach - x[i][k]) / length);
    }
    for (double c = first[2]; c <= last[2]; ++c)
      for (double b = first[1]; b <= last[1]; ++b)
        for (double a = first[0]; a <= last[0]; ++a) {
          images.source.push_back(static_cast<int>(i));
          images.shift.push_back({a * (cell.upper.x - cell.lower.x), b * (cell.upper.y - cell.lower.y),
                                  c * (cell.upper.z - cell.lower.z)});
        }
  }
  return images;
}

}  // namespace dovetail::cg
