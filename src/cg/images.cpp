#include "dovetail/cg/images.hpp"

#include <array>
#include <cmath>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::cg {

namespace {

void check(const geometry::Periodicity& space, double reach) {
  requireNonNegative(reach, "reach of periodic images");
  for (int k = 0; k < 3; ++k) {
    if (!space.axes[static_cast<std::size_t>(k)]) continue;
    const std::string axis = " along axis " + std::to_string(k);
    if (!(std::isfinite(space.box.lower[k]) && std::isfinite(space.box.upper[k]) && space.length(k) > 0.0))
      throw InputError("the cell is empty or not finite" + axis, "periodic images", "give lower < upper");
    constexpr double most = 32.0;
    if (!(reach <= most * space.length(k)))
      throw InputError("a reach of " + formatNumber(reach) + " m is more than 32 periods" + axis, "periodic images",
                       "give a narrower kernel");
  }
}

/// The images of one point.
void addImages(int item, const Vec3& x, const geometry::Periodicity& space, double reach, PeriodicImages& images) {
  std::array<double, 3> first{}, last{};
  Vec3 period;
  for (int k = 0; k < 3; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    if (!space.axes[axis]) continue;
    period[k] = space.length(k);
    first[axis] = std::ceil((space.box.lower[k] - reach - x[k]) / period[k]);
    last[axis] = std::floor((space.box.upper[k] + reach - x[k]) / period[k]);
  }
  for (double c = first[2]; c <= last[2]; ++c)
    for (double b = first[1]; b <= last[1]; ++b)
      for (double a = first[0]; a <= last[0]; ++a) {
        images.source.push_back(item);
        images.shift.push_back({a * period.x, b * period.y, c * period.z});
      }
}

}  // namespace

PeriodicImages periodicImages(std::span<const Vec3> x, const geometry::Periodicity& space, double reach) {
  check(space, reach);
  PeriodicImages images;
  images.source.reserve(x.size());
  images.shift.reserve(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!isFinite(x[i]))
      throw InputError("not a finite vector", "point " + std::to_string(i), "give three finite numbers");
    addImages(static_cast<int>(i), x[i], space, reach, images);
  }
  return images;
}

}  // namespace dovetail::cg
