#include "reference/legendre.hpp"

#include <cmath>
#include <numbers>

namespace dovetail::cantilever {

// Two members more than asked for: each integral of P_k needs P_{k+1}.
LegendreFamily::LegendreFamily(int count) : count_(count) {
  for (auto& row : table_) row.assign(count + 3, 0.0);
}

void LegendreFamily::evaluate(double xi) {
  auto& [d2, d1, p, i1, i2] = table_;
  const double x = 2.0 * xi - 1.0;
  p[0] = 1.0;
  p[1] = x;
  d1[1] = 2.0;
  for (int k = 1; k < count_ + 2; ++k) {
    p[k + 1] = ((2 * k + 1) * x * p[k] - k * p[k - 1]) / (k + 1);
    d1[k + 1] = d1[k - 1] + 2.0 * (2 * k + 1) * p[k];
    d2[k + 1] = d2[k - 1] + 2.0 * (2 * k + 1) * d1[k];
  }
  i1[0] = xi;
  for (int k = 1; k < count_ + 2; ++k) i1[k] = (p[k + 1] - p[k - 1]) / (2.0 * (2 * k + 1));
  i2[0] = xi * xi / 2.0;
  for (int k = 1; k < count_ + 1; ++k) i2[k] = (i1[k + 1] - i1[k - 1]) / (2.0 * (2 * k + 1));
}

GaussRule gaussRule(int points) {
  GaussRule rule;
  LegendreFamily family(points + 1);
  for (int i = 0; i < points; ++i) {
    double xi = 0.5 * (1.0 - std::cos(std::numbers::pi * (i + 0.75) / (points + 0.5)));
    for (int iteration = 0; iteration < 20; ++iteration) {
      family.evaluate(xi);
      const double change = family(0, points) / family(-1, points);
      xi -= change;
      if (std::abs(change) < 1e-16) break;
    }
    family.evaluate(xi);
    const double slope = family(-1, points);
    rule.point.push_back(xi);
    rule.weight.push_back(1.0 / (xi * (1.0 - xi) * slope * slope));
  }
  return rule;
}

}  // namespace dovetail::cantilever
