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

}  // namespace
}  // namespace dovetail::fem
