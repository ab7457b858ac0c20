#include "gap_matrix.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/linalg/nested_dissection.hpp"

namespace dovetail::arlequin {

namespace {

constexpr std::size_t chunkSize = 64, fewChunks = 16;

struct Column {
  std::vector<int> row;
  std::vector<double> value;
};

constexpr int blockRows = 32;

/// The blocks of rows that each column of a map meets, ascending.
struct MetBlocks {
  std::vector<std::size_t> offsets{0};
  std::vector<int> block;

  explicit MetBlocks(const cg::Projection& back) {
    for (int middle = 0; middle < back.rows(); ++middle) {
      for (const int row : back.rowColumns(middle))
        if (block.size() == offsets.back() || block.back() != row / blockRows) block.push_back(row / blockRows);
      offsets.push_back(block.size());
    }
  }
  std::span<const int> of(int middle) const {
    const std::size_t begin = offsets[static_cast<std::size_t>(middle)];
    return std::span(block).subspan(begin, offsets[static_cast<std::size_t>(middle) + 1] - begin);
  }
};

/// Adds up a column in an array as long as it, of which it only looks at blocks that are met: they are few, and the
/// sums need not ask whether they are the first.
struct ColumnSums {
  std::vector<double> sum;
  std::vector<char> isMet;  // blocks
  std::vector<int> met;

  explicit ColumnSums(std::size_t size)
      : sum((size / blockRows + 1) * blockRows, 0.0), isMet(size / blockRows + 1, 0) {}

  void meet(std::span<const int> blocks) {
    for (const int b : blocks)
      if (!std::exchange(isMet[static_cast<std::size_t>(b)], 1)) met.push_back(b);
  }
  void add(std::span<const int> rows, std::span<const double> weights, double factor) {
    for (std::size_t k = 0; k < rows.size(); ++k) sum[static_cast<std::size_t>(rows[k])] += factor * weights[k];
  }
  /// Clears the sums. @param c  diagonal, part of the column in any case
  Column take(int c) {
    Column column{{c}, {std::exchange(sum[static_cast<std::size_t>(c)], 0.0)}};
    std::ranges::sort(met);
    for (const int b : met) {
      isMet[static_cast<std::size_t>(b)] = 0;
      for (int r = b * blockRows; r < (b + 1) * blockRows; ++r)
        if (const double value = std::exchange(sum[static_cast<std::size_t>(r)], 0.0); r > c && value != 0.0) {
          column.row.push_back(r);
          column.value.push_back(value);
        }
    }
    met.clear();
    return column;
  }
};

/// Rows c and below of column c.
Column columnOf(std::span<const WeighedMap> maps, std::span<const MetBlocks> blocks, int c, ColumnSums& sums) {
  for (std::size_t at = 0; at < maps.size(); ++at) {
    const WeighedMap& m = maps[at];
    for (int k = m.map.offsets[c]; k < m.map.offsets[c + 1]; ++k) {
      const int middle = m.map.column[k];
      const std::span<const int> rows = m.back.rowColumns(middle), met = blocks[at].of(middle);
      const auto first = static_cast<std::size_t>(std::ranges::lower_bound(rows, c) - rows.begin());
      sums.meet(met.subspan(static_cast<std::size_t>(std::ranges::lower_bound(met, c / blockRows) - met.begin())));
      sums.add(rows.subspan(first), m.back.rowWeights(middle).subspan(first),
               m.map.weight[k] * m.d[static_cast<std::size_t>(middle)]);
    }
  }
  return sums.take(c);
}

}  // namespace

linalg::SparseMatrix gapMatrix(std::span<const WeighedMap> maps) {
  const auto size = static_cast<std::size_t>(maps.front().map.rows());
  std::vector<Column> columns(size);
  std::vector<MetBlocks> blocks;
  for (const WeighedMap& m : maps) blocks.emplace_back(m.back);
  parallelFor(size, std::max(chunkSize, size / fewChunks), [&](std::size_t begin, std::size_t end) {
    ColumnSums sums(size);
    for (std::size_t c = begin; c < end; ++c) columns[c] = columnOf(maps, blocks, static_cast<int>(c), sums);
  });
  linalg::SparseMatrix A;
  A.size = static_cast<int>(size);
  for (const Column& column : columns) A.offsets.push_back(A.offsets.back() + static_cast<int>(column.row.size()));
  A.row.resize(static_cast<std::size_t>(A.offsets.back()));
  A.value.resize(A.row.size());
  parallelFor(size, chunkSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      std::ranges::copy(columns[c].row, A.row.begin() + A.offsets[c]);
      std::ranges::copy(columns[c].value, A.value.begin() + A.offsets[c]);
    }
  });
  return A;
}

GapInverse::GapInverse(linalg::SparseMatrix A, std::span<const Vec3> X, GapInverse* before)
    : size_(static_cast<std::size_t>(A.size)), scale_(size_, 0.0) {
  if (before) factors_ = std::move(before->factors_);
  for (std::size_t c = 0; c < size_; ++c)
    if (const double own = A.value[A.offsets[c]]; own > 0.0) scale_[c] = 1.0 / std::sqrt(own);
  for (std::size_t c = 0; c < size_; ++c)
    for (int k = A.offsets[c]; k < A.offsets[c + 1]; ++k) {
      const auto r = static_cast<std::size_t>(A.row[k]);
      A.value[k] = r == c ? 1.0 : A.value[k] * (scale_[c] * scale_[r]);
    }
  const std::vector<int> order = linalg::nestedDissection(A, X);
  // A vector that does not come back tells that rows depend on each other.
  constexpr double accuracy = 1e-6;
  std::mt19937 random(1);
  std::vector<double> probe(size_);
  for (double& value : probe) value = static_cast<double>(random()) / 4294967296.0 - 0.5;
  if (factors_.factor(A, order)) {
    std::vector<double> back = linalg::multiplySymmetric(A, probe);
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
