#include <algorithm>
#include <memory>
#include <numeric>

#include "dovetail/core/parallel.hpp"
#include "supernodal.hpp"

// Of BLAS and LAPACK, by columns. The factorisations of SuiteSparse stand on them.
extern "C" {
void dpotrf_(const char* triangle, const int* n, double* A, const int* strideOfA, int* info);
void dtrsm_(const char* side, const char* triangle, const char* transposed, const char* unit, const int* m,
            const int* n, const double* alpha, const double* A, const int* strideOfA, double* B, const int* strideOfB);
void dgemm_(const char* transposedA, const char* transposedB, const int* m, const int* n, const int* k,
            const double* alpha, const double* A, const int* strideOfA, const double* B, const int* strideOfB,
            const double* beta, double* C, const int* strideOfC);
}

namespace dovetail::fem::detail {

namespace {

constexpr std::size_t block = 128, tile = 256;
constexpr double one = 1.0, minusOne = -1.0;

/// Columns with their stride.
struct Block {
  double* first;
  std::size_t stride;
  Block part(std::size_t row, std::size_t column) const { return {first + column * stride + row, stride}; }
};

/// C −= A Bᵀ, m × n, over k columns.
void subtractProduct(Block A, Block B, Block C, std::size_t m, std::size_t n, std::size_t k) {
  const int rows = static_cast<int>(m), columns = static_cast<int>(n), depth = static_cast<int>(k);
  const int strideA = static_cast<int>(A.stride), strideB = static_cast<int>(B.stride),
            strideC = static_cast<int>(C.stride);
  dgemm_("N", "T", &rows, &columns, &depth, &minusOne, A.first, &strideA, B.first, &strideB, &one, C.first, &strideC);
}

/// L ← Cholesky factor of the lower triangle. @return false if there is none
bool factorDiagonal(Block L, std::size_t n) {
  const int size = static_cast<int>(n), stride = static_cast<int>(L.stride);
  int info = 0;
  dpotrf_("L", &size, L.first, &stride, &info);
  return info == 0;
}

/// B ← B L⁻ᵀ
void solveBelow(Block L, Block B, std::size_t m, std::size_t n) {
  const int rows = static_cast<int>(m), columns = static_cast<int>(n);
  const int strideL = static_cast<int>(L.stride), strideB = static_cast<int>(B.stride);
  dtrsm_("R", "L", "T", "N", &rows, &columns, &one, L.first, &strideL, B.first, &strideB);
}

/// body(begin, end) over [0, n), a tile at a time and one after the other: a serial BLAS, OpenBLAS's for one, keeps its
/// buffers in places that threads would share.
template <class Body>
void forTiles(std::size_t n, const Body& body) {
  for (std::size_t begin = 0; begin < n; begin += tile) body(begin, std::min(begin + tile, n));
}

/// Columns of L of one supernode, block by block. @param rows  at least as many as columns
bool factorPanel(Block L, std::size_t rows, std::size_t columns) {
  for (std::size_t j = 0; j < columns; j += block) {
    const std::size_t n = std::min(block, columns - j);
    if (j > 0)
      forTiles(rows - j, [&](std::size_t begin, std::size_t end) {
        subtractProduct(L.part(j + begin, 0), L.part(j, 0), L.part(j + begin, j), end - begin, n, j);
      });
    if (!factorDiagonal(L.part(j, j), n)) return false;
    forTiles(rows - j - n, [&](std::size_t begin, std::size_t end) {
      solveBelow(L.part(j, j), L.part(j + n + begin, j), end - begin, n);
    });
  }
  return true;
}

/// C −= B Bᵀ on and below the diagonal, and somewhat above.
void subtractSquare(Block B, Block C, std::size_t rows, std::size_t columns) {
  forTiles(rows, [&](std::size_t left, std::size_t right) {
    forTiles(rows - left, [&](std::size_t begin, std::size_t end) {
      subtractProduct(B.part(left + begin, 0), B.part(left, 0), C.part(left + begin, left), end - begin, right - left,
                      columns);
    });
  });
}

class Fronts {
public:
  Fronts(const SupernodalPattern& L, const SupernodalPlan& plan, const PermutedColumns& A, double* values)
      : L_(L), plan_(plan), A_(A), values_(values), update_(L.supernodes()) {}

  bool factorise() {
    std::vector<int> place(L_.size());
    for (std::size_t s = 0; s < L_.supernodes(); ++s)
      if (!eliminate(s, place)) return false;
    return true;
  }

private:
  /// @param place  room for that of each row in the front
  bool eliminate(std::size_t s, std::vector<int>& place) {
    const std::span<const std::int64_t> rows = L_.rows(s);
    const std::size_t columns = L_.columns(s), below = rows.size() - columns;
    for (std::size_t k = 0; k < rows.size(); ++k) place[static_cast<std::size_t>(rows[k])] = static_cast<int>(k);
    const Block own{values_ + L_.firstValue[s], rows.size()};
    std::fill_n(own.first, rows.size() * columns, 0.0);
    update_[s].assign(below * below, 0.0);
    const Block rest{update_[s].data(), below};
    for (std::size_t j = 0; j < columns; ++j) {
      const auto c = static_cast<std::size_t>(L_.firstColumn[s]) + j;
      for (auto k = static_cast<std::size_t>(A_.offsets[c]); k < static_cast<std::size_t>(A_.offsets[c + 1]); ++k)
        own.first[j * own.stride + static_cast<std::size_t>(place[static_cast<std::size_t>(A_.row[k])])] = A_.value[k];
    }
    for (const std::size_t child : plan_.children[s]) add(child, place, own, columns, rest);
    if (!factorPanel(own, rows.size(), columns)) return false;
    subtractSquare(own.part(columns, 0), rest, below, columns);
    return true;
  }

  void add(std::size_t child, const std::vector<int>& place, Block own, std::size_t columns, Block rest) {
    const std::span<const std::int64_t> rows = L_.rowsBelow(child);
    std::vector<std::size_t> at(rows.size());
    for (std::size_t k = 0; k < rows.size(); ++k)
      at[k] = static_cast<std::size_t>(place[static_cast<std::size_t>(rows[k])]);
    const std::vector<double>& update = update_[child];
    parallelFor(rows.size(), tile / 8, [&](std::size_t begin, std::size_t end) {
      for (std::size_t j = begin; j < end; ++j) {
        const bool isOwn = at[j] < columns;
        double* const to =
            isOwn ? own.first + at[j] * own.stride : rest.first + (at[j] - columns) * rest.stride - columns;
        const double* const from = update.data() + j * rows.size();
        for (std::size_t k = j; k < rows.size(); ++k) to[at[k]] += from[k];
      }
    });
    update_[child] = {};
  }

  const SupernodalPattern& L_;
  const SupernodalPlan& plan_;
  const PermutedColumns& A_;
  double* values_;
  std::vector<std::vector<double>> update_;  // of the rows below each supernode, until its parent takes it
};

}  // namespace

bool factorise(const SupernodalPattern& L, const SupernodalPlan& plan, const PermutedColumns& A, double* values) {
  return Fronts(L, plan, A, values).factorise();
}

}  // namespace dovetail::fem::detail
