#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "dovetail/linalg/multifrontal_lu.hpp"

namespace dovetail::linalg {
namespace {

/// The same parts, added to both.
struct Sum {
  std::vector<int> first;
  MultifrontalLu sparse;
  Eigen::MatrixXd dense;

  Sum(std::vector<int> from, int last)
      : first(from), sparse(from, last), dense(Eigen::MatrixXd::Zero(from.back(), from.back())) {}
  void add(int a, int b, const Eigen::MatrixXd& part) {
    std::vector<int> unknowns;
    for (const int node : {a, b})
      for (int u = node < 0 ? 0 : first[node]; u < (node < 0 ? 0 : first[node + 1]); ++u) unknowns.push_back(u);
    for (std::size_t r = 0; r < unknowns.size(); ++r)
      for (std::size_t c = 0; c < unknowns.size(); ++c) dense(unknowns[r], unknowns[c]) += part(r, c);
    sparse.add(a, b, {part.data(), static_cast<std::size_t>(part.size())});
  }
};

Eigen::MatrixXd randomMatrix(std::mt19937& random, Eigen::Index rows, Eigen::Index columns) {
  std::uniform_real_distribution<double> value(-1.0, 1.0);
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return value(random); });
}

/// A lattice of nodes of three unknowns, each coupled with the next and with the one above, and one of four with some.
Sum lattice(int wide, int last) {
  std::vector<int> first{0};
  for (int k = 0; k < wide * wide; ++k) first.push_back(first.back() + 3);
  first.push_back(first.back() + 4);
  Sum sum(first, last);
  std::mt19937 random(3);
  for (int k = 0; k < wide * wide; ++k) {
    sum.add(k, -1, 8.0 * Eigen::MatrixXd::Identity(3, 3));
    if (k % wide + 1 < wide) sum.add(k, k + 1, randomMatrix(random, 6, 6));
    if (k + wide < wide * wide) sum.add(k + wide, k, randomMatrix(random, 6, 6));
    if (k % 7 == 0) sum.add(k, wide * wide, randomMatrix(random, 7, 7));
  }
  sum.add(5, 5, randomMatrix(random, 6, 6));
  return sum;
}

TEST(MultifrontalLu, SolvesAsADenseFactorisationDoes) {
  for (const int last : {-1, 81}) {
    Sum sum = lattice(9, last);
    ASSERT_TRUE(sum.sparse.factor());
    std::mt19937 random(4);
    const Eigen::MatrixXd b = randomMatrix(random, sum.dense.rows(), 3);
    Eigen::MatrixXd x = b;
    ASSERT_TRUE(sum.sparse.solve({x.data(), static_cast<std::size_t>(x.size())}, 3));
    EXPECT_LT((sum.dense * x - b).norm(), 1e-12 * b.norm());
    EXPECT_LT((x - sum.dense.partialPivLu().solve(b)).norm(), 1e-11 * x.norm());
  }
}

TEST(MultifrontalLu, SingularMatricesAreReported) {
  Sum sum({0, 2, 4}, -1);
  sum.add(0, 1, Eigen::MatrixXd::Ones(4, 4));
  EXPECT_FALSE(sum.sparse.factor());
}

}  // namespace
}  // namespace dovetail::linalg
