#include "dovetail/linalg/sparse.hpp"

namespace dovetail::linalg {

std::vector<double> multiply(const SparseMatrix& A, std::span<const double> x) {
  std::vector<double> y(static_cast<std::size_t>(A.size), 0.0);
  for (std::size_t column = 0; column < y.size(); ++column)
    for (int k = A.offsets[column]; k < A.offsets[column + 1]; ++k) y[A.row[k]] += A.value[k] * x[column];
  return y;
}

std::vector<double> multiplySymmetric(const SparseMatrix& A, std::span<const double> x) {
  std::vector<double> y(x.size(), 0.0);
  for (std::size_t c = 0; c < x.size(); ++c)
    for (int k = A.offsets[c]; k < A.offsets[c + 1]; ++k) {
      const auto r = static_cast<std::size_t>(A.row[k]);
      y[r] += A.value[k] * x[c];
      if (r != c) y[c] += A.value[k] * x[r];
    }
  return y;
}

}  // namespace dovetail::linalg
