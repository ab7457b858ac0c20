// SparseCholesky by Eigen's LDLᵀ.
#include <Eigen/SparseCholesky>
#include <algorithm>

#include "dovetail/fem/solve/sparse.hpp"

namespace dovetail::fem {

struct SparseCholesky::Impl {
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> solver;
  std::vector<int> offsets, row;  // pattern of the analysis
};

SparseCholesky::SparseCholesky() : impl_(std::make_unique<Impl>()) {}
SparseCholesky::~SparseCholesky() = default;
SparseCholesky::SparseCholesky(SparseCholesky&&) noexcept = default;
SparseCholesky& SparseCholesky::operator=(SparseCholesky&&) noexcept = default;

bool SparseCholesky::factor(const SparseMatrix& A, std::span<const int>) {
  const Eigen::Map<const Eigen::SparseMatrix<double>> matrix(A.size, A.size, static_cast<int>(A.value.size()),
                                                             A.offsets.data(), A.row.data(), A.value.data());
  if (impl_->offsets != A.offsets || impl_->row != A.row) {
    impl_->solver.analyzePattern(matrix);
    impl_->offsets = A.offsets;
    impl_->row = A.row;
  }
  impl_->solver.factorize(matrix);
  return impl_->solver.info() == Eigen::Success && (impl_->solver.vectorD().array() > 0.0).all();
}

void SparseCholesky::solve(std::span<double> b, int columns) {
  Eigen::Map<Eigen::MatrixXd> x(b.data(), static_cast<Eigen::Index>(b.size()) / columns, columns);
  x = impl_->solver.solve(x).eval();
}

const char* SparseCholesky::name() { return "Eigen LDLT"; }

}  // namespace dovetail::fem
