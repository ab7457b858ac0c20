// Patch tests: a state of constant strain is in equilibrium on any mesh, and its energy is that of the material.
#include <gtest/gtest.h>

#include <algorithm>

#include "helpers.hpp"

namespace dovetail::fem {
namespace {

constexpr double young = 2.0e5;

Eigen::Matrix3d smallStrain() {
  Eigen::Matrix3d H;
  H << 1.0, 0.3, -0.2, 0.5, -0.7, 0.4, 0.1, 0.6, 0.9;
  return Eigen::Matrix3d::Identity() + 1e-6 * H;
}

Eigen::Matrix3d finiteStrain() {
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F(0, 0) = 1.3;
  F(0, 1) = 0.4;
  F(1, 2) = -0.2;
  return F;
}

double energyDensity(const Eigen::Matrix3d& F, double nu) {
  const LameConstants lame = lameConstants(young, nu);
  const Eigen::Matrix3d E = 0.5 * (F.transpose() * F - Eigen::Matrix3d::Identity());
  return 0.5 * lame.lambda * E.trace() * E.trace() + lame.mu * E.squaredNorm();
}

bool isInside(const Mesh& mesh, std::size_t node) {
  const std::vector<int>& skin = nodeSet(mesh, "skin");
  return !std::binary_search(skin.begin(), skin.end(), static_cast<int>(node));
}

void checkEquilibrium(ElementType type, const Eigen::Matrix3d& F, double nu, double tolerance) {
  const Mesh mesh = testMesh({3, 3, 3}, true);
  const ElementBlock block = makeElements(mesh, type, StVenantKirchhoff{young, nu, 1.0});
  EXPECT_EQ(block.boxes(), 0u);
  Nodes nodes = makeNodes(mesh);
  setAffine(nodes, F, {0.3, -0.1, 0.2});
  const double energy = addInternalForces(block, nodes, true);
  double scale = 0.0;
  for (const Vec3& f : nodes.f) scale = std::max(scale, norm(f));
  for (std::size_t n = 0; n < nodes.f.size(); ++n)
    if (isInside(mesh, n)) {
      EXPECT_LT(norm(nodes.f[n]), tolerance * scale);
    }
  const double expected = energyDensity(F, nu) * volumeOf(block);
  EXPECT_NEAR(energy, expected, tolerance * expected);
}

TEST(Patch, ConstantStrainIsInEquilibriumOnDistortedBricks) {
  for (const ElementType type : bothTypes)
    for (const double nu : {0.0, 0.3}) {
      checkEquilibrium(type, finiteStrain(), nu, 1e-12);
      checkEquilibrium(type, smallStrain(), nu, 1e-8);  // 1e-6 of strain is known to 1e-10 in double precision
    }
}

TEST(Patch, TheBoundaryDeterminesTheInterior) {
  for (const ElementType type : bothTypes) {
    const Mesh mesh = testMesh({2, 3, 2}, true, 7);
    const ElementBlock block = makeElements(mesh, type, StVenantKirchhoff{young, 0.3, 1.0});
    Nodes nodes = makeNodes(mesh), exact = nodes;
    setAffine(exact, finiteStrain());
    nodes.u = exact.u;
    std::mt19937 random(3);
    for (std::size_t n = 0; n < nodes.u.size(); ++n)
      if (isInside(mesh, n)) nodes.u[n] += randomVec3(random, 0.03);
    fix(nodes, nodeSet(mesh, "skin"));
    solveStatics(block, nodes, std::vector<Vec3>(nodes.X.size()), 8);
    for (std::size_t n = 0; n < nodes.u.size(); ++n) EXPECT_LT(norm(nodes.u[n] - exact.u[n]), 1e-13);
  }
}

TEST(Patch, StressIsUniformInEveryElement) {
  for (const ElementType type : bothTypes) {
    const Mesh mesh = testMesh({2, 2, 2}, true, 5);
    const ElementBlock block = makeElements(mesh, type, StVenantKirchhoff{young, 0.3, 2.0});
    Nodes nodes = makeNodes(mesh);
    setAffine(nodes, finiteStrain());
    const std::vector<double> energies = elementEnergies(block, nodes);
    for (std::size_t e = 0; e < block.size(); ++e) {
      Mesh one{mesh.X, {mesh.elements[e]}, {}, {}};
      const double volume = volumeOf(makeElements(one, type, block.material()));
      EXPECT_NEAR(energies[e] / volume, energyDensity(finiteStrain(), 0.3), 1e-12 * young);
    }
  }
}

}  // namespace
}  // namespace dovetail::fem
