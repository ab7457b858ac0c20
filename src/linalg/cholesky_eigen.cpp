// SparseCholesky by Eigen's LDLᵀ.
#include <Eigen/SparseCholesky>
#include <algorithm>

#include "dovetail/linalg/sparse.hpp"

namespace dovetail::linalg {

namespace {

/// Tells the entries of the factor before it is made.
struct Ldlt : Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> {
  FactorCost cost() const {
    FactorCost cost;
    for (Eigen::Index column = 0; column < m_nonZerosPerCol.size(); ++column) {
      const double below = m_nonZerosPerCol[column];
      cost.bytes += (sizeof(double) + sizeof(int)) * below;
      cost.operations += below * (below + 3.0);
    }
    return cost;
  }
};

Eigen::Map<const Eigen::SparseMatrix<double>> view(const SparseMatrix& A) {
  return {A.size, A.size, static_cast<int>(A.row.size()), A.offsets.data(), A.row.data(), A.value.data()};
}

}  // namespace

struct SparseCholesky::Impl {
  Ldlt solver;
  std::vector<int> offsets, row;  // pattern of the analysis
};

SparseCholesky::SparseCholesky() : impl_(std::make_unique<Impl>()) {}
SparseCholesky::~SparseCholesky() = default;
SparseCholesky::SparseCholesky(SparseCholesky&&) noexcept = default;
SparseCholesky& SparseCholesky::operator=(SparseCholesky&&) noexcept = default;

FactorCost SparseCholesky::analyse(const SparseMatrix& A, std::span<const int>) {
  if (impl_->offsets != A.offsets || impl_->row != A.row) {
    impl_->solver.analyzePattern(view(A));
    impl_->offsets = A.offsets;
    impl_->row = A.row;
  }
  FactorCost cost = impl_->solver.cost();
  cost.bytes += static_cast<double>((sizeof(double) + sizeof(int)) * A.row.size());
  return cost;
}

bool SparseCholesky::factor(const SparseMatrix& A, std::span<const int> order) {
  analyse(A, order);
  impl_->solver.factorize(view(A));
  return impl_->solver.info() == Eigen::Success && (impl_->solver.vectorD().array() > 0.0).all();
}

void SparseCholesky::solve(std::span<double> b, int columns) {
  Eigen::Map<Eigen::MatrixXd> x(b.data(), static_cast<Eigen::Index>(b.size()) / columns, columns);
  x = impl_->solver.solve(x).eval();
}

const char* SparseCholesky::name() { return "Eigen LDLT"; }

}  // namespace dovetail::linalg
