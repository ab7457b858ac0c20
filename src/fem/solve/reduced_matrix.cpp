#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/solve/linear_solver.hpp"

namespace dovetail::fem {

namespace {

/// u_dof = Σ factor q_row.
struct Fraction {
  int row;
  double factor;
};

std::vector<std::vector<Fraction>> fractionsOf(const DofMap& dofs) {
  std::vector<std::vector<Fraction>> fractions(dofs.freeRow().size());
  for (std::size_t dof = 0; dof < fractions.size(); ++dof)
    if (dofs.freeRow()[dof] >= 0) fractions[dof] = {{dofs.freeRow()[dof], 1.0}};
  for (const Tie& tie : dofs.ties())
    for (const Tie::Master& master : tie.masters)
      fractions[static_cast<std::size_t>(3 * tie.node + tie.component)].push_back(
          {dofs.freeRow()[static_cast<std::size_t>(3 * master.node + master.component)], master.factor});
  return fractions;
}

/// Calls act(row, column, source, factor) for every contribution to TᵀKT; without ties rows ascend within each column.
template <class Act>
void visitContributions(const linalg::BlockMatrix& K, const std::vector<std::vector<Fraction>>& fractions,
                        bool symmetric, const Act& act) {
  for (std::size_t n = 0; n < K.nodes(); ++n)
    for (std::size_t c = 0; c < 3; ++c)
      for (const Fraction& row : fractions[3 * n + c])
        for (int k = K.offsets()[n]; k < K.offsets()[n + 1]; ++k)
          for (std::size_t d = 0; d < 3; ++d) {
            const auto other = 3 * static_cast<std::size_t>(K.columns()[static_cast<std::size_t>(k)]) + d;
            for (const Fraction& column : fractions[other])
              if (!symmetric || row.row >= column.row)
                act(row.row, static_cast<std::size_t>(column.row),
                    static_cast<std::uint32_t>(9 * static_cast<std::size_t>(k) + 3 * c + d),
                    row.factor * column.factor);
          }
}

struct Entry {
  int row;
  std::uint32_t source;
  double factor;
};

}  // namespace

void ReducedMatrix::analyse(const linalg::BlockMatrix& K, bool symmetric) {
  patternId_ = K.patternId();
  symmetric_ = symmetric;
  const std::vector<std::vector<Fraction>> fractions = fractionsOf(*dofs_);
  std::vector<std::size_t> next(dofs_->size() + 1, 0);
  visitContributions(K, fractions, symmetric,
                     [&](int, std::size_t column, std::uint32_t, double) { ++next[column + 1]; });
  std::partial_sum(next.begin(), next.end(), next.begin());
  if (next.back() > std::numeric_limits<int>::max())
    throw NumericalError("the matrix has " + std::to_string(next.back()) + " entries", "ReducedMatrix",
                         "take a coarser mesh: 2147483647 entries can be numbered");
  matrix_ = {};
  matrix_.size = static_cast<int>(dofs_->size());
  matrix_.offsets.assign(next.begin(), next.end());
  matrix_.row.resize(next.back());
  source_.resize(next.back());
  target_.clear();
  factor_.assign(dofs_->hasTies() ? next.back() : 0, 0.0);
  visitContributions(K, fractions, symmetric, [&](int row, std::size_t column, std::uint32_t source, double factor) {
    const std::size_t place = next[column]++;
    matrix_.row[place] = row;
    source_[place] = source;
    if (!factor_.empty()) factor_[place] = factor;
  });
  if (dofs_->hasTies()) unite();
  matrix_.value.resize(matrix_.row.size());
}

/// Sorts the contributions to each column, and gives those to one row one entry.
void ReducedMatrix::unite() {
  target_.resize(source_.size());
  std::vector<Entry> column;
  std::size_t first = 0, entries = 0;
  for (std::size_t c = 0; c < static_cast<std::size_t>(matrix_.size); ++c) {
    const auto last = static_cast<std::size_t>(matrix_.offsets[c + 1]);
    column.clear();
    for (std::size_t k = first; k < last; ++k) column.push_back({matrix_.row[k], source_[k], factor_[k]});
    std::stable_sort(column.begin(), column.end(), [](const Entry& a, const Entry& b) { return a.row < b.row; });
    int row = -1;
    for (std::size_t k = first; k < last; ++k) {
      const Entry& entry = column[k - first];
      if (entry.row != row) matrix_.row[entries++] = row = entry.row;
      source_[k] = entry.source;
      factor_[k] = entry.factor;
      target_[k] = static_cast<std::uint32_t>(entries - 1);
    }
    matrix_.offsets[c + 1] = static_cast<int>(entries);
    first = last;
  }
  matrix_.row.resize(entries);
}

const linalg::SparseMatrix& ReducedMatrix::update(const linalg::BlockMatrix& K, bool symmetric) {
  if (patternId_ != K.patternId() || symmetric_ != symmetric) analyse(K, symmetric);
  const std::span<const double> values = K.values();
  if (target_.empty()) {
    for (std::size_t k = 0; k < source_.size(); ++k) matrix_.value[k] = values[source_[k]];
    return matrix_;
  }
  std::fill(matrix_.value.begin(), matrix_.value.end(), 0.0);
  for (std::size_t k = 0; k < source_.size(); ++k) matrix_.value[target_[k]] += factor_[k] * values[source_[k]];
  return matrix_;
}

void ReducedMatrix::load(ByteReader& archive, const linalg::BlockMatrix& K) {
  bool symmetric = true;
  std::vector<double> values;
  archive(symmetric, values);
  analyse(K, symmetric);
  if (values.size() != matrix_.value.size() || !std::ranges::all_of(values, [](double v) { return std::isfinite(v); }))
    throw InputError("the matrix of the state is of another solid, or not finite", "ReducedMatrix",
                     "load it into the run that saved it");
  matrix_.value = std::move(values);
}

}  // namespace dovetail::fem
