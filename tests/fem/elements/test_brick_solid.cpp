// Bricks with hand-written kernels against the same elements computed otherwise, and what couplings take.
#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "solid_helpers.hpp"

namespace dovetail::fem {
namespace {

const Material kirchhoff = StVenantKirchhoff{3e6, 0.3, 1000.0};

/// The same law without hand-written kernels.
class Plain : public PointMaterial {
public:
  explicit Plain(const Material& law) : law_(pointMaterial(law)) {}
  std::string name() const override { return "plain"; }
  double density() const override { return law_->density(); }
  bool isSymmetric() const override { return law_->isSymmetric(); }
  void evaluate(const PointBatch& batch) const override { law_->evaluate(batch); }

private:
  std::shared_ptr<const PointMaterial> law_;
};

TEST(BrickSolid, HandWrittenAndGeneralKernelsAgree) {
  for (const Material& law :
       {kirchhoff, Material(DeformedMetricHooke{3e6, 0.3, 1000.0}), Material(AxialSprings{3e6, 1000.0})})
    for (const bool weighted : {false, true}) {
      const SolidMesh mesh = testSolidMesh(ElementShape::hex8, true);
      std::vector<double> fraction;
      for (const Vec3& X : mesh.X) fraction.push_back(weighted ? 0.1 + 0.6 * X.x : 1.0);
      const SolidScene fast = sceneOf(mesh, pointMaterial(law), {.fraction = fraction}),
                       general = sceneOf(mesh, std::make_shared<Plain>(law), {.fraction = fraction});
      Nodes nodes = fast.model.nodes;
      setRandom(nodes.u, 0.05, 4);
      const Eigen::VectorXd a = flat(forcesOf(*fast.solid, nodes)), b = flat(forcesOf(*general.solid, nodes));
      EXPECT_LT((a - b).norm(), 1e-12 * b.norm());
      EXPECT_NEAR(fast.solid->energy(nodes, {}), general.solid->energy(nodes, {}),
                  1e-12 * general.solid->energy(nodes, {}));
      const Eigen::MatrixXd K = dense(tangentOf(*general.solid, nodes));
      EXPECT_LT((dense(tangentOf(*fast.solid, nodes)) - K).norm(), 1e-12 * K.norm());
    }
}

/// Conserving forces of laws with kernels do the work of the energy that the kernels report.
TEST(BrickSolid, ConservingForcesDoTheWorkOfTheEnergyOfTheKernels) {
  SolidScene scene = sceneOf(testSolidMesh(ElementShape::hex8, true), Formulation::standard, kirchhoff);
  Nodes& nodes = scene.model.nodes;
  setRandom(nodes.u, 0.03, 3);
  const std::vector<Vec3> start = nodes.u;
  const double before = scene.solid->energy(nodes, {});
  setRandom(nodes.u, 0.03, 4);
  std::vector<Vec3> f(nodes.u.size());
  ASSERT_TRUE(scene.solid->addConservingForces(nodes, start, {}, f));
  EXPECT_NEAR(flat(f).dot(flat(nodes.u) - flat(start)), before - scene.solid->energy(nodes, {}), 1e-12 * before);
}

TEST(BrickSolid, WeightedAssumedStressHasTheTangentOfItsForces) {
  const SolidMesh mesh = testMesh({1, 1, 1}, true);
  std::vector<double> fraction(8);
  for (std::size_t n = 0; n < 8; ++n) fraction[n] = 0.3 + 0.08 * static_cast<double>(n);
  SolidScene scene =
      sceneOf(mesh, pointMaterial(kirchhoff), {.formulation = Formulation::assumedStress, .fraction = fraction});
  Nodes& nodes = scene.model.nodes;
  setRandom(nodes.u, 0.05, 4);
  const Eigen::MatrixXd K = dense(tangentOf(*scene.solid, nodes));
  const std::vector<Vec3> u = nodes.u;
  const double h = 0.02;  // forces are cubic in u: with both widths the quotient is exact
  const auto forceAt = [&](std::size_t n, int c, double x) {
    nodes.u = u;
    nodes.u[n][c] += x;
    return flat(forcesOf(*scene.solid, nodes));
  };
  for (std::size_t n = 0; n < 8; ++n)
    for (int c = 0; c < 3; ++c) {
      const Eigen::VectorXd narrow = (forceAt(n, c, h) - forceAt(n, c, -h)) / (2.0 * h),
                            wide = (forceAt(n, c, 2.0 * h) - forceAt(n, c, -2.0 * h)) / (4.0 * h);
      EXPECT_LT((K.col(static_cast<int>(3 * n) + c) + (4.0 * narrow - wide) / 3.0).norm(), 1e-12 * K.norm());
    }
}

TEST(BrickSolid, AssumedStressTakesStVenantKirchhoffAlone) {
  EXPECT_THROW(sceneOf(testMesh({1, 1, 1}, true), std::make_shared<Plain>(kirchhoff),
                       {.formulation = Formulation::assumedStress}),
               InputError);
}

}  // namespace
}  // namespace dovetail::fem
