#include "dovetail/fem/solve/sparse.hpp"

namespace dovetail::fem {

std::vector<double> multiply(const SparseMatrix& A, std::span<const double> x) {
  std::vector<double> y(static_cast<std::size_t>(A.size), 0.0);
  for (std::size_t column = 0; column < y.size(); ++column)
    for (int k = A.offsets[column]; k < A.offsets[column + 1]; ++k) y[A.row[k]] += A.value[k] * x[column];
  return y;
}

}  // namespace dovetail::fem
