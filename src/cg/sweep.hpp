// Finds the items near a point: sorted along the axis in which they extend farthest.
#pragma once

#include <algorithm>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "dovetail/core/error.hpp"
#include "dovetail/core/vec3.hpp"

namespace dovetail::cg {

class AxisSweep {
public:
  /// @param x    one position per item, m   @param item  what an item is, for the error
  /// @throws InputError naming the first item whose position is not finite
  AxisSweep(std::span<const Vec3> x, const std::string& item) {
    Vec3 lower, upper;
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (!isFinite(x[i]))
        throw InputError("the position is not finite", item + " " + std::to_string(i), "remove it or mend its state");
      for (int c = 0; c < 3; ++c) {
        lower[c] = i == 0 ? x[i][c] : std::min(lower[c], x[i][c]);
        upper[c] = i == 0 ? x[i][c] : std::max(upper[c], x[i][c]);
      }
    }
    for (int c = 1; c < 3; ++c)
      if (upper[c] - lower[c] > upper[axis_] - lower[axis_]) axis_ = c;
    order_.resize(x.size());
    std::iota(order_.begin(), order_.end(), 0);
    std::stable_sort(order_.begin(), order_.end(), [&](int a, int b) { return x[a][axis_] < x[b][axis_]; });
    for (int i : order_) place_.push_back(x[i][axis_]);
  }

  /// Items whose coordinate along the axis is within reach of the point, always in the same order.
  std::span<const int> near(const Vec3& point, double reach) const {
    const auto first = std::lower_bound(place_.begin(), place_.end(), point[axis_] - reach);
    const auto last = std::upper_bound(first, place_.end(), point[axis_] + reach);
    return {order_.data() + (first - place_.begin()), static_cast<std::size_t>(last - first)};
  }

private:
  int axis_ = 0;
  std::vector<int> order_;
  std::vector<double> place_;
};

}  // namespace dovetail::cg
