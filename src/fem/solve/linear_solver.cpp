#include "dovetail/fem/solve/linear_solver.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"

namespace dovetail::fem {

namespace {

enum class Kind { none, definite, lu };

}  // namespace

struct LinearSolver::Impl {
  ReducedMatrix reduced;
  linalg::DefiniteSolver definite;
  linalg::SparseLu lu;
  Kind kind = Kind::none;
  bool wasIndefinite = false;
  int negative = -1;
  double largestDiagonal = 0.0;
  std::int64_t factorisations = 0, solves = 0;

  /// A matrix that follows an indefinite one is taken for indefinite too: a failed Cholesky factorisation may cost as
  /// much as one that succeeds.
  bool factorSymmetric(const linalg::SparseMatrix& A) {
    if (!wasIndefinite && definite.factor(A)) {
      kind = Kind::definite;
      negative = definite.iterates() ? -1 : 0;
      return true;
    }
    if (definite.iterates() || !factorLu(A, true)) return false;
    wasIndefinite = negative != 0;
    return true;
  }
  bool factorLu(const linalg::SparseMatrix& A, bool symmetric) {
    if (!lu.factor(A, symmetric)) return false;
    kind = Kind::lu;
    negative = lu.negativePivots();
    return true;
  }
};

LinearSolver::LinearSolver(const DofMap& dofs, const linalg::LinearOptions& options)
    : impl_(std::make_unique<Impl>(Impl{ReducedMatrix(dofs), linalg::DefiniteSolver(options), {}})) {}
LinearSolver::~LinearSolver() = default;
LinearSolver::LinearSolver(LinearSolver&&) noexcept = default;

linalg::LinearForecast LinearSolver::forecast(const linalg::BlockMatrix& K, bool symmetric) {
  const linalg::LinearForecast forecast = impl_->definite.analyse(impl_->reduced.update(K, true));
  if (symmetric) return forecast;
  // L and U, and fronts that pivoting may widen.
  return {linalg::LinearMethod::direct, 3.0 * forecast.bytes, 2.0 * forecast.operations, forecast.factors};
}

bool LinearSolver::factor(const linalg::BlockMatrix& K, bool symmetric) {
  Impl& m = *impl_;
  const linalg::SparseMatrix& A = m.reduced.update(K, symmetric);
  m.kind = Kind::none;
  ++m.factorisations;
  m.largestDiagonal = 0.0;
  for (std::size_t column = 0; column < static_cast<std::size_t>(A.size); ++column)
    for (int k = A.offsets[column]; k < A.offsets[column + 1]; ++k)
      if (A.row[static_cast<std::size_t>(k)] == static_cast<int>(column))
        m.largestDiagonal = std::max(m.largestDiagonal, std::abs(A.value[static_cast<std::size_t>(k)]));
  if (!std::all_of(A.value.begin(), A.value.end(), [](double v) { return std::isfinite(v); })) return false;
  if (A.size == 0) return m.kind = Kind::definite, true;
  return symmetric ? m.factorSymmetric(A) : m.factorLu(A, false);
}

void LinearSolver::solve(std::span<const double> r, std::span<double> x) {
  Impl& m = *impl_;
  ++m.solves;
  if (r.empty()) return;
  if (m.kind == Kind::none) throw InputError("there is no factorisation", "LinearSolver::solve", "call factor() first");
  if (x.data() != r.data()) std::copy(r.begin(), r.end(), x.begin());
  m.kind == Kind::lu ? m.lu.solve(x) : m.definite.solve(x);
}

void LinearSolver::save(ByteWriter& archive) const {
  const Impl& m = *impl_;
  archive(static_cast<int>(m.kind), m.wasIndefinite);
  if (m.kind != Kind::none) m.reduced.save(archive);
}

LinearSolver::Factored LinearSolver::read(ByteReader& archive, const linalg::BlockMatrix& K) const {
  Factored state{0, false, ReducedMatrix(impl_->reduced.dofs())};
  archive(state.kind, state.wasIndefinite);
  if (state.kind < 0 || state.kind > static_cast<int>(Kind::lu))
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
  const linalg::SparseMatrix& A = m.reduced.matrix();
  if (A.size == 0)
    m.kind = Kind::definite;
  else if (state.kind == static_cast<int>(Kind::lu))
    m.factorLu(A, m.reduced.symmetric());
  else if (m.definite.factor(A))
    m.kind = Kind::definite;
}

bool LinearSolver::factored() const { return impl_->kind != Kind::none; }
bool LinearSolver::iterates() const { return impl_->definite.iterates(); }
void LinearSolver::drop() { impl_->kind = Kind::none; }
int LinearSolver::negativePivots() const { return impl_->negative; }
double LinearSolver::largestDiagonal() const { return impl_->largestDiagonal; }
std::int64_t LinearSolver::factorisations() const { return impl_->factorisations; }
std::int64_t LinearSolver::solves() const { return impl_->solves; }
std::string LinearSolver::method() const {
  if (impl_->kind == Kind::lu) return linalg::SparseLu::name();
  if (impl_->kind == Kind::none) return "none";
  return impl_->definite.iterates() ? "conjugate gradients" : linalg::SparseCholesky::name();
}

}  // namespace dovetail::fem
