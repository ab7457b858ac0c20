// SparseLu by Eigen's LU, and LDLᵀ for symmetric matrices.
#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>
#include <algorithm>

#include "dovetail/linalg/sparse.hpp"

namespace dovetail::linalg {

struct SparseLu::Impl {
  Eigen::SparseLU<Eigen::SparseMatrix<double>> general;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> ldlt;
  std::vector<int> offsets, row;  // pattern of the analysis
  bool symmetric = false;
  int negative = -1;

  template <class Solver>
  static bool factorise(Solver& solver, const Eigen::Map<const Eigen::SparseMatrix<double>>& A, bool known) {
    if (!known) solver.analyzePattern(A);
    solver.factorize(A);
    return solver.info() == Eigen::Success;
  }
};

SparseLu::SparseLu() : impl_(std::make_unique<Impl>()) {}
SparseLu::~SparseLu() = default;
SparseLu::SparseLu(SparseLu&&) noexcept = default;
SparseLu& SparseLu::operator=(SparseLu&&) noexcept = default;

bool SparseLu::factor(const SparseMatrix& A, bool symmetric) {
  Impl& m = *impl_;
  const Eigen::Map<const Eigen::SparseMatrix<double>> matrix(A.size, A.size, static_cast<int>(A.value.size()),
                                                             A.offsets.data(), A.row.data(), A.value.data());
  const bool known = m.symmetric == symmetric && m.offsets == A.offsets && m.row == A.row;
  m.symmetric = symmetric;
  m.offsets = A.offsets;
  m.row = A.row;
  m.negative = -1;
  if (!symmetric) return Impl::factorise(m.general, matrix, known);
  if (!Impl::factorise(m.ldlt, matrix, known)) return false;
  const Eigen::VectorXd pivots = m.ldlt.vectorD();
  if (!pivots.allFinite() || (pivots.array() == 0.0).any()) return false;
  m.negative = static_cast<int>((pivots.array() < 0.0).count());
  return true;
}

void SparseLu::solve(std::span<double> b) {
  Eigen::Map<Eigen::VectorXd> x(b.data(), static_cast<Eigen::Index>(b.size()));
  if (impl_->symmetric)
    x = impl_->ldlt.solve(x).eval();
  else
    x = impl_->general.solve(x).eval();
}

int SparseLu::negativePivots() const { return impl_->negative; }
const char* SparseLu::name() { return "Eigen LU"; }

}  // namespace dovetail::linalg
