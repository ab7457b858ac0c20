// SparseCholesky by CHOLMOD of SuiteSparse.
#include <cholmod.h>

#include <algorithm>

#include "suitesparse.hpp"

namespace dovetail::fem {

namespace {

constexpr const char* package = "CHOLMOD";

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
  detail::LongPattern pattern;  // of the analysis

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
};

SparseCholesky::SparseCholesky() : impl_(std::make_unique<Impl>()) {}
SparseCholesky::~SparseCholesky() = default;
SparseCholesky::SparseCholesky(SparseCholesky&&) noexcept = default;
SparseCholesky& SparseCholesky::operator=(SparseCholesky&&) noexcept = default;

bool SparseCholesky::factor(const SparseMatrix& A) {
  const detail::OneBlasThread guard;
  Impl& m = *impl_;
  if (!m.factor || !m.pattern.isOf(A)) {
    cholmod_l_free_factor(&m.factor, &m.common);
    m.pattern.take(A);
    cholmod_sparse matrix = view(A, m.pattern);
    m.factor = cholmod_l_analyze(&matrix, &m.common);
    judge(m.common.status, A);
  }
  cholmod_sparse matrix = view(A, m.pattern);
  cholmod_l_factorize(&matrix, m.factor, &m.common);
  if (!judge(m.common.status, A)) return false;
  // A simplicial LDLᵀ goes through negative pivots without a complaint; LLᵀ would stop.
  if (m.factor->is_ll || m.factor->is_super) return true;
  const auto* start = static_cast<const SuiteSparse_long*>(m.factor->p);
  const auto* value = static_cast<const double*>(m.factor->x);
  for (std::size_t j = 0; j < m.factor->n; ++j)
    if (!(value[start[j]] > 0.0)) return false;
  return true;
}

void SparseCholesky::solve(std::span<double> b, int columns) {
  const detail::OneBlasThread guard;
  Impl& m = *impl_;
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

}  // namespace dovetail::fem
