// Pareto fronts.
#pragma once

#include <cmath>
#include <vector>

namespace dovetail::report {

/// For each row: whether it takes part and no other that does is better in both costs. Rows with a cost that is not a
/// number do not take part.
template <class Rows, class TakesPart, class CostA, class CostB>
std::vector<bool> onFront(const Rows& rows, TakesPart takesPart, CostA a, CostB b) {
  const auto counts = [&](const auto& row) {
    return takesPart(row) && !std::isnan(static_cast<double>(a(row))) && !std::isnan(static_cast<double>(b(row)));
  };
  std::vector<bool> front(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!counts(rows[i])) continue;
    bool beaten = false;
    for (const auto& other : rows) beaten = beaten || (counts(other) && a(other) < a(rows[i]) && b(other) < b(rows[i]));
    front[i] = !beaten;
  }
  return front;
}

}  // namespace dovetail::report
