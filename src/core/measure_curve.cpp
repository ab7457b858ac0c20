#include "dovetail/core/measure_curve.hpp"

#include <algorithm>
#include <cstdio>

namespace dovetail {

namespace {

constexpr double nearlyBest = 1.05;

/// Of the parabola through the best sample and the nearest ones to both sides that lie beyond the flat bottom.
double curvatureAt(const MeasureCurve& c, std::size_t least) {
  std::size_t a = least, b = least;
  while (a > 0 && c.measure[a] < nearlyBest * c.measure[least]) --a;
  while (b + 1 < c.at.size() && c.measure[b] < nearlyBest * c.measure[least]) ++b;
  if (a == least || b == least || !(c.measure[least] > 0.0)) return 0.0;
  const double left = (c.measure[least] - c.measure[a]) / (c.at[least] - c.at[a]);
  const double right = (c.measure[b] - c.measure[least]) / (c.at[b] - c.at[least]);
  return 2.0 * (right - left) / (c.at[b] - c.at[a]) * c.best * c.best / c.measure[least];
}

/// How far the measure stays within 5 % of the least, linear between samples.
double reach(const MeasureCurve& c, std::size_t least, int sense) {
  const double limit = nearlyBest * c.measure[least];
  std::size_t k = least;
  while (true) {
    if ((sense < 0 && k == 0) || (sense > 0 && k + 1 == c.at.size())) return c.at[k];
    const std::size_t next = sense < 0 ? k - 1 : k + 1;
    if (c.measure[next] > limit)
      return c.at[k] + (c.at[next] - c.at[k]) * (limit - c.measure[k]) / (c.measure[next] - c.measure[k]);
    k = next;
  }
}

}  // namespace

MeasureCurve curveThrough(const std::map<double, double>& samples, double least, double most) {
  MeasureCurve curve;
  for (const auto& [at, value] : samples) {
    curve.at.push_back(at);
    curve.measure.push_back(value);
  }
  if (samples.empty()) return curve;
  const auto k =
      static_cast<std::size_t>(std::min_element(curve.measure.begin(), curve.measure.end()) - curve.measure.begin());
  curve.best = curve.at[k];
  curve.curvature = curvatureAt(curve, k);
  curve.lower = reach(curve, k, -1);
  curve.upper = reach(curve, k, 1);
  curve.lowerOpen = curve.lower == least;
  curve.upperOpen = curve.upper == most;
  return curve;
}

std::string optimaText(std::span<const std::string> names, std::span<const MeasureCurve> curves) {
  const auto line = [](const char* format, auto... values) {
    char text[400];
    std::snprintf(text, sizeof text, format, values...);
    return std::string(text);
  };
  std::string text = line("%-34s %12s %28s %10s\n", "parameter", "best", "within 5 % of the least", "curvature");
  for (std::size_t k = 0; k < curves.size(); ++k) {
    const MeasureCurve& c = curves[k];
    text += line("%-34s %12.6g %12.6g%s to %10.6g%s %10.3g\n", names[k].c_str(), c.best, c.lower,
                 c.lowerOpen ? " (bound)" : "", c.upper, c.upperOpen ? " (bound)" : "", c.curvature);
  }
  return text;
}

}  // namespace dovetail
