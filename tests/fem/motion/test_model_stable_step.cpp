#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/motion/motion.hpp"
#include "dovetail/fem/motion/stable_step.hpp"
#include "solid_helpers.hpp"

namespace dovetail::fem {
namespace {

const StVenantKirchhoff law{1.0e8, 0.3, 1309.0};

/// 2/ω of the free components by all eigenvalues.
double denseLimit(Model& model, Solid& solid) {
  const Eigen::MatrixXd K = dense(tangentOf(solid, model.nodes));
  const DofMap dofs(model.constraints, model.nodes);
  const std::vector<int> free(dofs.freeDofs().begin(), dofs.freeDofs().end());
  Eigen::VectorXd scale(static_cast<Eigen::Index>(free.size()));
  for (std::size_t i = 0; i < free.size(); ++i)
    scale[static_cast<Eigen::Index>(i)] = 1.0 / std::sqrt(model.nodes.mass[static_cast<std::size_t>(free[i] / 3)]);
  const Eigen::MatrixXd A = scale.asDiagonal() * K(free, free) * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(A, Eigen::EigenvaluesOnly);
  return 2.0 / std::sqrt(solver.eigenvalues().tail(1)[0]);
}

void expectLimits(SolidScene scene) {
  addMass(scene.model);
  setRandomDisplacement(scene.model.nodes, 0.02, 3);
  const double exact = denseLimit(scene.model, *scene.solid);
  const StableStep bound = stableStep(scene.model);
  EXPECT_LE(bound.dt, exact * (1.0 + 1e-12));
  EXPECT_GT(bound.dt, 0.5 * exact);
  EXPECT_NEAR(assembledStableStep(scene.model, 1e-6), exact, 1e-5 * exact);
}

TEST(StableStep, TheBoundIsBelowAndLanczosAtTheLimitOfTheSpectrum) {
  for (const SolidKind& kind : allSolidKinds()) {
    SCOPED_TRACE(kind.label());
    expectLimits(solidScene(kind, true));
  }
}

TEST(StableStep, TheSameForHandWrittenKernelsSharesAndSupports) {
  for (const Formulation formulation : brickFormulations)
    for (const bool distorted : {false, true})
      for (const bool weighted : {false, true}) {
        const SolidMesh mesh = testMesh({3, 2, 2}, distorted);
        std::vector<double> fraction;
        for (const Vec3& X : mesh.X) fraction.push_back(weighted ? 0.1 + 0.8 * X.x : 1.0);
        SolidScene scene =
            sceneOf(mesh, pointMaterial(Material(law)), {.formulation = formulation, .fraction = fraction});
        fix(scene.model.nodes, nodeSet(mesh, "z-"), componentY | componentZ);
        scene.model.constraints.hold(nodeSet(mesh, "y+"), componentX);
        expectLimits(std::move(scene));
      }
}

/// One element: the bound is its limit.
TEST(StableStep, IsExactForOneElement) {
  for (const Formulation formulation : brickFormulations)
    for (const bool distorted : {false, true}) {
      SolidScene scene = sceneOf(testMesh({1, 1, 1}, distorted), formulation, law);
      addMass(scene.model);
      const double exact = denseLimit(scene.model, *scene.solid);
      EXPECT_NEAR(stableStep(scene.model).dt, exact, 1e-10 * exact);
    }
}

TEST(StableStep, IsElementSizeOverWaveSpeedForCubesWithoutPoissonEffect) {
  const SolidMesh mesh = boxOf(ElementShape::hex8, {2, 30, 2}, {-0.4, 0.0, -0.4}, {0.4, 12.0, 0.4});
  Model model = sceneOf(mesh, Formulation::standard, StVenantKirchhoff{1.0e8, 0.0, 1309.0}).model;
  addMass(model);
  const double expected = 0.4 / std::sqrt(1.0e8 / 1309.0);
  EXPECT_NEAR(expected, 1.447e-3, 5e-7);
  EXPECT_NEAR(stableStep(model).dt, expected, 1e-9 * expected);
}

/// Largest speed over the first after many explicit steps from small random velocities.
double growth(Model& model, double dt) {
  Nodes& nodes = model.nodes;
  Motion motion(model);
  std::fill(nodes.u.begin(), nodes.u.end(), Vec3{});
  setRandom(nodes.v, 1e-9, 5);
  for (std::size_t n = 0; n < nodes.v.size(); ++n)
    if (nodes.fixed[n]) nodes.v[n] = {};
  const double first = std::sqrt(motion.kineticEnergy());
  double largest = 0.0;
  for (int step = 0; step < 400; ++step) {
    motion.drift(dt);
    motion.forces(dt);
    motion.kick(dt);
    largest = std::max(largest, std::sqrt(motion.kineticEnergy()));
  }
  return largest / first;
}

TEST(StableStep, IsWhereExplicitStepsLoseTheirStability) {
  for (const Formulation formulation : brickFormulations)
    for (const bool distorted : {false, true}) {
      Model one = sceneOf(testMesh({1, 1, 1}, distorted), formulation, law).model;
      addMass(one);
      const double dt = stableStep(one).dt;
      EXPECT_LT(growth(one, 0.99 * dt), 100.0);
      EXPECT_GT(growth(one, 1.01 * dt), 1e6);
      const SolidMesh mesh = testMesh({3, 3, 2}, distorted);
      Model many = sceneOf(mesh, formulation, law).model;
      addMass(many);
      fix(many.nodes, nodeSet(mesh, "z-"));
      const double assembled = assembledStableStep(many, 1e-6);
      EXPECT_GT(assembled, stableStep(many).dt);
      EXPECT_LT(growth(many, 0.99 * assembled), 100.0);
      EXPECT_GT(growth(many, 1.01 * assembled), 1e6);
    }
}

TEST(StableStep, NamesTheSmallestElement) {
  SolidMesh mesh = boxOf(ElementShape::hex8, {4, 1, 1}, {}, {4.0, 1.0, 1.0});
  for (Vec3& X : mesh.X)
    if (X.x > 1.5 && X.x < 2.5) X.x = 2.7;
  for (const auto& material : {pointMaterial(neoHookean(1e6, 0.3, 1000.0)), pointMaterial(Material(law))}) {
    Model model = sceneOf(mesh, material, {.name = "bar"}).model;
    addMass(model);
    const StableStep limit = stableStep(model);
    EXPECT_EQ(limit.element, 2);
    EXPECT_EQ(limit.solid, "bar");
  }
  Model empty = makeModel(mesh);
  EXPECT_THROW(stableStep(empty), InputError);
}

TEST(StableStep, MissingMassIsRefused) {
  Model model = sceneOf(testMesh({1, 1, 1}, false), Formulation::standard, law).model;
  addMass(model);
  model.nodes.mass[3] = 0.0;
  EXPECT_THROW(assembledStableStep(model), InputError);
}

TEST(StableStep, TiesCountWithTheirWholeMassMatrix) {
  SolidScene scene = solidScene({ElementShape::hex8, Formulation::standard}, true);
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
