// Assembly of 24 × 24 element matrices into a sparse matrix.
#pragma once

#include <array>
#include <span>

#include "dovetail/fem/solve/sparse.hpp"

namespace dovetail::fem {

/// A sparse matrix with a 3 × 3 block for every pair of nodes that share an element. Elements are added in the order
/// of the calls, so sums are reproducible.
class NodePattern {
public:
  NodePattern(std::span<const std::array<int, 8>> elements, std::size_t nodes);
  /// @param matrix  row-major, rows 3a + c
  void add(const std::array<int, 8>& element, const std::array<double, 576>& matrix);
  SparseMatrix take() { return std::move(matrix_); }

private:
  std::vector<int> offsets_, neighbours_;  // per node, ascending, itself included
  SparseMatrix matrix_;
};

}  // namespace dovetail::fem
