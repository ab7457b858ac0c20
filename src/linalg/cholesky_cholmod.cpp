// SparseCholesky by CHOLMOD of SuiteSparse.
#include <cholmod.h>

#include <algorithm>
#include <type_traits>

#include "dovetail/core/parallel.hpp"
#include "suitesparse.hpp"
#include "supernodal.hpp"

namespace dovetail::linalg {

namespace {

static_assert(std::is_same_v<SuiteSparse_long, std::int64_t>);

constexpr const char* package = "CHOLMOD";

std::span<const std::int64_t> integers(const void* first, std::size_t count) {
  return {static_cast<const std::int64_t*>(first), count};
}

detail::SupernodalPattern patternOf(const cholmod_factor& L) {
  return {integers(L.super, L.nsuper + 1), integers(L.pi, L.nsuper + 1), integers(L.px, L.nsuper + 1),
          integers(L.s, L.ssize)};
}

/// CHOLMOD takes pointers to mutable data but only reads the matrix.
cholmod_sparse view(const SparseMatrix& A, detail::LongPattern& pattern) {
  cholmod_sparse matrix{};
  matrix.nrow = matrix.ncol = static_cast<std::size_t>(A.size);
  matrix.nzmax = A.value.size();
  matrix.p = pattern.offsets.data();
  matrix.i = pattern.row.data();
  matrix.x = const_cast<double*>(A.value.data());
  matrix.stype = -1;
  matrix.itype = CHOLMOD_LONG;
  matrix.xtype = CHOLMOD_REAL;
  matrix.dtype = CHOLMOD_DOUBLE;
  matrix.sorted = matrix.packed = 1;
  return matrix;
}

/// @return whether the matrix is positive definite, as far as the status tells
bool judge(int status, const SparseMatrix& A) {
  if (status == CHOLMOD_OUT_OF_MEMORY) detail::throwOutOfMemory(package, A);
  if (status == CHOLMOD_TOO_LARGE) detail::throwTooLarge(package, A);
  if (status < CHOLMOD_OK) detail::throwRefused(package, status);
  return status != CHOLMOD_NOT_POSDEF;
}

}  // namespace

struct SparseCholesky::Impl {
  cholmod_common common{};
  cholmod_factor* factor = nullptr;
  cholmod_dense *solution = nullptr, *work = nullptr, *more = nullptr;
  detail::LongPattern pattern;          // of the analysis
  std::vector<SuiteSparse_long> order;  // that was asked for
  detail::SupernodalPlan plan;          // where the factor is by supernodes
  detail::SupernodalSolver solver;
  std::vector<double> inOrder;

  Impl() {
    cholmod_l_start(&common);
    common.print = 0;
    common.quick_return_if_not_posdef = 1;
  }
  ~Impl() {
    cholmod_l_free_dense(&solution, &common);
    cholmod_l_free_dense(&work, &common);
    cholmod_l_free_dense(&more, &common);
    cholmod_l_free_factor(&factor, &common);
    cholmod_l_finish(&common);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void analyse(const SparseMatrix& A, std::span<const int> asked);
  /// CHOLMOD's own solves run on one thread; with few right-hand sides they take half as long again there.
  void solveBySupernodes(std::span<double> b, int columns);
};

SparseCholesky::SparseCholesky() : impl_(std::make_unique<Impl>()) {}
SparseCholesky::~SparseCholesky() = default;
SparseCholesky::SparseCholesky(SparseCholesky&&) noexcept = default;
SparseCholesky& SparseCholesky::operator=(SparseCholesky&&) noexcept = default;

void SparseCholesky::Impl::analyse(const SparseMatrix& A, std::span<const int> asked) {
  cholmod_l_free_factor(&factor, &common);
  pattern.take(A);
  order.assign(asked.begin(), asked.end());
  common.nmethods = order.empty() ? 0 : 1;
  common.method[0].ordering = CHOLMOD_GIVEN;
  cholmod_sparse matrix = view(A, pattern);
  factor = cholmod_l_analyze_p(&matrix, order.empty() ? nullptr : order.data(), nullptr, 0, &common);
  judge(common.status, A);
  if (!factor->is_super) return;
  const detail::SupernodalPattern L = patternOf(*factor);
  plan = detail::planOf(L);
  solver.prepare(L, plan);
}

FactorCost SparseCholesky::analyse(const SparseMatrix& A, std::span<const int> order) {
  Impl& m = *impl_;
  if (!m.factor || !m.pattern.isOf(A) || !std::ranges::equal(m.order, order)) m.analyse(A, order);
  // Numbers and rows of the factor, the largest block of a supernode, and the matrix in another order, twice.
  const cholmod_factor& L = *m.factor;
  const auto copies = static_cast<double>(2 * sizeof(double) * 2 * A.row.size());
  const double numbers = L.is_super ? static_cast<double>(L.xsize + L.maxcsize) : 2.0 * m.common.lnz;
  return {8.0 * numbers + copies, m.common.fl};
}

bool SparseCholesky::factor(const SparseMatrix& A, std::span<const int> order) {
  const detail::OneBlasThread guard;
  analyse(A, order);
  Impl& m = *impl_;
  cholmod_sparse matrix = view(A, m.pattern);
  cholmod_l_factorize(&matrix, m.factor, &m.common);
  if (!judge(m.common.status, A)) return false;
  // A simplicial LDLᵀ goes through negative pivots without a complaint; LLᵀ would stop.
  if (m.factor->is_super || m.factor->is_ll) return true;
  const auto* start = static_cast<const SuiteSparse_long*>(m.factor->p);
  const auto* value = static_cast<const double*>(m.factor->x);
  for (std::size_t j = 0; j < m.factor->n; ++j)
    if (!(value[start[j]] > 0.0)) return false;
  return true;
}

void SparseCholesky::Impl::solveBySupernodes(std::span<double> b, int columns) {
  const std::span<const std::int64_t> rows = integers(factor->Perm, factor->n);
  inOrder.resize(b.size());
  const auto eachRow = [&](const auto& visit) {
    parallelFor(rows.size(), 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t first = 0; first < b.size(); first += rows.size())
        for (std::size_t k = begin; k < end; ++k)
          visit(inOrder[first + k], b[first + static_cast<std::size_t>(rows[k])]);
    });
  };
  eachRow([](double& own, double outer) { own = outer; });
  solver.solve(patternOf(*factor), plan, static_cast<const double*>(factor->x), inOrder, columns);
  eachRow([](double own, double& outer) { outer = own; });
}

void SparseCholesky::solve(std::span<double> b, int columns) {
  Impl& m = *impl_;
  if (m.factor->is_super) return m.solveBySupernodes(b, columns);
  const detail::OneBlasThread guard;
  cholmod_dense right{};
  right.ncol = static_cast<std::size_t>(columns);
  right.nrow = right.d = b.size() / right.ncol;
  right.nzmax = b.size();
  right.x = b.data();
  right.xtype = CHOLMOD_REAL;
  right.dtype = CHOLMOD_DOUBLE;
  if (!cholmod_l_solve2(CHOLMOD_A, m.factor, &right, nullptr, &m.solution, nullptr, &m.work, &m.more, &m.common))
    throw NumericalError("CHOLMOD finds no memory for a solution", std::to_string(right.nrow) + " unknowns",
                         "take a coarser mesh, or a machine with more memory");
  const auto* x = static_cast<const double*>(m.solution->x);
  std::copy(x, x + b.size(), b.begin());
}

const char* SparseCholesky::name() { return package; }

}  // namespace dovetail::linalg
