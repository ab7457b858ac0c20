#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/linalg/largest_eigenvalue.hpp"

namespace dovetail::linalg {
namespace {

StiffnessAndMass::Operator productWith(const Eigen::MatrixXd& A) {
  return [A](std::span<const double> x, std::span<double> y) {
    Eigen::Map<Eigen::VectorXd>(y.data(), A.rows()) = A * Eigen::Map<const Eigen::VectorXd>(x.data(), A.rows());
  };
}

/// Of a chain between masses that are coupled as those of linear elements.
TEST(LargestEigenvalue, IsNoLessThanThatOfADenseSolverAndAsClose) {
  for (const int n : {1, 2, 30, 90}) {
    Eigen::MatrixXd K = 2.0 * Eigen::MatrixXd::Identity(n, n), M = 4.0 / 6.0 * Eigen::MatrixXd::Identity(n, n);
    for (int k = 0; k + 1 < n; ++k) {
      K(k, k + 1) = K(k + 1, k) = -1.0 - 0.3 * std::sin(k);
      M(k, k + 1) = M(k + 1, k) = 1.0 / 6.0;
    }
    const double exact = Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(K, M).eigenvalues().maxCoeff();
    const double found = largestEigenvalue(
        {static_cast<std::size_t>(n), productWith(K), productWith(M), productWith(M.inverse())}, 1e-5);
    EXPECT_GE(found, exact * (1.0 - 1e-13));
    EXPECT_LE(found, exact * (1.0 + 2e-5));
  }
}

TEST(LargestEigenvalue, NumbersThatAreNotFiniteAreRefused) {
  const Eigen::MatrixXd K = std::nan("") * Eigen::MatrixXd::Identity(4, 4), M = Eigen::MatrixXd::Identity(4, 4);
  EXPECT_THROW(largestEigenvalue({4, productWith(K), productWith(M), productWith(M)}, 1e-4), NumericalError);
}

}  // namespace
}  // namespace dovetail::linalg
