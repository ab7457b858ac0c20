#include "gap_matrix.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/fem/solve/nested_dissection.hpp"

namespace dovetail::arlequin {

namespace {

constexpr std::size_t grain = 64, fewChunks = 16;

struct Column {
  std::vector<int> row;
  std::vector<double> value;
};

/// Rows c and below of column c.
Column columnOf(std::span<const WeighedMap> maps, int c, std::vector<double>& sum, std::vector<char>& seen) {
  Column column;
  for (const WeighedMap& m : maps)
    for (int k = m.map.offsets[c]; k < m.map.offsets[c + 1]; ++k) {
      const int middle = m.map.column[k];
      const double factor = m.map.weight[k] * m.d[static_cast<std::size_t>(middle)];
      const std::span<const int> rows = m.back.rowColumns(middle);
      const std::span<const double> weights = m.back.rowWeights(middle);
      const auto first = std::ranges::lower_bound(rows, c) - rows.begin();
      for (auto j = static_cast<std::size_t>(first); j < rows.size(); ++j) {
        const auto r = static_cast<std::size_t>(rows[j]);
        if (!seen[r]) {
          seen[r] = 1;
          column.row.push_back(rows[j]);
        }
        sum[r] += factor * weights[j];
      }
    }
  if (!seen[static_cast<std::size_t>(c)]) column.row.push_back(c);
  std::ranges::sort(column.row);
  for (const int r : column.row) {
    const auto at = static_cast<std::size_t>(r);
    column.value.push_back(sum[at]);
    sum[at] = 0.0;
    seen[at] = 0;
  }
  return column;
}

std::vector<double> multiplySymmetric(const fem::SparseMatrix& A, std::span<const double> x) {
  std::vector<double> y(x.size(), 0.0);
  for (std::size_t c = 0; c < x.size(); ++c)
    for (int k = A.offsets[c]; k < A.offsets[c + 1]; ++k) {
      const auto r = static_cast<std::size_t>(A.row[k]);
      y[r] += A.value[k] * x[c];
      if (r != c) y[c] += A.value[k] * x[r];
    }
  return y;
}

}  // namespace

fem::SparseMatrix gapMatrix(std::span<const WeighedMap> maps) {
  const auto size = static_cast<std::size_t>(maps.front().map.rows());
  std::vector<Column> columns(size);
  parallelFor(size, std::max(grain, size / fewChunks), [&](std::size_t begin, std::size_t end) {
    std::vector<double> sum(size, 0.0);
    std::vector<char> seen(size, 0);
    for (std::size_t c = begin; c < end; ++c) columns[c] = columnOf(maps, static_cast<int>(c), sum, seen);
  });
  fem::SparseMatrix A;
  A.size = static_cast<int>(size);
  for (const Column& column : columns) A.offsets.push_back(A.offsets.back() + static_cast<int>(column.row.size()));
  A.row.resize(static_cast<std::size_t>(A.offsets.back()));
  A.value.resize(A.row.size());
  parallelFor(size, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      std::ranges::copy(columns[c].row, A.row.begin() + A.offsets[c]);
      std::ranges::copy(columns[c].value, A.value.begin() + A.offsets[c]);
    }
  });
  return A;
}

GapInverse::GapInverse(fem::SparseMatrix A, std::span<const Vec3> X, GapInverse* before)
    : size_(static_cast<std::size_t>(A.size)), scale_(size_, 0.0) {
  if (before) factors_ = std::move(before->factors_);
  for (std::size_t c = 0; c < size_; ++c)
    if (const double own = A.value[A.offsets[c]]; own > 0.0) scale_[c] = 1.0 / std::sqrt(own);
  for (std::size_t c = 0; c < size_; ++c)
    for (int k = A.offsets[c]; k < A.offsets[c + 1]; ++k) {
      const auto r = static_cast<std::size_t>(A.row[k]);
      A.value[k] = r == c ? 1.0 : A.value[k] * (scale_[c] * scale_[r]);
    }
  const std::vector<int> order = fem::nestedDissection(A, X);
  // A vector that does not come back tells that rows depend on each other.
  constexpr double accuracy = 1e-6;
  std::mt19937 random(1);
  std::vector<double> probe(size_);
  for (double& value : probe) value = static_cast<double>(random()) / 4294967296.0 - 0.5;
  if (factors_.factor(A, order)) {
    std::vector<double> back = multiplySymmetric(A, probe);
    factors_.solve(back, 1);
    double error = 0.0;
    for (std::size_t c = 0; c < size_; ++c) error = std::max(error, std::abs(back[c] - probe[c]));
    if (error <= accuracy) return;
  }
  for (std::size_t c = 0; c < size_; ++c) A.value[A.offsets[c]] += shift;
  if (!factors_.factor(A, order))
    throw NumericalError("the matrix of the gap's rows is not positive definite", "overlap",
                         "take a narrower kernel, or more particles per element");
}

void GapInverse::solve(std::span<double> b, int columns) const {
  for (std::size_t k = 0; k < b.size(); ++k) b[k] *= scale_[k % size_];
  factors_.solve(b, columns);
  for (std::size_t k = 0; k < b.size(); ++k) b[k] *= scale_[k % size_];
}

}  // namespace dovetail::arlequin
