// Cantilevers under a small tip load against Timoshenko's deflection FL³/(3EI) + FL/(κGA).
#include <gtest/gtest.h>

#include "dovetail/fem/solve/statics.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "solid_helpers.hpp"

namespace dovetail::fem {
namespace {

constexpr double young = 1.0e8, depth = 0.8, length = 12.0, tipForce = 1.0e-3;

/// Holds what beam theory holds: the section at y = 0 stays plane, but is free to become wider or narrower.
void clamp(const SolidMesh& mesh, Nodes& nodes) {
  const std::vector<int>& section = nodeSet(mesh, "y-");
  fix(nodes, section, componentY);
  for (const int node : section) {
    const Vec3& X = mesh.X[static_cast<std::size_t>(node)];
    if (X.x == 0.0) fix(nodes, std::array{node}, componentX);
    if (X.x == 0.0 && X.z == 0.0) fix(nodes, std::array{node}, componentZ);
  }
}

/// Mean tip deflection of the 2 × 30 × 2 beam over Timoshenko's.
double deflectionRatio(Formulation formulation, double nu) {
  const SolidMesh mesh = boxOf(ElementShape::hex8, {2, 30, 2}, {-0.4, 0.0, -0.4}, {0.4, length, 0.4});
  SolidScene beam = sceneOf(mesh, formulation, StVenantKirchhoff{young, nu, 1309.0});
  clamp(mesh, beam.model.nodes);
  const double area = depth * depth, inertia = area * area / 12.0;
  beam.model.add(deadTraction(mesh, faceSet(mesh, "y+"), {0.0, 0.0, tipForce / area}));
  solveStatics(beam.model, 1.0, {.firstStep = 1.0});
  double tip = 0.0;
  for (const int node : nodeSet(mesh, "y+")) tip += beam.model.nodes.u[static_cast<std::size_t>(node)].z / 9.0;
  const double shearModulus = young / (2.0 * (1.0 + nu));
  const double timoshenko = tipForce * length * length * length / (3.0 * young * inertia) +
                            tipForce * length / (5.0 / 6.0 * shearModulus * area);
  return tip / timoshenko;
}

TEST(Beam, TwoFullyIntegratedBricksThroughTheDepthAreAnEighthTooStiff) {
  EXPECT_NEAR(1.0 / deflectionRatio(Formulation::standard, 0.0), 1.125, 0.002);
}

TEST(Beam, BricksOfAssumedStressBendAsTimoshenkoSays) {
  EXPECT_NEAR(deflectionRatio(Formulation::assumedStress, 0.0), 1.0, 0.005);
}

TEST(Beam, BricksOfAssumedStressDoNotLockNearIncompressibility) {
  EXPECT_NEAR(deflectionRatio(Formulation::assumedStress, 0.3), 1.0, 0.01);
  EXPECT_NEAR(deflectionRatio(Formulation::assumedStress, 0.4999), 1.0, 0.02);
  EXPECT_LT(deflectionRatio(Formulation::standard, 0.4999), 0.65);
}

}  // namespace
}  // namespace dovetail::fem
