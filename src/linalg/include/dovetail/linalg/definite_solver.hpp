// Symmetric positive definite systems, by factorisation or by iteration.
#pragma once

#include <memory>
#include <span>

#include "dovetail/linalg/sparse.hpp"

namespace dovetail::linalg {

enum class LinearMethod {
  /// Direct as long as the factors are no larger than LinearOptions::largestFactors, else multigrid where the build has
  /// it and the caller knows rigid motions (fem::LinearSolver), else conjugate gradients.
  automatic,
  /// Cholesky (CHOLMOD if it was built in); LU (UMFPACK) if the matrix is indefinite or not symmetric.
  direct,
  /// Conjugate gradients preconditioned by an incomplete Cholesky factorisation: memory grows with the mesh and not
  /// faster. For symmetric positive definite matrices only.
  conjugateGradients,
  /// linalg::Multigrid: for matrices of solids, symmetric positive definite or not symmetric.
  multigrid
};

struct LinearOptions {
  LinearMethod method = LinearMethod::automatic;
  double largestFactors = 2147483648.0;  ///< bytes; of Cholesky factors that are made without being asked for
  double relativeTolerance = 1e-8;       ///< of iterations, on the residual
  int maxIterations = 5000;              ///< of a solve
};

/// What a linear method is going to take, by the pattern of the matrix alone.
struct LinearForecast {
  LinearMethod method = LinearMethod::direct;  ///< never automatic
  double bytes = 0.0;       ///< at the most at once, beside the matrix itself; of iterations to some ten per cent
  double operations = 0.0;  ///< additions and multiplications of a factorisation, or of a hundred iterations
  double factors = 0.0;     ///< bytes of Cholesky factors; 0 where iterations were asked for
};

/// Keeps the pattern, the symbolic analysis and the factors over calls. Results do not depend on the number of threads.
class DefiniteSolver {
public:
  /// @throws InputError for tolerances or counts that are not positive
  explicit DefiniteSolver(const LinearOptions& options = {});
  ~DefiniteSolver();
  DefiniteSolver(DefiniteSolver&&) noexcept;

  /// @param lower  its lower triangle; of the values nothing is read
  LinearForecast analyse(const SparseMatrix& lower);
  /// @return false if the matrix is not positive definite (then solve() must not be called; iterations find that out
  /// there)
  /// @throws FactorMemoryError
  bool factor(const SparseMatrix& lower);
  /// Overwrites b by A⁻¹ b. @param columns  of b, one right-hand side after the other
  /// @throws NumericalError if conjugate gradients do not converge
  void solve(std::span<double> b, int columns = 1);
  /// Whether the last matrix is solved by iteration.
  bool iterates() const;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dovetail::linalg
