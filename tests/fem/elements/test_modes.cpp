#include <gtest/gtest.h>

#include "solid_helpers.hpp"

namespace dovetail::fem {
namespace {

/// Eigenvalues of the tangent of one brick at rest over the largest, ascending.
Eigen::VectorXd spectrum(Formulation formulation, double nu, bool distorted, unsigned seed) {
  const SolidScene brick =
      sceneOf(testMesh({1, 1, 1}, distorted, seed), formulation, StVenantKirchhoff{1.0e6, nu, 1.0});
  const Eigen::MatrixXd K = dense(tangentOf(*brick.solid, brick.model.nodes));
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(K, Eigen::EigenvaluesOnly);
  return solver.eigenvalues() / solver.eigenvalues()[23];
}

TEST(Modes, ExactlyTheSixRigidMotionsAreFreeOfEnergy) {
  for (const Formulation formulation : brickFormulations)
    for (const double nu : {0.0, 0.3, 0.45})
      for (const bool distorted : {false, true})
        for (const unsigned seed : {1u, 2u, 3u}) {
          const Eigen::VectorXd values = spectrum(formulation, nu, distorted, seed);
          EXPECT_LT(values.head(6).cwiseAbs().maxCoeff(), 1e-14);
          EXPECT_GT(values[6], 1e-3);
        }
}

TEST(Modes, OnlyOneModeOfAssumedStressStiffensTowardsIncompressibility) {
  // Standard bricks have seven modes that change the volume somewhere; one that does not lock has the uniform one only.
  const Eigen::VectorXd hybrid = spectrum(Formulation::assumedStress, 0.499999, false, 1);
  const Eigen::VectorXd standard = spectrum(Formulation::standard, 0.499999, false, 1);
  EXPECT_LT(hybrid[22], 1e-4);
  EXPECT_GT(standard[17], 1e-2);
}

}  // namespace
}  // namespace dovetail::fem
