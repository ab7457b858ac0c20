// Linear systems of a model: T ᵀK T x = r for the free components, by factorisation or by iteration.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dovetail/core/archive.hpp"
#include "dovetail/fem/model/constraints.hpp"
#include "dovetail/linalg/block_matrix.hpp"
#include "dovetail/linalg/definite_solver.hpp"
#include "dovetail/linalg/sparse.hpp"

namespace dovetail::fem {

namespace detail {
class NodeRows;
}

/// TᵀKT for the free components: the lower triangle by columns if symmetric, else all of it.
class ReducedMatrix {
public:
  explicit ReducedMatrix(const DofMap& dofs) : dofs_(&dofs) {}
  /// Entries are added in a fixed order.
  const linalg::SparseMatrix& update(const linalg::BlockMatrix& K, bool symmetric);
  const linalg::SparseMatrix& matrix() const { return matrix_; }
  const DofMap& dofs() const { return *dofs_; }
  bool symmetric() const { return symmetric_; }
  void save(ByteWriter& archive) const { archive(symmetric_, matrix_.value); }
  /// What save() wrote. @throws InputError if it is not for the pattern of K, or not finite
  void load(ByteReader& archive, const linalg::BlockMatrix& K);

private:
  void analyse(const linalg::BlockMatrix& K, bool symmetric);
  void unite();
  const DofMap* dofs_;
  linalg::SparseMatrix matrix_;
  std::size_t patternId_ = 0;
  bool symmetric_ = true;
  std::vector<std::uint32_t> source_;  // entries of K in the order of the entries of matrix_
  std::vector<std::uint32_t> target_;  // where they go, and
  std::vector<double> factor_;         // times what; both empty if each goes to the entry of its own number
};

/// Keeps the pattern, the symbolic analysis and the factors over calls. Results do not depend on the number of threads.
class LinearSolver {
public:
  /// @param nodes  of the model, whose rigid motions multigrid needs; null: never multigrid. They and dofs must live as
  ///               long as the solver
  /// @throws InputError for multigrid in a build without, and for tolerances or counts that are not positive
  explicit LinearSolver(const DofMap& dofs, const linalg::LinearOptions& options = {}, const Nodes* nodes = nullptr);
  ~LinearSolver();
  LinearSolver(LinearSolver&&) noexcept;

  /// What factor() and solve() are going to take; of the values nothing is read.
  linalg::LinearForecast forecast(const linalg::BlockMatrix& K, bool symmetric);
  /// Reduces K to the free components and factorises it.
  /// @return false if it is singular (then solve() must not be called)
  /// @throws linalg::FactorMemoryError
  bool factor(const linalg::BlockMatrix& K, bool symmetric);
  /// x = (TᵀKT)⁻¹ r; the spans may be the same.
  /// @param loosest  relative residual that is enough for multigrid, if above LinearOptions::relativeTolerance
  /// @throws NumericalError if iterations do not converge
  void solve(std::span<const double> r, std::span<double> x, double loosest = 0.0);

  bool factored() const;
  /// Whether symmetric matrices are solved by iteration.
  bool iterates() const;
  /// Whether all matrices are.
  bool hasMultigrid() const;
  void drop();

  /// What the factors are made of: made anew from it they have the same digits.
  struct Factored {
    int kind = 0;  ///< 0: none
    bool wasIndefinite = false;
    ReducedMatrix matrix;
    std::shared_ptr<detail::NodeRows> rows;  ///< of multigrid, whose levels are made anew: digits to its tolerance
  };
  void save(ByteWriter& archive) const;
  /// What save() wrote, for matrices of the pattern of K; all is left alone.
  /// @throws InputError if it is of another pattern, or damaged
  Factored read(ByteReader& archive, const linalg::BlockMatrix& K) const;
  /// @throws linalg::FactorMemoryError
  void adopt(Factored state);
  /// Negative pivots of the last factorisation: 0 for a stable equilibrium, −1 if not known (not symmetric, iteration).
  int negativePivots() const;
  /// Largest entry on the diagonal, N/m.
  double largestDiagonal() const;
  std::int64_t factorisations() const;
  std::int64_t solves() const;
  std::int64_t iterations() const;  ///< of multigrid, in all solves
  /// "CHOLMOD", "UMFPACK", "conjugate gradients", "multigrid", …: what the last factor() took.
  std::string method() const;

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dovetail::fem
