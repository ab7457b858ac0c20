// Cholesky factors by supernodes, solved with on several threads.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "dense_panel.hpp"

namespace dovetail::linalg::detail {

/// Pattern of a lower triangular L by supernodes, columns that share their rows. Supernode s has the columns from
/// firstColumn[s] to firstColumn[s + 1]; its rows, from row[firstRow[s]] on, ascend and begin with those of its
/// columns; values are dense by columns from firstValue[s] on. Supernodes come in postorder of the elimination tree.
struct SupernodalPattern {
  std::span<const std::int64_t> firstColumn, firstRow, firstValue;  ///< supernodes + 1 entries
  std::span<const std::int64_t> row;

  std::size_t supernodes() const { return firstColumn.size() - 1; }
  std::size_t size() const { return column(supernodes()); }
  std::size_t column(std::size_t s) const { return static_cast<std::size_t>(firstColumn[s]); }
  std::size_t columns(std::size_t s) const { return column(s + 1) - column(s); }
  std::span<const std::int64_t> rows(std::size_t s) const {
    return row.subspan(static_cast<std::size_t>(firstRow[s]), static_cast<std::size_t>(firstRow[s + 1] - firstRow[s]));
  }
  /// Below its own columns.
  std::span<const std::int64_t> rowsBelow(std::size_t s) const { return rows(s).subspan(columns(s)); }
  Panel panel(std::size_t s, const double* values) const {
    return {values + firstValue[s], rows(s).size(), rows(s).size(), columns(s)};
  }
};

/// What can be done side by side: subtrees of the elimination tree of about the same work, and in order what is above
/// them, where threads share the loops within a supernode. It follows from the pattern alone, so that digits are the
/// same for any number of threads.
struct SupernodalPlan {
  struct Subtree {
    std::size_t begin, end;  ///< supernodes; the last one is its root
    double work;             ///< entries of L
  };
  std::vector<Subtree> subtrees;    ///< the most work first
  std::vector<std::size_t> above;   ///< supernodes of no subtree, ascending
  std::vector<std::size_t> parent;  ///< of each supernode; their number for roots
};
SupernodalPlan planOf(const SupernodalPattern& pattern);

/// Solves with L Lᵀ.
class SupernodalSolver {
public:
  void prepare(const SupernodalPattern& L, const SupernodalPlan& plan);
  /// Overwrites x by (L Lᵀ)⁻¹ x. @param values  of L @param columns  of x, one right-hand side after the other
  void solve(const SupernodalPattern& L, const SupernodalPlan& plan, const double* values, std::span<double> x,
             int columns);

private:
  template <int count>
  void solveTogether(const SupernodalPattern& L, const SupernodalPlan& plan, const double* values, Vectors<count> x);

  std::vector<std::size_t> outsideFrom_;  // of each subtree: the rows of its root beyond it, in outsideRow_
  std::vector<std::int64_t> outsideRow_;
  std::vector<int> place_;  // of every entry of L.row that lies beyond its subtree, among the subtree's rows outside
  std::vector<double> outside_;
};

}  // namespace dovetail::linalg::detail
