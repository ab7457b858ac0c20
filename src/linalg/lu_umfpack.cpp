// SparseLu by UMFPACK of SuiteSparse.
#include <umfpack.h>

#include <array>
#include <numeric>

#include "suitesparse.hpp"

namespace dovetail::linalg {

namespace {

constexpr const char* package = "UMFPACK";

/// Pattern of the whole of a symmetric matrix whose lower triangle is given, and the source of each of its entries.
void unfold(const SparseMatrix& lower, detail::LongPattern& whole, std::vector<std::size_t>& source) {
  const auto size = static_cast<std::size_t>(lower.size);
  const auto visit = [&](const auto& act) {
    for (std::size_t column = 0; column < size; ++column)
      for (auto k = static_cast<std::size_t>(lower.offsets[column]);
           k < static_cast<std::size_t>(lower.offsets[column + 1]); ++k) {
        const auto row = static_cast<std::size_t>(lower.row[k]);
        act(row, column, k);
        if (row != column) act(column, row, k);
      }
  };
  whole.offsets.assign(size + 1, 0);
  visit([&](std::size_t, std::size_t column, std::size_t) { ++whole.offsets[column + 1]; });
  std::partial_sum(whole.offsets.begin(), whole.offsets.end(), whole.offsets.begin());
  whole.row.resize(static_cast<std::size_t>(whole.offsets.back()));
  source.resize(whole.row.size());
  std::vector<SuiteSparse_long> next = whole.offsets;
  // Rows come in ascending order: those above the diagonal from earlier columns, then those of the column.
  visit([&](std::size_t row, std::size_t column, std::size_t k) {
    const auto place = static_cast<std::size_t>(next[column]++);
    whole.row[place] = static_cast<SuiteSparse_long>(row);
    source[place] = k;
  });
}

}  // namespace

struct SparseLu::Impl {
  std::array<double, UMFPACK_CONTROL> control{};
  std::array<double, UMFPACK_INFO> info{};
  void *symbolic = nullptr, *numeric = nullptr;
  detail::LongPattern given, pattern;  // of what was given, and of all of it
  std::vector<std::size_t> source;     // of each entry of a symmetric matrix
  std::vector<double> value, right;
  bool symmetric = false;
  int negative = -1;

  Impl() = default;
  ~Impl() {
    umfpack_dl_free_numeric(&numeric);
    umfpack_dl_free_symbolic(&symbolic);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  /// Pivots of a symmetric matrix stay on the diagonal, where they tell the inertia, unless they all but vanish.
  void setControl() {
    umfpack_dl_defaults(control.data());
    control[UMFPACK_ORDERING] = UMFPACK_ORDERING_CHOLMOD;
    if (!symmetric) return;
    control[UMFPACK_STRATEGY] = UMFPACK_STRATEGY_SYMMETRIC;
    control[UMFPACK_SYM_PIVOT_TOLERANCE] = 1e-10;
    control[UMFPACK_SCALE] = UMFPACK_SCALE_NONE;
  }
  /// @return false if the matrix is singular
  static bool judge(SuiteSparse_long status, const SparseMatrix& A) {
    if (status == UMFPACK_WARNING_singular_matrix) return false;
    if (status == UMFPACK_ERROR_out_of_memory) detail::throwOutOfMemory(package, A);
    if (status < UMFPACK_OK) detail::throwRefused(package, static_cast<int>(status));
    return true;
  }
  void analyse(const SparseMatrix& A, bool isSymmetric) {
    if (symbolic != nullptr && symmetric == isSymmetric && given.isOf(A)) return;
    umfpack_dl_free_symbolic(&symbolic);
    symmetric = isSymmetric;
    given.take(A);
    pattern = given;
    if (symmetric) unfold(A, pattern, source);
    setControl();
    // Without values: the analysis is to serve all matrices of the pattern.
    judge(umfpack_dl_symbolic(A.size, A.size, pattern.offsets.data(), pattern.row.data(), nullptr, &symbolic,
                              control.data(), info.data()),
          A);
  }
  void takeValues(const SparseMatrix& A) {
    if (!symmetric) {
      value = A.value;
      return;
    }
    value.resize(source.size());
    for (std::size_t k = 0; k < source.size(); ++k) value[k] = A.value[source[k]];
  }
  /// Of U, if row and column permutations are the same; else not known.
  int countNegative(int size) const {
    const auto n = static_cast<std::size_t>(size);
    std::vector<SuiteSparse_long> rows(n), columns(n);
    std::vector<double> diagonal(n);
    SuiteSparse_long isReciprocal = 0;
    umfpack_dl_get_numeric(nullptr, nullptr, nullptr, nullptr, nullptr, nullptr, rows.data(), columns.data(),
                           diagonal.data(), &isReciprocal, nullptr, numeric);
    if (rows != columns) return -1;
    return static_cast<int>(std::ranges::count_if(diagonal, [](double pivot) { return pivot < 0.0; }));
  }
};

SparseLu::SparseLu() : impl_(std::make_unique<Impl>()) {}
SparseLu::~SparseLu() = default;
SparseLu::SparseLu(SparseLu&&) noexcept = default;
SparseLu& SparseLu::operator=(SparseLu&&) noexcept = default;

bool SparseLu::factor(const SparseMatrix& A, bool symmetric) {
  const detail::OneBlasThread guard;
  Impl& m = *impl_;
  m.analyse(A, symmetric);
  m.takeValues(A);
  umfpack_dl_free_numeric(&m.numeric);
  if (!Impl::judge(umfpack_dl_numeric(m.pattern.offsets.data(), m.pattern.row.data(), m.value.data(), m.symbolic,
                                      &m.numeric, m.control.data(), m.info.data()),
                   A))
    return false;
  m.negative = symmetric ? m.countNegative(A.size) : -1;
  return true;
}

void SparseLu::solve(std::span<double> b) {
  const detail::OneBlasThread guard;
  Impl& m = *impl_;
  m.right.assign(b.begin(), b.end());
  if (umfpack_dl_solve(UMFPACK_A, m.pattern.offsets.data(), m.pattern.row.data(), m.value.data(), b.data(),
                       m.right.data(), m.numeric, m.control.data(), m.info.data()) != UMFPACK_OK)
    throw NumericalError("UMFPACK finds no memory for a solution", std::to_string(b.size()) + " unknowns",
                         "take a coarser mesh, or a machine with more memory");
}

int SparseLu::negativePivots() const { return impl_->negative; }
const char* SparseLu::name() { return package; }

}  // namespace dovetail::linalg
