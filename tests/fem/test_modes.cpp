#include <gtest/gtest.h>

#include "helpers.hpp"

namespace dovetail::fem {
namespace {

/// Eigenvalues of the tangent of one brick at rest over the largest, ascending.
Eigen::VectorXd spectrum(ElementType type, double nu, bool distorted, unsigned seed) {
  const Mesh mesh = testMesh({1, 1, 1}, distorted, seed);
  const ElementBlock block = makeElements(mesh, type, StVenantKirchhoff{1.0e6, nu, 1.0});
  const Nodes nodes = makeNodes(mesh);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(dense(tangent(block, nodes)), Eigen::EigenvaluesOnly);
  return solver.eigenvalues() / solver.eigenvalues()[23];
}

TEST(Modes, ExactlyTheSixRigidMotionsAreFreeOfEnergy) {
  for (const ElementType type : bothTypes)
    for (const double nu : {0.0, 0.3, 0.45})
      for (const bool distorted : {false, true})
        for (const unsigned seed : {1u, 2u, 3u}) {
          const Eigen::VectorXd values = spectrum(type, nu, distorted, seed);
          EXPECT_LT(values.head(6).cwiseAbs().maxCoeff(), 1e-14);
          EXPECT_GT(values[6], 1e-3);
        }
}

TEST(Modes, OnlyOneModeOfTheHybridBrickStiffensTowardsIncompressibility) {
  // hex8 has seven modes that change the volume somewhere; a brick that does not lock has the uniform one only.
  const Eigen::VectorXd hybrid = spectrum(ElementType::hybrid8, 0.499999, false, 1);
  const Eigen::VectorXd hex = spectrum(ElementType::hex8, 0.499999, false, 1);
  EXPECT_LT(hybrid[22], 1e-4);
  EXPECT_GT(hex[17], 1e-2);
}

}  // namespace
}  // namespace dovetail::fem
