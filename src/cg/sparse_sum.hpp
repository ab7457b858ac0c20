// Sums weights per item over a few items of many; the scratch arrays return to zero between uses.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace dovetail::cg {

class SparseSum {
public:
  explicit SparseSum(std::size_t size = 0) : sum_(size, 0.0), isTouched_(size, 0) {}

  void add(int item, double value) {
    if (!isTouched_[item]) {
      isTouched_[item] = 1;
      touched_.push_back(item);
    }
    sum_[item] += value;
  }
  /// Items added to since the last clear, ascending.
  const std::vector<int>& items() {
    std::sort(touched_.begin(), touched_.end());
    return touched_;
  }
  double operator[](int item) const { return sum_[item]; }
  void clear() {
    for (int item : touched_) {
      sum_[item] = 0.0;
      isTouched_[item] = 0;
    }
    touched_.clear();
  }
  /// Appends items and sums, divided by their total, and clears. Returns false, appending nothing, if the total is
  /// not a number > 0.
  bool appendNormalised(std::vector<int>& item, std::vector<double>& weight) {
    double total = 0.0;
    for (int i : items()) total += sum_[i];
    const bool usable = total > 0.0;
    if (usable)
      for (int i : touched_) {
        item.push_back(i);
        weight.push_back(sum_[i] / total);
      }
    clear();
    return usable;
  }

private:
  std::vector<double> sum_;
  std::vector<char> isTouched_;
  std::vector<int> touched_;
};

}  // namespace dovetail::cg
