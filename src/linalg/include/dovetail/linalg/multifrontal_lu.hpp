// LU factors of sparse matrices that are sums of small dense ones.
#pragma once

#include <memory>
#include <span>
#include <vector>

namespace dovetail::linalg {

/// L U of a matrix whose pattern is symmetric and whose parts each couple two nodes, front by front: the unknowns of
/// successive nodes are eliminated in one dense matrix, with pivots among these alone, and what is left is added to the
/// front of the next one concerned (Duff & Reid, ACM Trans. Math. Softw. 9, 1983). The order is of approximate minimum
/// degree, of nodes; node `last` comes at the end. Below some 1500 unknowns faster than SparseLu, which must find rows
/// that go together, with or without SuiteSparse.
class MultifrontalLu {
public:
  /// @param first  unknowns of node k are first[k] … first[k + 1] − 1
  /// @param last   node that is eliminated last, −1: any
  explicit MultifrontalLu(std::vector<int> first, int last = -1);
  ~MultifrontalLu();
  MultifrontalLu(MultifrontalLu&&) noexcept;
  MultifrontalLu& operator=(MultifrontalLu&&) noexcept;

  /// Adds a dense matrix, by columns, on the unknowns of nodes a and b, which may be the same; b = −1: of a alone.
  void add(int a, int b, std::span<const double> part);
  /// @return false if a pivot is zero (then solve() must not be called)
  bool factor();
  /// Overwrites b by A⁻¹ b, refined until the residual is round-off. @param columns  of b, one right-hand side after
  /// the other
  /// @return false if it does not get there: A is all but singular
  bool solve(std::span<double> b, int columns = 1) const;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dovetail::linalg
