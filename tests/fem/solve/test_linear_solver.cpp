#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/fem/solve/linear_solver.hpp"
#include "solid_helpers.hpp"

namespace dovetail::fem {
namespace {

/// A box whose nodes at z = 0 are held, with ties among the others.
Model tiedModel(bool ties) {
  Model model = solidScene({ElementShape::hex8, Formulation::standard}, true).model;
  std::vector<int> bottom;
  for (std::size_t n = 0; n < 6; ++n) bottom.push_back(static_cast<int>(n));
  model.constraints.hold(bottom);
  if (!ties) return model;
  model.constraints.ties.push_back({12, 0, {{13, 0, 0.4}, {14, 1, -0.7}}, 0.0, {}});
  model.constraints.ties.push_back({16, 2, {{13, 0, 1.5}, {2, 2, 0.3}}, 0.0, {}});
  return model;
}

Eigen::MatrixXd transformation(const DofMap& dofs) {
  Eigen::MatrixXd T(3 * dofs.nodes(), dofs.size());
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    std::vector<double> dq(dofs.size(), 0.0);
    std::vector<Vec3> u(dofs.nodes());
    dq[i] = 1.0;
    dofs.addIncrement(dq, u);
    T.col(static_cast<Eigen::Index>(i)) = flat(u);
  }
  return T;
}

linalg::BlockMatrix randomMatrix(const Model& model, unsigned seed) {
  linalg::BlockMatrix K = zeroTangent(model);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> value(-1.0, 1.0);
  for (double& entry : K.values()) entry = value(random);
  return K;
}

TEST(ReducedMatrix, IsTheCongruenceWithTheTransformation) {
  for (const bool ties : {false, true}) {
    const Model model = tiedModel(ties);
    const DofMap dofs(model.constraints, model.nodes);
    const Eigen::MatrixXd T = transformation(dofs);
    ReducedMatrix reduced(dofs);
    for (const unsigned seed : {1u, 2u})
      for (const bool symmetric : {false, true}) {
        linalg::BlockMatrix K = randomMatrix(model, seed);
        if (symmetric) K.symmetrise();
        Eigen::MatrixXd expected = T.transpose() * dense(K) * T, found = Eigen::MatrixXd::Zero(T.cols(), T.cols());
        if (symmetric) expected = Eigen::MatrixXd(expected.triangularView<Eigen::Lower>());
        const linalg::SparseMatrix& A = reduced.update(K, symmetric);
        for (std::size_t c = 0; c < dofs.size(); ++c)
          for (auto k = static_cast<std::size_t>(A.offsets[c]); k < static_cast<std::size_t>(A.offsets[c + 1]); ++k) {
            EXPECT_TRUE(k == static_cast<std::size_t>(A.offsets[c]) || A.row[k - 1] < A.row[k]);
            found(A.row[k], static_cast<Eigen::Index>(c)) = A.value[k];
          }
        EXPECT_LT((found - expected).norm(), 1e-13 * expected.norm());
      }
  }
}

/// K of the solid plus shift times the unit matrix.
linalg::BlockMatrix shifted(Model& model, double shift) {
  linalg::BlockMatrix K = tangentOf(*model.terms[0], model.nodes);
  for (int n = 0; n < static_cast<int>(K.nodes()); ++n)
    K.addBlock(n, n, std::array{shift, 0.0, 0.0, 0.0, shift, 0.0, 0.0, 0.0, shift});
  return K;
}

TEST(LinearSolver, CountsNegativePivotsAndSolvesWhateverTheSigns) {
  Model model = tiedModel(true);
  const DofMap dofs(model.constraints, model.nodes);
  const Eigen::MatrixXd T = transformation(dofs);
  LinearSolver solver(dofs);
  std::vector<double> r(dofs.size()), x(dofs.size());
  for (std::size_t i = 0; i < r.size(); ++i) r[i] = std::sin(1.0 + 3.0 * static_cast<double>(i));
  bool wasNegative = false;
  // Definite, twice indefinite, definite again: found by the analysis for indefinite ones, then by Cholesky.
  for (const double shift : {0.0, -2e5, -4e5, 0.0, 0.0}) {
    const linalg::BlockMatrix K = shifted(model, shift);
    const Eigen::MatrixXd A = T.transpose() * dense(K) * T;
    const auto negative = (Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(A).eigenvalues().array() < 0.0).count();
    ASSERT_TRUE(solver.factor(K, true));
    EXPECT_EQ(solver.negativePivots(), negative) << shift;
    EXPECT_EQ(solver.method() == linalg::SparseCholesky::name(), negative == 0 && !wasNegative) << shift;
    wasNegative = negative > 0;
    solver.solve(r, x);
    const Eigen::Map<Eigen::VectorXd> right(r.data(), A.rows()), found(x.data(), A.rows());
    EXPECT_LT((A * found - right).norm(), 1e-10 * right.norm());
  }
}

TEST(LinearSolver, SolvesWithMatricesThatAreNotSymmetric) {
  const Model model = tiedModel(true);
  const DofMap dofs(model.constraints, model.nodes);
  const Eigen::MatrixXd T = transformation(dofs);
  LinearSolver solver(dofs);
  std::vector<double> r(dofs.size(), 1.0), x(dofs.size());
  for (const unsigned seed : {3u, 4u}) {
    const linalg::BlockMatrix K = randomMatrix(model, seed);
    ASSERT_TRUE(solver.factor(K, false));
    EXPECT_EQ(solver.negativePivots(), -1);
    solver.solve(r, x);
    const Eigen::Map<Eigen::VectorXd> right(r.data(), T.cols()), found(x.data(), T.cols());
    EXPECT_LT((T.transpose() * dense(K) * T * found - right).norm(), 1e-9 * right.norm());
  }
}

TEST(LinearSolver, SingularMatricesAreReported) {
  const Model model = tiedModel(false);
  const DofMap dofs(model.constraints, model.nodes);
  LinearSolver solver(dofs);
  const linalg::BlockMatrix zero = zeroTangent(model);
  EXPECT_FALSE(solver.factor(zero, true));
  EXPECT_FALSE(solver.factor(zero, false));
  EXPECT_FALSE(solver.factored());
  linalg::BlockMatrix broken = zero;
  broken.values()[9 * broken.place(10, 10)] = std::nan("");
  EXPECT_FALSE(solver.factor(broken, true));
}

/// The kept analysis must not carry digits from one matrix to the next.
TEST(LinearSolver, DigitsDoNotDependOnEarlierMatricesOfThePattern) {
  Model model = tiedModel(true);
  const DofMap dofs(model.constraints, model.nodes);
  std::vector<double> r(dofs.size(), 1.0), once(dofs.size()), again(dofs.size());
  for (const bool symmetric : {true, false}) {
    LinearSolver fresh(dofs), used(dofs);
    const linalg::BlockMatrix K = symmetric ? shifted(model, -2e5) : randomMatrix(model, 5);
    ASSERT_TRUE(fresh.factor(K, symmetric));
    fresh.solve(r, once);
    ASSERT_TRUE(used.factor(symmetric ? shifted(model, -4e5) : randomMatrix(model, 6), symmetric));
    ASSERT_TRUE(used.factor(K, symmetric));
    used.solve(r, again);
    EXPECT_EQ(once, again);
  }
}

TEST(LinearSolver, IteratesWhereFactorsWouldBeLargerThanAllowed) {
  Model model = tiedModel(true);
  const DofMap dofs(model.constraints, model.nodes);
  const linalg::BlockMatrix K = shifted(model, 1e6);
  std::vector<double> r(dofs.size()), directly(dofs.size()), x(dofs.size());
  for (std::size_t i = 0; i < r.size(); ++i) r[i] = std::sin(1.0 + 3.0 * static_cast<double>(i));
  LinearSolver direct(dofs);
  const linalg::LinearForecast factors = direct.forecast(K, true);
  ASSERT_TRUE(direct.factor(K, true));
  direct.solve(r, directly);
  EXPECT_EQ(direct.method(), linalg::SparseCholesky::name());
  EXPECT_EQ(factors.method, linalg::LinearMethod::direct);
  EXPECT_EQ(factors.bytes, factors.factors);
  for (const double fraction : {0.99, 1.0}) {
    LinearSolver solver(dofs, {.largestFactors = fraction * factors.bytes, .relativeTolerance = 1e-13});
    const linalg::LinearForecast forecast = solver.forecast(K, true);
    ASSERT_TRUE(solver.factor(K, true));
    EXPECT_EQ(solver.iterates(), fraction < 1.0);
    EXPECT_EQ(forecast.method,
              fraction < 1.0 ? linalg::LinearMethod::conjugateGradients : linalg::LinearMethod::direct);
    EXPECT_EQ(forecast.factors, factors.bytes);
    EXPECT_EQ(solver.method(), fraction < 1.0 ? "conjugate gradients" : linalg::SparseCholesky::name());
    solver.solve(r, x);
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(x[i], directly[i], 1e-11 * std::abs(directly[0]));
  }
  EXPECT_EQ(direct.forecast(K, false).method, linalg::LinearMethod::direct);  // whatever the size
}

}  // namespace
}  // namespace dovetail::fem
