// Patch tests of bricks with hand-written kernels: a state of constant strain is in equilibrium on any mesh, and its
// energy is that of the material. (test_solid.cpp, test_convergence.cpp: all other elements.)
#include <gtest/gtest.h>

#include <algorithm>

#include "dovetail/fem/solve/statics.hpp"
#include "solid_helpers.hpp"

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

bool isInside(const SolidMesh& mesh, std::size_t node) {
  const std::vector<int>& skin = nodeSet(mesh, "skin");
  return !std::binary_search(skin.begin(), skin.end(), static_cast<int>(node));
}

void checkEquilibrium(Formulation formulation, const Eigen::Matrix3d& F, double nu, double tolerance) {
  const SolidMesh mesh = testMesh({3, 3, 3}, true);
  SolidScene scene = sceneOf(mesh, formulation, StVenantKirchhoff{young, nu, 1.0});
  setAffine(scene.model.nodes, F, {0.3, -0.1, 0.2});
  const std::vector<Vec3> f = forcesOf(*scene.solid, scene.model.nodes);
  double scale = 0.0;
  for (const Vec3& force : f) scale = std::max(scale, norm(force));
  for (std::size_t n = 0; n < f.size(); ++n)
    if (isInside(mesh, n)) {
      EXPECT_LT(norm(f[n]), tolerance * scale);
    }
  const double expected = energyDensity(F, nu) * volumeOf(scene);
  EXPECT_NEAR(scene.solid->energy(scene.model.nodes, {}), expected, tolerance * expected);
}

TEST(Patch, ConstantStrainIsInEquilibriumOnDistortedBricks) {
  for (const Formulation formulation : brickFormulations)
    for (const double nu : {0.0, 0.3}) {
      checkEquilibrium(formulation, finiteStrain(), nu, 1e-12);
      checkEquilibrium(formulation, smallStrain(), nu, 1e-8);  // 1e-6 of strain is known to 1e-10 in double precision
    }
}

TEST(Patch, TheBoundaryDeterminesTheInterior) {
  for (const Formulation formulation : brickFormulations) {
    const SolidMesh mesh = testMesh({2, 3, 2}, true, 7);
    Model model = sceneOf(mesh, formulation, StVenantKirchhoff{young, 0.3, 1.0}).model;
    Nodes& nodes = model.nodes;
    setAffine(nodes, finiteStrain());
    const std::vector<Vec3> exact = nodes.u;
    std::mt19937 random(3);
    for (std::size_t n = 0; n < nodes.u.size(); ++n)
      if (isInside(mesh, n)) nodes.u[n] += randomVec3(random, 0.03);
    fix(nodes, nodeSet(mesh, "skin"));
    solveStatics(model, 1.0, {.newton = {.relativeTolerance = 1e-13}, .firstStep = 1.0});
    for (std::size_t n = 0; n < nodes.u.size(); ++n) EXPECT_LT(norm(nodes.u[n] - exact[n]), 1e-13);
  }
}

TEST(Patch, StressIsUniformInEveryElement) {
  for (const Formulation formulation : brickFormulations) {
    SolidMesh mesh = testMesh({2, 2, 2}, true, 5);
    const Material law = StVenantKirchhoff{young, 0.3, 2.0};
    SolidScene scene = sceneOf(mesh, formulation, law);
    setAffine(scene.model.nodes, finiteStrain());
    const std::vector<double> energies = scene.solid->elementEnergies(scene.model.nodes, {});
    ASSERT_EQ(energies.size(), 8u);
    for (int e = 0; e < 8; ++e) {
      mesh.elementSets["one"] = {e};
      const SolidScene one = sceneOf(mesh, pointMaterial(law), {.formulation = formulation, .elementSet = "one"});
      EXPECT_NEAR(energies[static_cast<std::size_t>(e)] / volumeOf(one), energyDensity(finiteStrain(), 0.3),
                  1e-12 * young);
    }
  }
}

}  // namespace
}  // namespace dovetail::fem
