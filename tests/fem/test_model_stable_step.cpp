#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/fem/motion/stable_step.hpp"
#include "solid_helpers.hpp"

namespace dovetail::fem {
namespace {

double largestFrequency(Model& model, Solid& solid) {
  const Eigen::MatrixXd K = dense(tangentOf(solid, model.nodes));
  Eigen::VectorXd scale(K.rows());
  for (Eigen::Index i = 0; i < scale.size(); ++i)
    scale[i] = 1.0 / std::sqrt(model.nodes.mass[static_cast<std::size_t>(i / 3)]);
  const Eigen::MatrixXd A = scale.asDiagonal() * K * scale.asDiagonal();
  return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(A).eigenvalues().tail(1)[0]);
}

TEST(ModelStableStep, TheBoundIsBelowAndLanczosAtTheLimitOfTheSpectrum) {
  for (const SolidKind& kind : allSolidKinds()) {
    SCOPED_TRACE(kind.label());
    SolidScene scene = solidScene(kind, true);
    addMass(scene.model);
    setRandom(scene.model.nodes.u, 0.02, 3);
    const double exact = 2.0 / largestFrequency(scene.model, *scene.solid);
    const ModelStableStep bound = stableStep(scene.model);
    EXPECT_LE(bound.dt, exact * (1.0 + 1e-12));
    EXPECT_GT(bound.dt, 0.5 * exact);
    EXPECT_NEAR(assembledStableStep(scene.model, 1e-6), exact, 1e-5 * exact);
  }
}

TEST(ModelStableStep, NamesTheSmallestElement) {
  SolidMesh mesh = boxOf(CellShape::hex8, {4, 1, 1}, {}, {4.0, 1.0, 1.0});
  for (Vec3& X : mesh.X)
    if (X.x > 1.5 && X.x < 2.5) X.x = 2.7;
  Model model = makeModel(mesh);
  model.add(makeSolid(mesh, pointMaterial(neoHookean(1e6, 0.3, 1000.0)), {.name = "bar"}));
  addMass(model);
  const ModelStableStep limit = stableStep(model);
  EXPECT_EQ(limit.element, 2);
  EXPECT_EQ(limit.solid, "bar");
  // A stiff spring shows in the assembled limit only.
  Model empty = makeModel(mesh);
  EXPECT_THROW(stableStep(empty), InputError);
}

TEST(ModelStableStep, TiesCountWithTheirWholeMassMatrix) {
  SolidScene scene = solidScene({CellShape::hex8, Formulation::standard}, true);
  Model& model = scene.model;
  addMass(model);
  for (int c = 0; c < 3; ++c) {
    model.constraints.ties.push_back({3, c, {{4, c, 0.5}, {5, c, 0.5}}, 0.0, {}});
    model.constraints.ties.push_back({13, c, {{12, c, 1.3}, {14, c, -0.3}}, 0.0, {}});  // a factor below zero
  }
  const DofMap dofs(model.constraints, model.nodes);
  Eigen::MatrixXd T(3 * dofs.nodes(), dofs.size());
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    std::vector<double> dq(dofs.size(), 0.0);
    std::vector<Vec3> u(dofs.nodes());
    dq[i] = 1.0;
    dofs.addIncrement(dq, u);
    T.col(static_cast<Eigen::Index>(i)) = flat(u);
  }
  Eigen::VectorXd mass(T.rows());
  for (Eigen::Index i = 0; i < mass.size(); ++i) mass[i] = model.nodes.mass[static_cast<std::size_t>(i / 3)];
  const Eigen::MatrixXd K = T.transpose() * dense(tangentOf(*scene.solid, model.nodes)) * T,
                        M = T.transpose() * mass.asDiagonal() * T;
  const double exact =
      2.0 / std::sqrt(Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(K, M).eigenvalues().tail(1)[0]);
  const double found = assembledStableStep(model, 1e-6);
  EXPECT_LE(found, exact);
  EXPECT_GT(found, (1.0 - 2e-6) * exact);
}

}  // namespace
}  // namespace dovetail::fem
