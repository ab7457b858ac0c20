// A model's matrix by rows of all components, as multigrid wants it.
#pragma once

#include <span>
#include <vector>

#include "dovetail/fem/model/constraints.hpp"
#include "dovetail/fem/solve/linear_solver.hpp"
#include "dovetail/linalg/block_matrix.hpp"
#include "dovetail/linalg/multigrid.hpp"

namespace dovetail::fem::detail {

/// TᵀKT with a row for every component of every node; those that are not free have an entry on the diagonal alone, of
/// the size of the others.
class NodeRows {
public:
  explicit NodeRows(const DofMap& dofs) : dofs_(&dofs), tied_(dofs) {}
  /// @param symmetric  of K
  linalg::RowMatrix& update(const linalg::BlockMatrix& K, bool symmetric);
  bool symmetric() const { return symmetric_; }
  void save(ByteWriter& archive) const { archive(symmetric_, rows_.value); }
  /// What save() wrote. @throws InputError if it is not for the pattern of K, or not finite
  void load(ByteReader& archive, const linalg::BlockMatrix& K);
  linalg::RowMatrix& matrix() { return rows_; }
  std::size_t patternId() const { return patternId_; }
  /// Largest entry on the diagonal, N/m.
  double largestDiagonal() const { return largestDiagonal_; }

  /// Free components to all and back.
  std::vector<double> expanded(std::span<const double> q) const;
  void gather(std::span<const double> all, std::span<double> q) const;

private:
  bool isFree(std::size_t row) const { return dofs_->freeRow()[row] >= 0; }
  void analyse(const linalg::BlockMatrix& K);
  void fill(const linalg::BlockMatrix& K);
  void takeTied(const linalg::SparseMatrix& A);
  void setDiagonals();

  const DofMap* dofs_;
  ReducedMatrix tied_;  // of models with ties
  linalg::RowMatrix rows_;
  std::size_t patternId_ = 0;
  double largestDiagonal_ = 0.0;
  bool symmetric_ = true;
};

/// Displacements that strain nothing to first order about the present places: along x, y, z, and about axes through the
/// centre; those that free components can take part in.
/// @param which  nodes that are wanted @return three components of each of them
std::vector<std::vector<double>> rigidModes(const Nodes& nodes, const DofMap& dofs, std::span<const int> which);

}  // namespace dovetail::fem::detail
