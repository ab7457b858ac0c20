// Large systems of solids by algebraic multigrid.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace dovetail::linalg {

/// Compressed rows; columns ascend within a row. For nodes, component c of node n is row 3n + c.
struct RowMatrix {
  int size = 0;
  std::vector<int> offsets{0};  ///< size + 1 entries
  std::vector<int> column;
  std::vector<double> value;
};

/// The rows of one rank of team(): those of rank 0 come first.
struct SharedRows {
  RowMatrix own;            ///< square: the columns of this rank, from 0
  RowMatrix others;         ///< those of other ranks, as numbered among all; Multigrid writes other numbers there
  std::vector<int> firsts;  ///< first row of each rank, and the number of all
};

/// Smoothed aggregation (PETSc's GAMG, after Vanek, Mandel and Brezina 1996, Computing 56, 179) as preconditioner of
/// conjugate gradients, or of GMRES where the matrix is not symmetric. Iterations hardly grow with the mesh, and memory
/// grows as it does. Digits depend on the release of PETSc, not on the number of threads.
class Multigrid {
public:
  /// Whether this build has PETSc (DOVETAIL_RANKS).
  static bool available();
  /// @throws InputError at this place where it is not available
  static void require(const std::string& where);

  /// @throws InputError where it is not available
  Multigrid(double relativeTolerance, int maxIterations);
  ~Multigrid();
  Multigrid(Multigrid&&) noexcept;

  /// The next matrix: of a pattern that is new if `pattern` is. Levels made for an earlier one are kept while they do
  /// well.
  /// @param A  blocks of 3 rows; is read until the next call, and stays where it is
  /// @param symmetric  and positive definite
  /// @param modes  motions that strain nothing, numbers of A.size; read for new levels only
  /// @throws NumericalError as PETSc says it
  void take(RowMatrix& A, std::size_t pattern, bool symmetric, std::span<const std::vector<double>> modes);
  /// The same by all ranks of a team, each with its rows of A and of the modes; so is solve() then.
  void take(SharedRows& A, std::size_t pattern, bool symmetric, std::span<const std::vector<double>> modes);
  /// Overwrites b by A⁻¹ b, from new levels if those kept do not converge.
  /// @param loosest  relative residual that is enough, if above the tolerance
  /// @throws NumericalError if it does not converge
  void solve(std::span<double> b, double loosest = 0.0);
  std::int64_t iterations() const;  ///< of all solves
  std::int64_t setUps() const;      ///< times that levels were made

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dovetail::linalg
