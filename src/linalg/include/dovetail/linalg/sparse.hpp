// Square sparse matrices by columns, and their factorisation.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "dovetail/core/error.hpp"

namespace dovetail::linalg {

/// Compressed columns; rows ascend within a column. For nodes, component c of node n is row 3n + c.
struct SparseMatrix {
  int size = 0;
  std::vector<int> offsets{0};  ///< size + 1 entries
  std::vector<int> row;
  std::vector<double> value;
};

/// The factors of a matrix do not fit into the memory, or into numbers of 64 bits.
class FactorMemoryError : public NumericalError {
  using NumericalError::NumericalError;
};

/// y = A x.
std::vector<double> multiply(const SparseMatrix& A, std::span<const double> x);
/// The same for a symmetric matrix of which A is the lower triangle.
std::vector<double> multiplySymmetric(const SparseMatrix& A, std::span<const double> x);

/// What a factorisation is going to take, by the pattern of the matrix alone.
struct FactorCost {
  double bytes = 0.0;       ///< at the most at once, beside the matrix itself
  double operations = 0.0;  ///< additions and multiplications
};

/// Owns the factorisation of a symmetric positive definite matrix (CHOLMOD if it was built in, else Eigen's LDLᵀ).
/// Results do not depend on the number of threads: the BLAS is held to one while it works.
class SparseCholesky {
public:
  SparseCholesky();
  ~SparseCholesky();
  SparseCholesky(SparseCholesky&&) noexcept;
  SparseCholesky& operator=(SparseCholesky&&) noexcept;

  /// The symbolic analysis, which is reused while the pattern and the order stay.
  /// @param A  the lower triangle; of the values nothing is read
  /// @param order  in which CHOLMOD eliminates the unknowns; empty: in one of its own
  FactorCost analyse(const SparseMatrix& A, std::span<const int> order = {});
  /// Reads the lower triangle only.
  /// @return false if the matrix is not positive definite (then solve() must not be called)
  /// @throws FactorMemoryError
  bool factor(const SparseMatrix& A, std::span<const int> order = {});
  /// Overwrites b by A⁻¹ b. @param columns  of b, one right-hand side after the other
  void solve(std::span<double> b, int columns = 1);
  /// "CHOLMOD" or "Eigen LDLT".
  static const char* name();

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Owns the factorisation of a matrix that is not symmetric, or symmetric and indefinite (UMFPACK if it was built in,
/// else Eigen's LU and LDLᵀ). Results do not depend on the number of threads.
class SparseLu {
public:
  SparseLu();
  ~SparseLu();
  SparseLu(SparseLu&&) noexcept;
  SparseLu& operator=(SparseLu&&) noexcept;

  /// The symbolic analysis is reused while the pattern stays.
  /// @param symmetric  A holds the lower triangle alone. Pivots then stay on the diagonal unless they all but vanish.
  /// @return false if the matrix is singular (then solve() must not be called)
  /// @throws FactorMemoryError
  bool factor(const SparseMatrix& A, bool symmetric);
  /// Overwrites b by A⁻¹ b.
  void solve(std::span<double> b);
  /// Number of negative eigenvalues of a symmetric matrix, by the law of inertia; −1 if not known.
  int negativePivots() const;
  /// "UMFPACK" or "Eigen LU".
  static const char* name();

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dovetail::linalg
