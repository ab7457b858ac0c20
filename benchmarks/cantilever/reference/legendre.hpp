// Legendre polynomials on [0, 1] with derivatives and integrals, and Gauss' rule.
#pragma once

#include <array>
#include <vector>

namespace dovetail::cantilever {

/// P_k(2ξ − 1) for k < count, with two derivatives and two integrals over ξ (from 0), all by three-term recurrences.
class LegendreFamily {
public:
  explicit LegendreFamily(int count);
  void evaluate(double xi);
  /// The `integrals`-fold integral of P_k at the last ξ; negative: derivative. integrals in −2 … 2, k < count.
  double operator()(int integrals, int k) const { return table_[integrals + 2][k]; }

private:
  int count_;
  std::array<std::vector<double>, 5> table_;  ///< by integrals + 2
};

struct GaussRule {
  std::vector<double> point, weight;  ///< on [0, 1]; weights sum to 1
};
/// Exact for polynomials of degree 2 points − 1.
GaussRule gaussRule(int points);

}  // namespace dovetail::cantilever
