#include "dovetail/report/curve_error.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::report {

namespace {

void requireReference(const Curve& r) {
  if (r.x.size() < 2) throw InputError("the reference has fewer than two points", r.name, "give a curve");
  for (std::size_t k = 0; k < r.x.size(); ++k) {
    const std::string row = "in row " + std::to_string(k + 1);
    if (!std::isfinite(r.x[k]) || !std::isfinite(r.y[k]))
      throw InputError("the reference has a value that is not finite " + row, r.name, "remove the row");
    if (k > 0 && !(r.x[k] > r.x[k - 1]))
      throw InputError(
          "the reference goes back from " + formatNumber(r.x[k - 1]) + " to " + formatNumber(r.x[k]) + " " + row,
          r.name, "give a curve along a quantity that increases, such as the time");
  }
}

/// @param x  within the range
double valueAt(const Curve& r, double x) {
  const std::size_t after =
      std::max<std::size_t>(1, static_cast<std::size_t>(std::lower_bound(r.x.begin(), r.x.end(), x) - r.x.begin()));
  const double fraction = (x - r.x[after - 1]) / (r.x[after] - r.x[after - 1]);
  return (1.0 - fraction) * r.y[after - 1] + fraction * r.y[after];
}

}  // namespace

CurveError distanceFrom(const Curve& reference, const Curve& curve, Norm norm) {
  requireReference(reference);
  const double low = reference.x.front(), high = reference.x.back();
  double square = 0.0, length = 0.0, largest = 0.0, last = 0.0, before = 0.0;
  double own = 0.0, level = 0.0, levelBefore = 0.0;  // of the reference: integral of its square, and its values
  double least = high, most = low;
  bool any = false, follows = false;  // whether the point before was compared
  for (std::size_t k = 0; k < curve.x.size(); ++k) {
    const double x = curve.x[k];
    const bool within = x >= low && x <= high && std::isfinite(curve.y[k]);
    if (within) {
      level = valueAt(reference, x);
      last = curve.y[k] - level;
      largest = std::max(largest, std::abs(last));
      least = std::min(least, x);
      most = std::max(most, x);
      if (follows) {
        const double dx = std::abs(x - curve.x[k - 1]);
        square += 0.5 * dx * (last * last + before * before);
        own += 0.5 * dx * (level * level + levelBefore * levelBefore);
        length += dx;
      }
      before = last;
      levelBefore = level;
      any = true;
    }
    follows = within;
  }
  if (!any || ((norm == Norm::mean || norm == Norm::relative) && length == 0.0))
    throw InputError("the run has " + std::string(any ? "one point" : "no point") + " within the reference's range, " +
                         formatNumber(low) + " to " + formatNumber(high),
                     reference.name, "compare curves along the same quantity in the same unit");
  if (norm == Norm::relative && own == 0.0)
    throw InputError("the reference is zero, and nothing can be told relative to it", reference.name,
                     "take another column, or the norm mean");
  const double value = norm == Norm::mean       ? std::sqrt(square / length)
                       : norm == Norm::relative ? std::sqrt(square / own)
                       : norm == Norm::largest  ? largest
                                                : last;
  return {value, (most - least) / (high - low)};
}

Curve meanOf(const std::vector<Curve>& curves) {
  Curve mean;
  if (curves.empty()) throw InputError("there is no curve", "mean of curves", "give one or more");
  for (const Curve& curve : curves) requireReference(curve);
  const auto covers = [](const Curve& curve, double x) { return x >= curve.x.front() && x <= curve.x.back(); };
  for (const double x : curves.front().x) {
    if (!std::ranges::all_of(curves, [&](const Curve& curve) { return covers(curve, x); })) continue;
    double sum = 0.0;
    for (const Curve& curve : curves) sum += valueAt(curve, x);
    mean.x.push_back(x);
    mean.y.push_back(sum / static_cast<double>(curves.size()));
  }
  if (mean.x.size() < 2)
    throw InputError("the curves have no range in common", curves.front().name,
                     "compare curves along the same quantity");
  mean.name = "mean";
  return mean;
}

}  // namespace dovetail::report
