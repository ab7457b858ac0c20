#include <algorithm>

#include "dovetail/fem/solve/linear_solver.hpp"

namespace dovetail::fem {

namespace {

/// u_dof = Σ factor q_row.
struct Share {
  int row;
  double factor;
};

std::vector<std::vector<Share>> sharesOf(const DofMap& dofs) {
  std::vector<std::vector<Share>> shares(dofs.freeRow().size());
  for (std::size_t dof = 0; dof < shares.size(); ++dof)
    if (dofs.freeRow()[dof] >= 0) shares[dof] = {{dofs.freeRow()[dof], 1.0}};
  for (const Tie& tie : dofs.ties())
    for (const Tie::Master& master : tie.masters)
      shares[static_cast<std::size_t>(3 * tie.node + tie.component)].push_back(
          {dofs.freeRow()[static_cast<std::size_t>(3 * master.node + master.component)], master.factor});
  return shares;
}

struct Entry {
  int column, row;
  std::uint32_t source;
  double factor;
};

}  // namespace

void ReducedMatrix::analyse(const BlockMatrix& K, bool symmetric) {
  patternId_ = K.patternId();
  symmetric_ = symmetric;
  const std::vector<std::vector<Share>> shares = sharesOf(*dofs_);
  std::vector<std::vector<Entry>> columns(dofs_->size());
  for (std::size_t n = 0; n < K.nodes(); ++n)
    for (int k = K.offsets()[n]; k < K.offsets()[n + 1]; ++k)
      for (int entry = 0; entry < 9; ++entry) {
        const std::size_t dof = 3 * n + static_cast<std::size_t>(entry / 3);
        const std::size_t other = static_cast<std::size_t>(3 * K.columns()[static_cast<std::size_t>(k)] + entry % 3);
        for (const Share& row : shares[dof])
          for (const Share& column : shares[other])
            if (!symmetric || row.row >= column.row)
              columns[static_cast<std::size_t>(column.row)].push_back(
                  {column.row, row.row, static_cast<std::uint32_t>(9 * k + entry), row.factor * column.factor});
      }
  matrix_ = {};
  matrix_.size = static_cast<int>(dofs_->size());
  source_.clear();
  target_.clear();
  factor_.clear();
  for (std::vector<Entry>& column : columns) {
    std::stable_sort(column.begin(), column.end(), [](const Entry& a, const Entry& b) { return a.row < b.row; });
    int last = -1;
    for (const Entry& entry : column) {
      if (entry.row != last) matrix_.row.push_back(last = entry.row);
      source_.push_back(entry.source);
      target_.push_back(static_cast<std::uint32_t>(matrix_.row.size() - 1));
      if (dofs_->hasTies()) factor_.push_back(entry.factor);
    }
    matrix_.offsets.push_back(static_cast<int>(matrix_.row.size()));
    std::vector<Entry>().swap(column);
  }
  matrix_.value.resize(matrix_.row.size());
}

const SparseMatrix& ReducedMatrix::update(const BlockMatrix& K, bool symmetric) {
  if (patternId_ != K.patternId() || symmetric_ != symmetric) analyse(K, symmetric);
  const std::span<const double> values = K.values();
  if (factor_.empty()) {  // then every target has one source
    for (std::size_t k = 0; k < source_.size(); ++k) matrix_.value[target_[k]] = values[source_[k]];
    return matrix_;
  }
  std::fill(matrix_.value.begin(), matrix_.value.end(), 0.0);
  for (std::size_t k = 0; k < source_.size(); ++k) matrix_.value[target_[k]] += factor_[k] * values[source_[k]];
  return matrix_;
}

}  // namespace dovetail::fem
