#include "dovetail/fem/solve/sparse.hpp"

#include <algorithm>

#include "../elements/node_pattern.hpp"

namespace dovetail::fem {

std::vector<double> multiply(const SparseMatrix& A, std::span<const double> x) {
  std::vector<double> y(static_cast<std::size_t>(A.size), 0.0);
  for (std::size_t column = 0; column < y.size(); ++column)
    for (int k = A.offsets[column]; k < A.offsets[column + 1]; ++k) y[A.row[k]] += A.value[k] * x[column];
  return y;
}

NodePattern::NodePattern(std::span<const std::array<int, 8>> elements, std::size_t nodes) {
  std::vector<std::vector<int>> neighbours(nodes);
  for (const auto& element : elements)
    for (const int a : element) {
      std::vector<int>& list = neighbours[static_cast<std::size_t>(a)];
      list.insert(list.end(), element.begin(), element.end());
    }
  offsets_.assign(nodes + 1, 0);
  matrix_.size = static_cast<int>(3 * nodes);
  for (std::size_t n = 0; n < nodes; ++n) {
    std::vector<int>& list = neighbours[n];
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    neighbours_.insert(neighbours_.end(), list.begin(), list.end());
    offsets_[n + 1] = static_cast<int>(neighbours_.size());
    for (int c = 0; c < 3; ++c) {
      for (const int node : list) matrix_.row.insert(matrix_.row.end(), {3 * node, 3 * node + 1, 3 * node + 2});
      matrix_.offsets.push_back(static_cast<int>(matrix_.row.size()));
    }
  }
  matrix_.value.assign(matrix_.row.size(), 0.0);
}

void NodePattern::add(const std::array<int, 8>& element, const std::array<double, 576>& matrix) {
  for (std::size_t b = 0; b < 8; ++b) {
    const auto column = static_cast<std::size_t>(element[b]);
    const auto first = neighbours_.begin() + offsets_[column], last = neighbours_.begin() + offsets_[column + 1];
    for (std::size_t a = 0; a < 8; ++a) {
      const auto place = static_cast<std::size_t>(std::lower_bound(first, last, element[a]) - first);
      for (std::size_t d = 0; d < 3; ++d) {
        double* target = &matrix_.value[static_cast<std::size_t>(matrix_.offsets[3 * column + d]) + 3 * place];
        for (std::size_t c = 0; c < 3; ++c) target[c] += matrix[24 * (3 * a + c) + 3 * b + d];
      }
    }
  }
}

}  // namespace dovetail::fem
