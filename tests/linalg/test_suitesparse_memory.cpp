#include <SuiteSparse_config.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "dovetail/core/error.hpp"
#include "dovetail/linalg/sparse.hpp"

namespace dovetail::linalg {
namespace {

constexpr std::size_t largest = 10000;  // bytes

void* scarce(std::size_t bytes) { return bytes > largest ? nullptr : std::malloc(bytes); }

/// While it lives, SuiteSparse gets no large blocks.
class ScarceMemory {
public:
  ScarceMemory() { setMalloc(&scarce); }
  ~ScarceMemory() { setMalloc(&std::malloc); }
  ScarceMemory(const ScarceMemory&) = delete;
  ScarceMemory& operator=(const ScarceMemory&) = delete;

private:
  static void setMalloc(void* (*function)(std::size_t)) {
#if SUITESPARSE_MAIN_VERSION >= 7
    SuiteSparse_config_malloc_func_set(function);
#else
    SuiteSparse_config.malloc_func = function;
#endif
  }
};

/// The lower triangle, or all, of a matrix without zeros.
SparseMatrix full(int size, double diagonal, bool lower) {
  SparseMatrix A;
  A.size = size;
  for (int column = 0; column < size; ++column) {
    for (int row = lower ? column : 0; row < size; ++row) {
      A.row.push_back(row);
      A.value.push_back(row == column ? diagonal : 1.0);
    }
    A.offsets.push_back(static_cast<int>(A.row.size()));
  }
  return A;
}

TEST(SparseCholesky, LackOfMemoryIsNoVerdictOnTheMatrix) {
  SparseCholesky cholesky;
  const SparseMatrix A = full(100, 200.0, true);
  {
    const ScarceMemory scarceMemory;
    EXPECT_THROW(cholesky.factor(A), FactorMemoryError);
  }
  EXPECT_TRUE(cholesky.factor(A));
}

TEST(SparseLu, LackOfMemoryIsNoVerdictOnTheMatrix) {
  SparseLu lu;
  for (const bool symmetric : {false, true}) {
    const SparseMatrix A = full(100, 200.0, symmetric);
    {
      const ScarceMemory scarceMemory;
      EXPECT_THROW(lu.factor(A, symmetric), FactorMemoryError);
    }
    EXPECT_TRUE(lu.factor(A, symmetric));
  }
}

}  // namespace
}  // namespace dovetail::linalg
