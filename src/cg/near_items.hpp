// Finds the items near a point, periodic images included.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "dovetail/cg/images.hpp"
#include "dovetail/cg/kernel.hpp"
#include "dovetail/geometry/hierarchical_grid.hpp"

namespace dovetail::cg {

/// Items of some extent about their centres, for the kernel's reach around points.
class NearItems {
public:
  /// @param centre finite places, m   @param extent m, ≥ 0, how far an item goes from its centre; empty: points
  NearItems(const Kernel& kernel, std::span<const Vec3> centre, std::span<const double> extent,
            const geometry::Periodicity& space)
      : space_(space) {
    if (centre.empty()) return;
    const double farthest = extent.empty() ? 0.0 : *std::max_element(extent.begin(), extent.end());
    images_ = periodicImages(centre, space, kernel.width + farthest);
    // Cells as small as a part of the width follow its sphere more closely than cells of the width.
    const double part = 0.25 * kernel.width;
    around_ = kernel.width - part;
    std::vector<double> radius(images_.size(), part);
    for (std::size_t m = 0; m < radius.size() && !extent.empty(); ++m)
      radius[m] += extent[static_cast<std::size_t>(images_.source[m])];
    grid_.build(images_.moved(centre), radius);
  }

  /// Calls use(item, place) for every image of an item that may be within the kernel's width of the point, in an order
  /// that depends on the items alone; `place` is where the point is, seen from the item itself.
  template <class Use>
  void forEach(const Vec3& point, Use&& use) const {
    if (grid_.size() == 0) return;
    const Vec3 inside = wrapped(point), reach{around_, around_, around_};
    grid_.query({inside - reach, inside + reach}, [&](int m) {
      const auto image = static_cast<std::size_t>(m);
      use(static_cast<std::size_t>(images_.source[image]), inside - images_.shift[image]);
    });
  }

private:
  Vec3 wrapped(Vec3 x) const {
    for (int k = 0; k < 3; ++k)
      if (space_.axes[static_cast<std::size_t>(k)])
        x[k] -= space_.length(k) * std::floor((x[k] - space_.box.lower[k]) / space_.length(k));
    return x;
  }

  geometry::Periodicity space_;
  PeriodicImages images_;
  geometry::HierarchicalGrid grid_;
  double around_ = 0.0;
};

}  // namespace dovetail::cg
