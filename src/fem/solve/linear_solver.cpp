#include "dovetail/fem/solve/linear_solver.hpp"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::fem {

namespace {

using EigenSparse = Eigen::SparseMatrix<double>;
using Gradients = Eigen::ConjugateGradient<EigenSparse, Eigen::Lower, Eigen::IncompleteCholesky<double, Eigen::Lower>>;

Eigen::Map<const EigenSparse> view(const SparseMatrix& A) {
  return {A.size, A.size, static_cast<Eigen::Index>(A.value.size()), A.offsets.data(), A.row.data(), A.value.data()};
}

Eigen::Map<const Eigen::VectorXd> view(std::span<const double> x) {
  return {x.data(), static_cast<Eigen::Index>(x.size())};
}

enum class Kind { none, cholesky, indefinite, unsymmetric, gradients };

}  // namespace

struct LinearSolver::Impl {
  LinearOptions options;
  ReducedMatrix reduced;
  SparseCholesky cholesky;
  std::unique_ptr<Eigen::SimplicialLDLT<EigenSparse>> indefinite;
  std::unique_ptr<Eigen::SparseLU<EigenSparse>> lu;
  std::unique_ptr<Gradients> gradients;
  EigenSparse matrix;  // of conjugate gradients, which keep a reference to it
  Kind kind = Kind::none;
  int negative = -1;
  double largestDiagonal = 0.0;
  std::int64_t factorisations = 0, solves = 0;

  bool factorCholesky(const SparseMatrix& A) {
    if (!cholesky.factor(A)) return false;
    kind = Kind::cholesky;
    negative = 0;
    return true;
  }
  bool factorIndefinite(const SparseMatrix& A) {
    if (!indefinite) indefinite = std::make_unique<Eigen::SimplicialLDLT<EigenSparse>>();
    indefinite->compute(view(A));
    if (indefinite->info() != Eigen::Success) return false;
    const Eigen::VectorXd pivots = indefinite->vectorD();
    if (!pivots.allFinite() || (pivots.array() == 0.0).any()) return false;
    kind = Kind::indefinite;
    negative = static_cast<int>((pivots.array() < 0.0).count());
    return true;
  }
  bool factorUnsymmetric(const SparseMatrix& A) {
    if (!lu) lu = std::make_unique<Eigen::SparseLU<EigenSparse>>();
    lu->compute(view(A));
    if (lu->info() != Eigen::Success) return false;
    kind = Kind::unsymmetric;
    negative = -1;
    return true;
  }
  bool factorGradients(const SparseMatrix& A) {
    matrix = view(A);
    if (!gradients) gradients = std::make_unique<Gradients>();
    gradients->setTolerance(options.relativeTolerance);
    gradients->setMaxIterations(options.maxIterations);
    gradients->compute(matrix);
    if (gradients->info() != Eigen::Success) return false;
    kind = Kind::gradients;
    negative = -1;
    return true;
  }
};

LinearSolver::LinearSolver(const DofMap& dofs, const LinearOptions& options)
    : impl_(std::make_unique<Impl>(Impl{options, ReducedMatrix(dofs), {}, {}, {}, {}, {}})) {
  requirePositive(options.relativeTolerance, "relativeTolerance");
  if (options.maxIterations < 1)
    throw InputError("no iterations are allowed", "LinearOptions", "give maxIterations of 1 or more");
}
LinearSolver::~LinearSolver() = default;
LinearSolver::LinearSolver(LinearSolver&&) noexcept = default;

bool LinearSolver::factor(const BlockMatrix& K, bool symmetric) {
  Impl& m = *impl_;
  const SparseMatrix& A = m.reduced.update(K, symmetric);
  m.kind = Kind::none;
  ++m.factorisations;
  m.largestDiagonal = 0.0;
  for (std::size_t column = 0; column < static_cast<std::size_t>(A.size); ++column)
    for (int k = A.offsets[column]; k < A.offsets[column + 1]; ++k)
      if (A.row[static_cast<std::size_t>(k)] == static_cast<int>(column))
        m.largestDiagonal = std::max(m.largestDiagonal, std::abs(A.value[static_cast<std::size_t>(k)]));
  if (!std::all_of(A.value.begin(), A.value.end(), [](double v) { return std::isfinite(v); })) return false;
  if (A.size == 0) return m.kind = Kind::cholesky, true;
  if (!symmetric) return m.factorUnsymmetric(A);
  if (m.options.method == LinearMethod::conjugateGradients) return m.factorGradients(A);
  return m.factorCholesky(A) || m.factorIndefinite(A);
}

void LinearSolver::solve(std::span<const double> r, std::span<double> x) {
  Impl& m = *impl_;
  ++m.solves;
  if (r.empty()) return;
  Eigen::Map<Eigen::VectorXd> result(x.data(), static_cast<Eigen::Index>(x.size()));
  switch (m.kind) {
    case Kind::cholesky:
      if (x.data() != r.data()) std::copy(r.begin(), r.end(), x.begin());
      m.cholesky.solve(x);
      return;
    case Kind::indefinite:
      result = m.indefinite->solve(view(r)).eval();
      return;
    case Kind::unsymmetric:
      result = m.lu->solve(view(r)).eval();
      return;
    case Kind::gradients:
      result = m.gradients->solve(view(r)).eval();
      if (m.gradients->info() == Eigen::Success) return;
      throw NumericalError("conjugate gradients stop after " + std::to_string(m.gradients->iterations()) +
                               " iterations at a relative residual of " + formatNumber(m.gradients->error()),
                           "LinearSolver", "use LinearMethod::direct, or a larger maxIterations");
    default:
      throw InputError("there is no factorisation", "LinearSolver::solve", "call factor() first");
  }
}

bool LinearSolver::factored() const { return impl_->kind != Kind::none; }
void LinearSolver::drop() { impl_->kind = Kind::none; }
int LinearSolver::negativePivots() const { return impl_->negative; }
double LinearSolver::largestDiagonal() const { return impl_->largestDiagonal; }
std::int64_t LinearSolver::factorisations() const { return impl_->factorisations; }
std::int64_t LinearSolver::solves() const { return impl_->solves; }
std::string LinearSolver::method() const {
  switch (impl_->kind) {
    case Kind::cholesky:
      return SparseCholesky::name();
    case Kind::indefinite:
      return "LDLT";
    case Kind::unsymmetric:
      return "LU";
    case Kind::gradients:
      return "conjugate gradients";
    default:
      return "none";
  }
}

}  // namespace dovetail::fem
