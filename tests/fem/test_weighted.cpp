// Weighted integrals: the solid's share of an overlap.
#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/motion/stable_step.hpp"
#include "helpers.hpp"

namespace dovetail::fem {
namespace {

const StVenantKirchhoff material{2e5, 0.3, 1200.0};

std::vector<double> slope(const Mesh& mesh) {
  std::vector<double> weight;
  for (const Vec3& X : mesh.X) weight.push_back(0.2 + 0.5 * X.x);
  return weight;
}

ElementBlock blockOf(const Mesh& mesh, ElementType type, std::span<const double> weight) {
  return makeElements(mesh, type, material, weight);
}

TEST(Weighted, ForcesAreMinusTheGradientOfTheEnergyAndTangentsTheirs) {
  for (const ElementType type : bothTypes)
    for (const bool distorted : {false, true}) {
      const Mesh mesh = testMesh({2, 2, 1}, distorted);
      const ElementBlock block = blockOf(mesh, type, slope(mesh));
      Nodes nodes = makeNodes(mesh);
      setRandom(nodes.u, 0.02, 3);
      clearForces(nodes);
      addInternalForces(block, nodes);
      const std::vector<Vec3> force = nodes.f;
      const SparseMatrix K = tangent(block, nodes);
      double size = 0.0;
      for (const Vec3& f : force) size = std::max(size, norm(f));
      for (const std::size_t n : {std::size_t{0}, std::size_t{4}, std::size_t{9}})
        for (int c = 0; c < 3; ++c) {
          const double u = nodes.u[n][c], step = 1e-6;
          nodes.u[n][c] = u + step;
          const double above = strainEnergy(block, nodes);
          clearForces(nodes);
          addInternalForces(block, nodes);
          const std::vector<Vec3> forceAbove = nodes.f;
          nodes.u[n][c] = u - step;
          const double below = strainEnergy(block, nodes);
          clearForces(nodes);
          addInternalForces(block, nodes);
          nodes.u[n][c] = u;
          EXPECT_NEAR(force[n][c], -(above - below) / (2.0 * step), 1e-6 * size);
          std::vector<double> unit(3 * nodes.u.size(), 0.0);
          unit[3 * n + static_cast<std::size_t>(c)] = 1.0;
          const std::vector<double> column = multiply(K, unit);
          double stiffness = 0.0;
          for (const double k : column) stiffness = std::max(stiffness, std::abs(k));
          for (std::size_t m = 0; m < nodes.u.size(); ++m)
            for (int d = 0; d < 3; ++d)
              EXPECT_NEAR(column[3 * m + static_cast<std::size_t>(d)],
                          -(forceAbove[m][d] - nodes.f[m][d]) / (2.0 * step), 1e-5 * stiffness);
        }
    }
}

TEST(Weighted, TwoSharesMakeTheWhole) {
  for (const ElementType type : bothTypes) {
    const Mesh mesh = testMesh({3, 2, 2}, type == ElementType::hex8);
    const std::vector<double> weight = slope(mesh);
    std::vector<double> rest;
    for (const double w : weight) rest.push_back(1.0 - w);
    const ElementBlock whole = blockOf(mesh, type, {}), a = blockOf(mesh, type, weight), b = blockOf(mesh, type, rest);
    Nodes nodes = makeNodes(mesh);
    Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
    F(0, 1) = 0.2;
    F(2, 2) = 1.1;
    setAffine(nodes, F);
    EXPECT_NEAR(strainEnergy(a, nodes) + strainEnergy(b, nodes), strainEnergy(whole, nodes),
                1e-12 * strainEnergy(whole, nodes));
    EXPECT_NEAR(volumeOf(a) + volumeOf(b), volumeOf(whole), 1e-12 * volumeOf(whole));
  }
}

TEST(Weighted, AUniformWeightScalesEverything) {
  const Mesh mesh = testMesh({2, 2, 2}, false);
  const std::vector<double> third(mesh.X.size(), 1.0 / 3.0);
  const ElementBlock whole = blockOf(mesh, ElementType::hex8, {}), part = blockOf(mesh, ElementType::hex8, third);
  EXPECT_EQ(part.boxes(), whole.boxes()) << "equal weights keep the fast kernel";
  Nodes nodes = makeNodes(mesh);
  setRandom(nodes.u, 0.02, 5);
  EXPECT_NEAR(strainEnergy(part, nodes), strainEnergy(whole, nodes) / 3.0, 1e-14 * strainEnergy(whole, nodes));
  EXPECT_NEAR(stableStep(part).dt, stableStep(whole).dt, 1e-10 * stableStep(whole).dt);
}

TEST(Weighted, ImpossibleWeightsAreRefused) {
  const Mesh mesh = testMesh({1, 1, 1}, false);
  std::vector<double> weight(mesh.X.size(), 0.5);
  EXPECT_THROW(blockOf(mesh, ElementType::hex8, std::span(weight).first(3)), InputError);
  for (const double bad : {-0.1, 1.1, std::nan("")}) {
    weight[2] = bad;
    EXPECT_THROW(blockOf(mesh, ElementType::hex8, weight), InputError);
  }
}

}  // namespace
}  // namespace dovetail::fem
