// Integration over an interval by points and weights.
#pragma once

#include <cmath>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

namespace dovetail {

/// Points and weights of Gauss–Legendre on [−1, 1]: exact for polynomials up to degree 2n − 1. n ≥ 1.
inline std::vector<std::pair<double, double>> gaussLegendre(int n) {
  std::vector<std::pair<double, double>> rule;
  for (int i = 0; i < n; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5)), slope = 1.0;
    for (int step = 0; step < 20; ++step) {
      double p = 1.0, previous = 0.0;
      for (int k = 0; k < n; ++k) previous = std::exchange(p, ((2 * k + 1) * x * p - k * previous) / (k + 1));
      slope = n * (x * p - previous) / (x * x - 1.0);
      x -= p / slope;
    }
    rule.emplace_back(x, 2.0 / ((1.0 - x * x) * slope * slope));
  }
  return rule;
}

/// Calls visit(z, weight) for the points of an integral from the first to the last of the ascending `events`, between
/// which the integrand is smooth but for square roots that begin or end at an event: z = low + length (1 − cos θ)/2
/// makes those smooth in θ, where the rule is applied.
template <class Visit>
void integrateBetween(std::span<const double> events, std::span<const std::pair<double, double>> rule, Visit&& visit) {
  for (std::size_t e = 1; e < events.size(); ++e) {
    const double low = events[e - 1], length = events[e] - low;
    if (!(length > 0.0)) continue;
    for (const auto& [point, weight] : rule) {
      const double theta = 0.5 * std::numbers::pi * (1.0 + point), half = std::sin(0.5 * theta);
      visit(low + length * half * half, 0.25 * std::numbers::pi * weight * length * std::sin(theta));
    }
  }
}

}  // namespace dovetail
