#include "dovetail/linalg/definite_solver.hpp"

#include <Eigen/IterativeLinearSolvers>
#include <optional>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::linalg {

namespace {

using EigenSparse = Eigen::SparseMatrix<double>;
using Gradients = Eigen::ConjugateGradient<EigenSparse, Eigen::Lower, Eigen::IncompleteCholesky<double, Eigen::Lower>>;

Eigen::Map<const EigenSparse> view(const SparseMatrix& A) {
  return {A.size, A.size, static_cast<Eigen::Index>(A.value.size()), A.offsets.data(), A.row.data(), A.value.data()};
}

}  // namespace

struct DefiniteSolver::Impl {
  LinearOptions options;
  std::optional<SparseCholesky> cholesky;  // the one or the other
  std::unique_ptr<Gradients> gradients;
  EigenSparse matrix;  // of conjugate gradients, which keep a reference to it

  /// Makes one of the two.
  LinearForecast choose(const SparseMatrix& lower) {
    double factors = 0.0;
    if (options.method != LinearMethod::conjugateGradients) {
      gradients.reset();
      if (!cholesky) cholesky.emplace();
      const FactorCost cost = cholesky->analyse(lower);
      if (options.method == LinearMethod::direct || cost.bytes <= options.largestFactors)
        return {LinearMethod::direct, cost.bytes, cost.operations, cost.bytes};
      factors = cost.bytes;
      cholesky.reset();
    }
    if (!gradients) gradients = std::make_unique<Gradients>();
    // Of each entry: the matrix and the incomplete factor, and what is put into another order for it (68 bytes
    // together, measured on boxes of 40³ and 46³ bricks); a product with either takes four operations.
    const auto entries = static_cast<double>(lower.row.size());
    return {LinearMethod::conjugateGradients, 68.0 * entries, 100.0 * 8.0 * entries, factors};
  }
  bool prepareGradients(const SparseMatrix& lower) {
    matrix = view(lower);
    gradients->setTolerance(options.relativeTolerance);
    gradients->setMaxIterations(options.maxIterations);
    gradients->compute(matrix);
    return gradients->info() == Eigen::Success;
  }
  void iterate(std::span<double> b) {
    Eigen::Map<Eigen::VectorXd> x(b.data(), static_cast<Eigen::Index>(b.size()));
    x = gradients->solve(x).eval();
    if (gradients->info() != Eigen::Success)
      throw NumericalError("conjugate gradients stop after " + std::to_string(gradients->iterations()) +
                               " iterations at a relative residual of " + formatNumber(gradients->error()),
                           "linear solver", "take the direct method, a smaller step, or more iterations");
  }
};

DefiniteSolver::DefiniteSolver(const LinearOptions& options)
    : impl_(std::make_unique<Impl>(Impl{options, {}, {}, {}})) {
  requirePositive(options.relativeTolerance, "relativeTolerance");
  requireNonNegative(options.largestFactors, "largestFactors");
  if (options.maxIterations < 1)
    throw InputError("no iterations are allowed", "LinearOptions", "give maxIterations of 1 or more");
}
DefiniteSolver::~DefiniteSolver() = default;
DefiniteSolver::DefiniteSolver(DefiniteSolver&&) noexcept = default;

LinearForecast DefiniteSolver::analyse(const SparseMatrix& lower) { return impl_->choose(lower); }

bool DefiniteSolver::factor(const SparseMatrix& lower) {
  Impl& m = *impl_;
  if (!m.gradients) m.choose(lower);
  return m.gradients ? m.prepareGradients(lower) : m.cholesky->factor(lower);
}

void DefiniteSolver::solve(std::span<double> b, int columns) {
  if (!iterates()) return impl_->cholesky->solve(b, columns);
  const std::size_t size = b.size() / static_cast<std::size_t>(columns);
  for (std::size_t first = 0; first < b.size(); first += size) impl_->iterate(b.subspan(first, size));
}

bool DefiniteSolver::iterates() const { return impl_->gradients != nullptr; }

}  // namespace dovetail::linalg
