#include <gtest/gtest.h>

#include <cmath>

#include "dovetail/linalg/sparse.hpp"

namespace dovetail::linalg {
namespace {

/// Tridiagonal matrix with the given diagonal and −1 beside it.
SparseMatrix chain(int size, double diagonal) {
  SparseMatrix A;
  A.size = size;
  for (int column = 0; column < size; ++column) {
    for (int row = std::max(0, column - 1); row <= std::min(size - 1, column + 1); ++row) {
      A.row.push_back(row);
      A.value.push_back(row == column ? diagonal : -1.0);
    }
    A.offsets.push_back(static_cast<int>(A.row.size()));
  }
  return A;
}

TEST(SparseCholesky, SolvesAndReusesItsAnalysis) {
  SparseCholesky cholesky;
  for (const double diagonal : {2.0, 3.0, 2.5}) {
    const SparseMatrix A = chain(50, diagonal);
    ASSERT_TRUE(cholesky.factor(A));
    for (int repeat = 0; repeat < 2; ++repeat) {
      std::vector<double> x(50);
      for (std::size_t i = 0; i < 50; ++i) x[i] = std::sin(static_cast<double>(i + 1));
      std::vector<double> b = multiply(A, x);
      cholesky.solve(b);
      for (std::size_t i = 0; i < 50; ++i) EXPECT_NEAR(b[i], x[i], 1e-12);
    }
  }
  ASSERT_TRUE(cholesky.factor(chain(7, 2.0)));
  std::vector<double> b = multiply(chain(7, 2.0), std::vector<double>(7, 1.0));
  cholesky.solve(b);
  for (const double value : b) EXPECT_NEAR(value, 1.0, 1e-13);
}

TEST(SparseCholesky, SolvesForSeveralRightHandSides) {
  SparseCholesky cholesky;
  const SparseMatrix A = chain(50, 2.5);
  ASSERT_TRUE(cholesky.factor(A));
  std::vector<double> b(150);
  for (std::size_t i = 0; i < 150; ++i) b[i] = std::sin(static_cast<double>(i * i));
  std::vector<double> all = b;
  cholesky.solve(all, 3);
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<double> one(b.begin() + 50 * static_cast<int>(c), b.begin() + 50 * static_cast<int>(c + 1));
    cholesky.solve(one);
    for (std::size_t i = 0; i < 50; ++i) EXPECT_NEAR(all[50 * c + i], one[i], 1e-14);
  }
}

TEST(SparseCholesky, IndefiniteMatricesAreReported) {
  SparseCholesky cholesky;
  EXPECT_FALSE(cholesky.factor(chain(20, 1.0)));
  EXPECT_FALSE(cholesky.factor(chain(20, -3.0)));
  EXPECT_TRUE(cholesky.factor(chain(20, 2.0)));
}

/// Eigenvalues of the chain are d − 2 cos(k π/21).
TEST(SparseLu, CountsTheNegativeEigenvaluesOfAChain) {
  SparseLu lu;
  for (const double diagonal : {0.1, -1.3, 1.9, 2.5}) {
    const SparseMatrix A = chain(20, diagonal);
    SparseMatrix lower;
    lower.size = A.size;
    for (std::size_t column = 0; column < 20; ++column) {
      for (auto k = static_cast<std::size_t>(A.offsets[column]); k < static_cast<std::size_t>(A.offsets[column + 1]);
           ++k)
        if (A.row[k] >= static_cast<int>(column)) lower.row.push_back(A.row[k]), lower.value.push_back(A.value[k]);
      lower.offsets.push_back(static_cast<int>(lower.row.size()));
    }
    int negative = 0;
    for (int k = 1; k <= 20; ++k) negative += diagonal - 2.0 * std::cos(k * 3.14159265358979 / 21.0) < 0.0;
    ASSERT_TRUE(lu.factor(lower, true));
    EXPECT_EQ(lu.negativePivots(), negative);
    ASSERT_TRUE(lu.factor(A, false));
    EXPECT_EQ(lu.negativePivots(), -1);
    for (const bool symmetric : {true, false}) {
      ASSERT_TRUE(lu.factor(symmetric ? lower : A, symmetric));
      std::vector<double> x(20);
      for (std::size_t i = 0; i < 20; ++i) x[i] = std::sin(static_cast<double>(i + 1));
      std::vector<double> b = multiply(A, x);
      lu.solve(b);
      for (std::size_t i = 0; i < 20; ++i) EXPECT_NEAR(b[i], x[i], 1e-12);
    }
  }
  EXPECT_FALSE(lu.factor(chain(2, 1.0), false));  // singular
}

}  // namespace
}  // namespace dovetail::linalg
