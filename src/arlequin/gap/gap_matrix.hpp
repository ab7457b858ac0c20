// Symmetric matrices of gap rows, and their inverse.
#pragma once

#include <span>
#include <vector>

#include "dovetail/arlequin/gap_operator.hpp"
#include "dovetail/linalg/sparse.hpp"

namespace dovetail::arlequin {

/// Lower triangle of Σ P diag(d) Pᵀ over maps P with one row per gap row.
struct WeighedMap {
  const cg::Projection& map;
  const cg::Projection& back;  ///< Pᵀ
  std::span<const double> d;   ///< one per column of P
};
linalg::SparseMatrix gapMatrix(std::span<const WeighedMap> maps);

/// Factors of a symmetric, positive semidefinite matrix, scaled to a unit diagonal.
class GapInverse {
public:
  /// @param A       lower triangle
  /// @param X       of the rows' nodes, m
  /// @param before  of another matrix: its analysis goes on where the pattern is the same
  GapInverse(linalg::SparseMatrix A, std::span<const Vec3> X, GapInverse* before = nullptr);
  /// b ← A⁻¹ b; where rows depend on each other up to round-off, (A + shift diag A)⁻¹ b.
  /// @param columns  of b, one right-hand side after the other
  void solve(std::span<double> b, int columns) const;
  /// 1/√ of the diagonal; 0 for rows that nothing yields to.
  std::span<const double> scale() const { return scale_; }
  static constexpr double shift = 1e-11;

private:
  std::size_t size_;
  std::vector<double> scale_;
  mutable linalg::SparseCholesky factors_;  // their work space changes
};

}  // namespace dovetail::arlequin
