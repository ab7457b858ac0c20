#include "dovetail/fem/solve/linear_solver.hpp"

#include <Eigen/IterativeLinearSolvers>
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

enum class Kind { none, cholesky, lu, gradients };

}  // namespace

struct LinearSolver::Impl {
  LinearOptions options;
  ReducedMatrix reduced;
  SparseCholesky cholesky;
  SparseLu lu;
  std::unique_ptr<Gradients> gradients;
  EigenSparse matrix;  // of conjugate gradients, which keep a reference to it
  Kind kind = Kind::none;
  bool wasIndefinite = false;
  int negative = -1;
  double largestDiagonal = 0.0;
  std::int64_t factorisations = 0, solves = 0;

  /// A matrix that follows an indefinite one is taken for indefinite too: a failed Cholesky factorisation may cost as
  /// much as one that succeeds.
  bool factorSymmetric(const SparseMatrix& A) {
    if (!wasIndefinite && cholesky.factor(A)) {
      kind = Kind::cholesky;
      negative = 0;
      return true;
    }
    if (!factorLu(A, true)) return false;
    wasIndefinite = negative != 0;
    return true;
  }
  bool factorLu(const SparseMatrix& A, bool symmetric) {
    if (!lu.factor(A, symmetric)) return false;
    kind = Kind::lu;
    negative = lu.negativePivots();
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
    : impl_(std::make_unique<Impl>(Impl{options, ReducedMatrix(dofs), {}, {}, {}, {}})) {
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
  if (!symmetric) return m.factorLu(A, false);
  if (m.options.method == LinearMethod::conjugateGradients) return m.factorGradients(A);
  return m.factorSymmetric(A);
}

void LinearSolver::solve(std::span<const double> r, std::span<double> x) {
  Impl& m = *impl_;
  ++m.solves;
  if (r.empty()) return;
  switch (m.kind) {
    case Kind::cholesky:
    case Kind::lu:
      if (x.data() != r.data()) std::copy(r.begin(), r.end(), x.begin());
      m.kind == Kind::lu ? m.lu.solve(x) : m.cholesky.solve(x);
      return;
    case Kind::gradients:
      Eigen::Map<Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size())) = m.gradients->solve(view(r)).eval();
      if (m.gradients->info() == Eigen::Success) return;
      throw NumericalError("conjugate gradients stop after " + std::to_string(m.gradients->iterations()) +
                               " iterations at a relative residual of " + formatNumber(m.gradients->error()),
                           "LinearSolver", "use LinearMethod::direct, or a larger maxIterations");
    default:
      throw InputError("there is no factorisation", "LinearSolver::solve", "call factor() first");
  }
}

void LinearSolver::save(ByteWriter& archive) const {
  const Impl& m = *impl_;
  archive(static_cast<int>(m.kind), m.wasIndefinite);
  if (m.kind != Kind::none) m.reduced.save(archive);
}

LinearSolver::Factored LinearSolver::read(ByteReader& archive, const BlockMatrix& K) const {
  Factored state{0, false, ReducedMatrix(impl_->reduced.dofs())};
  archive(state.kind, state.wasIndefinite);
  if (state.kind < 0 || state.kind > static_cast<int>(Kind::gradients))
    throw InputError("a kind of factors has the number " + std::to_string(state.kind), "LinearSolver",
                     "load it into the run that saved it");
  if (state.kind != static_cast<int>(Kind::none)) state.matrix.load(archive, K);
  return state;
}

void LinearSolver::adopt(Factored state) {
  Impl& m = *impl_;
  m.kind = Kind::none;
  m.wasIndefinite = state.wasIndefinite;
  if (state.kind == static_cast<int>(Kind::none)) return;
  m.reduced = std::move(state.matrix);
  const SparseMatrix& A = m.reduced.matrix();
  if (A.size == 0)
    m.kind = Kind::cholesky;
  else if (state.kind == static_cast<int>(Kind::lu))
    m.factorLu(A, m.reduced.symmetric());
  else if (state.kind == static_cast<int>(Kind::gradients))
    m.factorGradients(A);
  else if (m.cholesky.factor(A))
    m.kind = Kind::cholesky;
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
    case Kind::lu:
      return SparseLu::name();
    case Kind::gradients:
      return "conjugate gradients";
    default:
      return "none";
  }
}

}  // namespace dovetail::fem
