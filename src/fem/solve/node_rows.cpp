#include "node_rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dovetail/core/error.hpp"

namespace dovetail::fem::detail {

namespace {

void requireNumbers(std::size_t entries) {
  if (entries > std::numeric_limits<int>::max())
    throw NumericalError("the matrix has " + std::to_string(entries) + " entries", "NodeRows",
                         "take a coarser mesh: 2147483647 entries can be numbered");
}

}  // namespace

linalg::RowMatrix& NodeRows::update(const linalg::BlockMatrix& K, bool symmetric) {
  symmetric_ = symmetric;
  if (dofs_->hasTies()) {
    takeTied(tied_.update(K, false));
  } else {
    if (patternId_ != K.patternId()) analyse(K);
    fill(K);
  }
  patternId_ = K.patternId();
  setDiagonals();
  return rows_;
}

void NodeRows::analyse(const linalg::BlockMatrix& K) {
  rows_ = {};
  const std::size_t size = 3 * K.nodes();
  rows_.size = static_cast<int>(size);
  std::size_t entries = 0;
  const auto visit = [&](const auto& act) {
    for (std::size_t row = 0; row < size; ++row) {
      if (!isFree(row)) {
        act(row, row);
        continue;
      }
      for (int k = K.offsets()[row / 3]; k < K.offsets()[row / 3 + 1]; ++k)
        for (std::size_t d = 0; d < 3; ++d) {
          const std::size_t column = 3 * static_cast<std::size_t>(K.columns()[static_cast<std::size_t>(k)]) + d;
          if (isFree(column)) act(row, column);
        }
    }
  };
  visit([&](std::size_t, std::size_t) { ++entries; });
  requireNumbers(entries);
  rows_.offsets.assign(size + 1, 0);
  rows_.column.reserve(entries);
  visit([&](std::size_t row, std::size_t column) {
    rows_.column.push_back(static_cast<int>(column));
    rows_.offsets[row + 1] = static_cast<int>(rows_.column.size());
  });
  rows_.value.resize(entries);
}

void NodeRows::fill(const linalg::BlockMatrix& K) {
  const double* const values = K.values().data();
  auto to = rows_.value.begin();
  for (std::size_t row = 0; row < static_cast<std::size_t>(rows_.size); ++row) {
    if (!isFree(row)) {
      *to++ = 0.0;
      continue;
    }
    for (int k = K.offsets()[row / 3]; k < K.offsets()[row / 3 + 1]; ++k)
      for (std::size_t d = 0; d < 3; ++d)
        if (isFree(3 * static_cast<std::size_t>(K.columns()[static_cast<std::size_t>(k)]) + d))
          *to++ = values[9 * static_cast<std::size_t>(k) + 3 * (row % 3) + d];
  }
}

/// Columns of free components to rows of all.
void NodeRows::takeTied(const linalg::SparseMatrix& A) {
  const std::size_t size = dofs_->freeRow().size();
  requireNumbers(A.row.size() + size);
  rows_.size = static_cast<int>(size);
  rows_.offsets.assign(size + 1, 0);
  const auto all = [&](int free) {
    return static_cast<std::size_t>(dofs_->freeDofs()[static_cast<std::size_t>(free)]);
  };
  for (const int row : A.row) ++rows_.offsets[all(row) + 1];
  for (std::size_t row = 0; row < size; ++row) rows_.offsets[row + 1] += rows_.offsets[row] + (isFree(row) ? 0 : 1);
  rows_.column.resize(static_cast<std::size_t>(rows_.offsets.back()));
  rows_.value.resize(rows_.column.size());
  std::vector<int> next(rows_.offsets.begin(), rows_.offsets.end() - 1);
  const auto put = [&](std::size_t row, std::size_t column, double value) {
    const auto place = static_cast<std::size_t>(next[row]++);
    rows_.column[place] = static_cast<int>(column);
    rows_.value[place] = value;
  };
  for (int column = 0; column < A.size; ++column)
    for (int k = A.offsets[static_cast<std::size_t>(column)]; k < A.offsets[static_cast<std::size_t>(column) + 1]; ++k)
      put(all(A.row[static_cast<std::size_t>(k)]), all(column), A.value[static_cast<std::size_t>(k)]);
  for (std::size_t row = 0; row < size; ++row)
    if (!isFree(row)) put(row, row, 0.0);
}

/// Of components that are not free: as large as the others, so that the levels take them for well-behaved.
void NodeRows::setDiagonals() {
  double sum = 0.0;
  std::size_t count = 0;
  largestDiagonal_ = 0.0;
  const auto diagonal = [&](std::size_t row) -> double& {
    const auto first = rows_.column.begin() + rows_.offsets[row], last = rows_.column.begin() + rows_.offsets[row + 1];
    return rows_
        .value[static_cast<std::size_t>(std::lower_bound(first, last, static_cast<int>(row)) - rows_.column.begin())];
  };
  for (std::size_t row = 0; row < static_cast<std::size_t>(rows_.size); ++row)
    if (isFree(row)) {
      const double value = std::abs(diagonal(row));
      sum += value, ++count, largestDiagonal_ = std::max(largestDiagonal_, value);
    }
  for (std::size_t row = 0; row < static_cast<std::size_t>(rows_.size); ++row)
    if (!isFree(row)) diagonal(row) = count > 0 ? sum / static_cast<double>(count) : 1.0;
}

std::vector<double> NodeRows::expanded(std::span<const double> q) const {
  std::vector<double> all(dofs_->freeRow().size(), 0.0);
  for (std::size_t i = 0; i < q.size(); ++i) all[static_cast<std::size_t>(dofs_->freeDofs()[i])] = q[i];
  return all;
}

void NodeRows::gather(std::span<const double> all, std::span<double> q) const {
  for (std::size_t i = 0; i < q.size(); ++i) q[i] = all[static_cast<std::size_t>(dofs_->freeDofs()[i])];
}

void NodeRows::load(ByteReader& archive, const linalg::BlockMatrix& K) {
  update(K, true);
  std::vector<double> values;
  archive(symmetric_, values);
  if (values.size() != rows_.value.size() || !std::ranges::all_of(values, [](double v) { return std::isfinite(v); }))
    throw InputError("the matrix of the state is of another solid, or not finite", "NodeRows",
                     "load it into the run that saved it");
  rows_.value = std::move(values);
}

std::vector<std::vector<double>> rigidModes(const Nodes& nodes, const DofMap& dofs, std::span<const int> which) {
  constexpr double noPart = 1e-20;
  Vec3 centre;
  for (std::size_t n = 0; n < nodes.X.size(); ++n) centre += nodes.X[n] + nodes.u[n];
  centre *= 1.0 / static_cast<double>(nodes.X.size());
  std::vector<std::vector<double>> modes;
  for (int axis = 0; axis < 6; ++axis) {
    Vec3 along, about;
    (axis < 3 ? along : about)[axis % 3] = 1.0;
    const auto motionOf = [&](std::size_t n) { return along + cross(about, nodes.X[n] + nodes.u[n] - centre); };
    double all = 0.0, free = 0.0;
    for (std::size_t n = 0; n < nodes.X.size(); ++n)
      for (int c = 0; c < 3; ++c) {
        const double square = motionOf(n)[c] * motionOf(n)[c];
        all += square;
        if (dofs.freeRow()[3 * n + static_cast<std::size_t>(c)] >= 0) free += square;
      }
    if (!(free > noPart * all)) continue;
    std::vector<double>& mode = modes.emplace_back();
    mode.reserve(3 * which.size());
    for (const int n : which)
      for (int c = 0; c < 3; ++c) mode.push_back(motionOf(static_cast<std::size_t>(n))[c]);
  }
  return modes;
}

}  // namespace dovetail::fem::detail
