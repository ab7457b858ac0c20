#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <set>
#include <utility>

#include "../threads.hpp"
#include "dovetail/linalg/nested_dissection.hpp"

namespace dovetail::linalg {
namespace {

struct Lattice {
  SparseMatrix A;  // lower triangle
  std::vector<Vec3> point;
};

/// Positive definite: unknowns on a lattice meet those up to two places away with random strength.
Lattice randomLattice(int nx, int ny, int nz) {
  std::mt19937 random(5);
  const auto drawn = [&] { return static_cast<double>(random()) / 4294967296.0; };
  Lattice lattice;
  const int size = nx * ny * nz;
  lattice.A.size = size;
  std::vector<double> diagonal(static_cast<std::size_t>(size), 0.1);
  for (int c = 0; c < size; ++c) {
    const int i = c % nx, j = c / nx % ny, k = c / nx / ny;
    lattice.point.push_back({1.0 * i, 1.0 * j, 1.0 * k});
    lattice.A.row.push_back(c);
    lattice.A.value.push_back(0.0);
    for (int r = c + 1; r < size; ++r) {
      if (std::max({std::abs(r % nx - i), std::abs(r / nx % ny - j), std::abs(r / nx / ny - k)}) > 2) continue;
      lattice.A.row.push_back(r);
      lattice.A.value.push_back(drawn() - 0.5);
      diagonal[static_cast<std::size_t>(r)] += std::abs(lattice.A.value.back());
      diagonal[static_cast<std::size_t>(c)] += std::abs(lattice.A.value.back());
    }
    lattice.A.offsets.push_back(static_cast<int>(lattice.A.row.size()));
  }
  for (std::size_t c = 0; c < diagonal.size(); ++c) lattice.A.value[lattice.A.offsets[c]] = diagonal[c];
  return lattice;
}

std::vector<double> randomNumbers(std::size_t count) {
  std::mt19937 random(7);
  std::vector<double> numbers(count);
  for (double& number : numbers) number = static_cast<double>(random()) / 4294967296.0 - 0.5;
  return numbers;
}

double largestDifference(std::span<const double> a, std::span<const double> b) {
  double largest = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) largest = std::max(largest, std::abs(a[k] - b[k]));
  return largest;
}

/// Large enough for subtrees side by side and for loops within a supernode that threads share.
TEST(SparseCholesky, SolvesLargeMatricesWithTheSameDigitsForAnyNumberOfThreads) {
  const Lattice lattice = randomLattice(22, 20, 6);
  const auto size = static_cast<std::size_t>(lattice.A.size);
  const std::vector<int> order = nestedDissection(lattice.A, lattice.point);
  for (const bool ordered : {false, true})
    for (const int columns : {1, 2, 3, 5}) {
      const std::vector<double> x = randomNumbers(size * static_cast<std::size_t>(columns));
      std::vector<double> b;
      for (std::size_t first = 0; first < x.size(); first += size)
        for (const double value : multiplySymmetric(lattice.A, std::span(x).subspan(first, size))) b.push_back(value);
      const auto solved = [&](int threads) {
        return onThreads(threads, [&] {
          SparseCholesky cholesky;
          EXPECT_TRUE(cholesky.factor(lattice.A, ordered ? std::span<const int>(order) : std::span<const int>()));
          std::vector<double> y = b;
          cholesky.solve(y, columns);
          return y;
        });
      };
      const std::vector<double> one = solved(1);
      EXPECT_LT(largestDifference(one, x), 1e-12);
      EXPECT_EQ(one, solved(2));
      EXPECT_EQ(one, solved(4));
    }
}

TEST(SparseCholesky, LargeIndefiniteMatricesAreReported) {
  Lattice lattice = randomLattice(22, 20, 6);
  SparseCholesky cholesky;
  const int middle = lattice.A.offsets[lattice.A.size / 2];
  const double diagonal = std::exchange(lattice.A.value[middle], -1.0);
  EXPECT_FALSE(cholesky.factor(lattice.A));
  lattice.A.value[middle] = diagonal;
  EXPECT_TRUE(cholesky.factor(lattice.A));
}

/// Of a full matrix everything is known.
TEST(SparseCholesky, TellsWhatFactorsTakeBeforeTheyAreMade) {
  for (const int n : {60, 240}) {
    SparseMatrix A;
    A.size = n;
    for (int c = 0; c < n; ++c) {
      for (int r = c; r < n; ++r) {
        A.row.push_back(r);
        A.value.push_back(r == c ? 2.0 * n : 1.0);
      }
      A.offsets.push_back(static_cast<int>(A.row.size()));
    }
    SparseCholesky cholesky;
    const FactorCost cost = cholesky.analyse(A);
    const double size = n, entries = 0.5 * size * (size + 1.0);
    EXPECT_NEAR(cost.operations, size * size * size / 3.0, 0.1 * size * size * size);
    EXPECT_GE(cost.bytes, 8.0 * entries);
    EXPECT_LE(cost.bytes, 16.0 * size * size + 32.0 * entries);
  }
}

/// Entries of the factor, those of A among them, by the row structures of columns.
std::size_t entriesOfFactor(const SparseMatrix& A, std::span<const int> order) {
  const std::size_t size = order.size();
  std::vector<std::size_t> place(size);
  for (std::size_t k = 0; k < size; ++k) place[static_cast<std::size_t>(order[k])] = k;
  std::vector<std::set<std::size_t>> rows(size);
  for (std::size_t c = 0; c < size; ++c)
    for (int k = A.offsets[c]; k < A.offsets[c + 1]; ++k) {
      const std::size_t a = place[c], b = place[static_cast<std::size_t>(A.row[k])];
      rows[std::min(a, b)].insert(std::max(a, b));
    }
  std::size_t entries = 0;
  for (std::size_t c = 0; c < size; ++c) {
    entries += rows[c].size();
    if (rows[c].size() > 1) {
      const std::size_t parent = *std::next(rows[c].begin());
      rows[parent].insert(std::next(rows[c].begin()), rows[c].end());
    }
  }
  return entries;
}

TEST(NestedDissection, FactorsAreSmallerThanInTheOrderOfALattice) {
  const Lattice lattice = randomLattice(24, 20, 3);
  std::vector<int> order = nestedDissection(lattice.A, lattice.point), natural(order.size());
  std::iota(natural.begin(), natural.end(), 0);
  EXPECT_LT(entriesOfFactor(lattice.A, order), 0.6 * static_cast<double>(entriesOfFactor(lattice.A, natural)));
  std::ranges::sort(order);
  EXPECT_EQ(order, natural);
}

TEST(NestedDissection, TakesPointsThatCoincideAndRefusesMissingOnes) {
  const Lattice lattice = randomLattice(12, 10, 3);
  std::vector<int> order = nestedDissection(lattice.A, std::vector<Vec3>(lattice.point.size())), natural(order.size());
  std::ranges::sort(order);
  std::iota(natural.begin(), natural.end(), 0);
  EXPECT_EQ(order, natural);
  EXPECT_THROW(nestedDissection(lattice.A, std::span(lattice.point).first(5)), InputError);
}

}  // namespace
}  // namespace dovetail::linalg
