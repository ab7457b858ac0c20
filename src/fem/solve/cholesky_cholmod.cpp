// SparseCholesky by CHOLMOD of SuiteSparse.
#include <cholmod.h>
#include <dlfcn.h>

#include <algorithm>

#include "dovetail/fem/solve/sparse.hpp"

namespace dovetail::fem {

namespace {

/// Holds OpenBLAS, if that is the BLAS in use, to one thread: its sums depend on the number of threads.
class OneBlasThread {
public:
  OneBlasThread() {
    if (get() && set()) {
      before_ = get()();
      if (before_ != 1) set()(1);
    }
  }
  ~OneBlasThread() {
    if (before_ > 1) set()(before_);
  }
  OneBlasThread(const OneBlasThread&) = delete;
  OneBlasThread& operator=(const OneBlasThread&) = delete;

private:
  using Get = int (*)();
  using Set = void (*)(int);
  static Get get() {
    static const auto f = reinterpret_cast<Get>(dlsym(RTLD_DEFAULT, "openblas_get_num_threads"));
    return f;
  }
  static Set set() {
    static const auto f = reinterpret_cast<Set>(dlsym(RTLD_DEFAULT, "openblas_set_num_threads"));
    return f;
  }
  int before_ = 1;
};

}  // namespace

struct SparseCholesky::Impl {
  cholmod_common common{};
  cholmod_factor* factor = nullptr;
  cholmod_dense *solution = nullptr, *work = nullptr, *more = nullptr;
  std::vector<int> offsets, row;  // pattern of the analysis

  Impl() {
    cholmod_start(&common);
    common.print = 0;
    common.quick_return_if_not_posdef = 1;
  }
  ~Impl() {
    cholmod_free_dense(&solution, &common);
    cholmod_free_dense(&work, &common);
    cholmod_free_dense(&more, &common);
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
};

SparseCholesky::SparseCholesky() : impl_(std::make_unique<Impl>()) {}
SparseCholesky::~SparseCholesky() = default;
SparseCholesky::SparseCholesky(SparseCholesky&&) noexcept = default;
SparseCholesky& SparseCholesky::operator=(SparseCholesky&&) noexcept = default;

bool SparseCholesky::factor(const SparseMatrix& A) {
  const OneBlasThread guard;
  Impl& m = *impl_;
  // CHOLMOD takes pointers to mutable data but only reads the matrix.
  cholmod_sparse matrix{};
  matrix.nrow = matrix.ncol = static_cast<std::size_t>(A.size);
  matrix.nzmax = A.value.size();
  matrix.p = const_cast<int*>(A.offsets.data());
  matrix.i = const_cast<int*>(A.row.data());
  matrix.x = const_cast<double*>(A.value.data());
  matrix.stype = -1;
  matrix.itype = CHOLMOD_INT;
  matrix.xtype = CHOLMOD_REAL;
  matrix.dtype = CHOLMOD_DOUBLE;
  matrix.sorted = matrix.packed = 1;
  if (!m.factor || m.offsets != A.offsets || m.row != A.row) {
    cholmod_free_factor(&m.factor, &m.common);
    m.factor = cholmod_analyze(&matrix, &m.common);
    m.offsets = A.offsets;
    m.row = A.row;
  }
  if (!m.factor) return false;
  cholmod_factorize(&matrix, m.factor, &m.common);
  if (m.common.status != CHOLMOD_OK) return false;
  // A simplicial LDLᵀ goes through negative pivots without a complaint; LLᵀ would stop.
  if (m.factor->is_ll || m.factor->is_super) return true;
  const auto* start = static_cast<const int*>(m.factor->p);
  const auto* value = static_cast<const double*>(m.factor->x);
  for (std::size_t j = 0; j < m.factor->n; ++j)
    if (!(value[start[j]] > 0.0)) return false;
  return true;
}

void SparseCholesky::solve(std::span<double> b) {
  const OneBlasThread guard;
  Impl& m = *impl_;
  cholmod_dense right{};
  right.nrow = right.nzmax = right.d = b.size();
  right.ncol = 1;
  right.x = b.data();
  right.xtype = CHOLMOD_REAL;
  right.dtype = CHOLMOD_DOUBLE;
  cholmod_solve2(CHOLMOD_A, m.factor, &right, nullptr, &m.solution, nullptr, &m.work, &m.more, &m.common);
  const auto* x = static_cast<const double*>(m.solution->x);
  std::copy(x, x + b.size(), b.begin());
}

const char* SparseCholesky::name() { return "CHOLMOD"; }

}  // namespace dovetail::fem
