#include "dovetail/report/scaling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dovetail/core/error.hpp"
#include "dovetail/report/text.hpp"

namespace dovetail::report {

namespace {

/// Beyond the largest size that was run, figures end at this multiple of it.
constexpr double farthest = 4.0;

double exponentBetween(const CostCurve& curve, std::size_t k) {
  return std::log(curve.seconds[k + 1] / curve.seconds[k]) / std::log(curve.size[k + 1] / curve.size[k]);
}

/// Within the points of the curve, and beyond the last one with this exponent.
double costAt(const CostCurve& curve, double size, double exponent) {
  const std::size_t last = curve.size.size() - 1;
  if (size > curve.size[last]) return curve.seconds[last] * std::pow(size / curve.size[last], exponent);
  std::size_t k = 0;
  while (k + 1 < last && size > curve.size[k + 1]) ++k;
  return curve.seconds[k] * std::pow(size / curve.size[k], exponentBetween(curve, k));
}

/// From there on the second costs less: the last size at which the costs are the same. Infinite if there is none.
double crossing(const CostCurve& dear, double dearExponent, const CostCurve& cheap, double cheapExponent) {
  const double last = std::max(dear.size.back(), cheap.size.back());
  const auto lead = [&](double size) {
    return std::log(costAt(dear, size, dearExponent) / costAt(cheap, size, cheapExponent));
  };
  if (lead(last) < 0.0) {
    const double closing = dearExponent - cheapExponent;
    return closing > 0.0 ? last * std::exp(-lead(last) / closing) : std::numeric_limits<double>::infinity();
  }
  std::vector<double> sizes;
  for (const CostCurve* const one : {&dear, &cheap}) sizes.insert(sizes.end(), one->size.begin(), one->size.end());
  std::ranges::sort(sizes);
  const double first = std::max(dear.size.front(), cheap.size.front());
  double after = last;
  for (auto at = sizes.rbegin(); at != sizes.rend() && *at >= first; after = *at++) {
    if (lead(*at) >= 0.0) continue;
    const double part = lead(*at) / (lead(*at) - lead(after));  // linear in the logarithm of the size
    return *at * std::pow(after / *at, part);
  }
  return first;
}

bool costsLessAtFirst(const CostCurve& dear, const CostCurve& cheap) {
  const double first = std::max(dear.size.front(), cheap.size.front());
  return crossing(dear, growthOf(dear).exponent, cheap, growthOf(cheap).exponent) <= first;
}

std::string rangeText(const BreakEven& at) {
  if (!at.range) return "as run";
  const auto number = [](double value) { return std::isfinite(value) ? format("%.3g", value) : std::string("never"); };
  return number((*at.range)[0]) + " to " + number((*at.range)[1]);
}

}  // namespace

Growth growthOf(const CostCurve& curve) {
  const std::size_t count = curve.size.size();
  for (std::size_t k = 0; k < count; ++k)
    if (!(curve.size[k] > 0.0) || !(curve.seconds[k] > 0.0) || (k > 0 && !(curve.size[k] > curve.size[k - 1])))
      throw InputError("sizes and costs of \"" + curve.name + "\" are not all above 0, or sizes do not grow", "", "");
  if (count < 2) throw InputError("\"" + curve.name + "\" has costs of one size alone", "", "run two or more");
  Growth growth{exponentBetween(curve, count - 2), exponentBetween(curve, 0), exponentBetween(curve, 0)};
  for (std::size_t k = 1; k + 1 < count; ++k) {
    growth.least = std::min(growth.least, exponentBetween(curve, k));
    growth.most = std::max(growth.most, exponentBetween(curve, k));
  }
  return growth;
}

std::optional<BreakEven> breakEven(const CostCurve& dear, const CostCurve& cheap) {
  const Growth a = growthOf(dear), b = growthOf(cheap);
  const double size = crossing(dear, a.exponent, cheap, b.exponent);
  if (!std::isfinite(size) || costsLessAtFirst(dear, cheap)) return {};
  if (size <= std::min(dear.size.back(), cheap.size.back())) return BreakEven{size, {}};
  return BreakEven{size, std::array{crossing(dear, a.most, cheap, b.least), crossing(dear, a.least, cheap, b.most)}};
}

Figure scalingFigure(const std::vector<CostCurve>& curves, const std::string& name, const std::string& size,
                     const std::string& cost) {
  Figure figure{name, cost + " over " + size, {size, true}, {cost + " (s)", true}, {}, {}};
  for (const CostCurve& curve : curves) figure.curves.push_back({curve.name, curve.size, curve.seconds, true, true});
  for (std::size_t k = 0; k < curves.size(); ++k) {
    const CostCurve& curve = curves[k];
    if (curve.size.size() < 2) continue;
    const Growth growth = growthOf(curve);
    const double last = curve.size.back(), end = farthest * last;
    const auto at = [&](double exponent) { return costAt(curve, end, exponent); };
    Curve beyond{"", {last, end}, {curve.seconds.back(), at(growth.exponent)}};
    beyond.dashed = true;
    beyond.like = k;
    beyond.ranges = {{curve.seconds.back(), curve.seconds.back()}, {at(growth.least), at(growth.most)}};
    figure.curves.push_back(std::move(beyond));
  }
  return figure;
}

Table breakEvens(const std::vector<CostCurve>& curves, const std::string& size) {
  Table table{{"costs less", "than", "from " + size, "range"}, {}};
  for (const CostCurve& cheap : curves)
    for (const CostCurve& dear : curves)
      if (&cheap != &dear && cheap.size.size() > 1 && dear.size.size() > 1)
        if (const auto at = breakEven(dear, cheap))
          table.rows.push_back({cheap.name, dear.name, format("%.3g", at->size), rangeText(*at)});
  return table;
}

}  // namespace dovetail::report
