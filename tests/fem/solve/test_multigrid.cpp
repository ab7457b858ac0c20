// Of builds with PETSc.
#include <gtest/gtest.h>

#include <numeric>

#include "dovetail/core/archive.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/fem/laws/plasticity.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "dovetail/fem/solve/statics.hpp"
#include "dynamics_helpers.hpp"
#include "pressed_box.hpp"
#include "solve/node_rows.hpp"

namespace dovetail::fem {
namespace {

TEST(Multigrid, EquilibriaAreThoseOfFactors) {
  struct Case {
    const char* name;
    std::shared_ptr<const PointMaterial> material;
    ElementShape shape;
    Formulation formulation;
  };
  const Case cases[] = {
      {"neo-Hookean", pointMaterial(neoHookean(1e6, 0.3, 1000.0)), ElementShape::hex8, Formulation::standard},
      {"tet10", pointMaterial(neoHookean(1e6, 0.3, 1000.0)), ElementShape::tet10, Formulation::standard},
      {"nearly incompressible", pointMaterial(neoHookean(1e6, 0.499, 1000.0)), ElementShape::hex8,
       Formulation::meanDilatation},
      {"J2", pointMaterial(J2Plasticity{1e6, 0.3, 1000.0, linearYield(2e4, 1e4)}), ElementShape::hex8,
       Formulation::meanDilatation}};
  for (const Case& one : cases) {
    SCOPED_TRACE(one.name);
    Model factors = pressed(6, one.material, one.shape, one.formulation);
    Model multigrid = pressed(6, one.material, one.shape, one.formulation);
    const StaticReport direct = solve(factors, linalg::LinearMethod::direct), report = solve(multigrid, byMultigrid);
    EXPECT_EQ(report.solver, "multigrid");
    EXPECT_GT(report.linearIterations, report.iterations);
    EXPECT_LE(report.iterations, direct.iterations + 2 * static_cast<std::int64_t>(direct.steps.size()));
    EXPECT_EQ(report.cuts, direct.cuts);
    EXPECT_LT(apart(factors, multigrid), 1e-8);
  }
}

TEST(Multigrid, MatricesThatAreNotSymmetricAreSolvedByResiduals) {
  const auto sand = pointMaterial(DruckerPrager{.youngsModulus = 1e6,
                                                .poissonRatio = 0.3,
                                                .density = 1000.0,
                                                .cohesion = 2e4,
                                                .frictionAngle = 0.5,
                                                .dilatancyAngle = 0.1});
  Model factors = pressed(6, sand), multigrid = pressed(6, sand);
  ASSERT_FALSE(factors.terms[0]->isSymmetric());
  solve(factors, linalg::LinearMethod::direct);
  EXPECT_EQ(solve(multigrid, byMultigrid).solver, "multigrid");
  EXPECT_LT(apart(factors, multigrid), 1e-8);
}

TEST(Multigrid, TiesAndPlanesAreNoHindrance) {
  for (const bool plane : {false, true}) {
    SCOPED_TRACE(plane);
    const auto make = [&] {
      Model model = pressed(5, pointMaterial(neoHookean(1e6, 0.3, 1000.0)));
      if (plane) {
        std::vector<int> all(model.nodes.X.size());
        for (std::size_t n = 0; n < all.size(); ++n) all[n] = static_cast<int>(n);
        model.constraints.hold(all, componentY);
      } else {
        model.constraints.ties.push_back({100, 0, {{101, 0, 0.5}, {102, 1, 0.5}}, 0.0, {}});
        model.constraints.ties.push_back({110, 2, {{101, 2, 1.0}}, 1e-3, {}});
      }
      return model;
    };
    Model factors = make(), multigrid = make();
    solve(factors, linalg::LinearMethod::direct);
    solve(multigrid, byMultigrid);
    EXPECT_LT(apart(factors, multigrid), 1e-8);
  }
}

TEST(Multigrid, DigitsDoNotDependOnTheNumberOfThreads) {
  const auto solved = [](int count) {
    setThreads(count);
    Model model = pressed(6, pointMaterial(neoHookean(1e6, 0.3, 1000.0)));
    solve(model, byMultigrid);
    setThreads(1);
    return model.nodes.u;
  };
  const std::vector<Vec3> one = solved(1);
  EXPECT_EQ(one, solved(2));
  EXPECT_EQ(one, solved(1));
}

/// One linear system of boxes of so many cells: iterations to 1e-8.
std::int64_t iterationsOf(int n) {
  Model model = pressed(n, pointMaterial(neoHookean(1e6, 0.3, 1000.0)));
  const DofMap dofs(model.constraints, model.nodes);
  LinearSolver solver(dofs, {.method = byMultigrid}, &model.nodes);
  linalg::BlockMatrix K = zeroTangent(model);
  model.terms[0]->addTangent(model.nodes, {}, K);
  std::vector<double> r(dofs.size(), 1.0), x(dofs.size());
  EXPECT_TRUE(solver.factor(K, true));
  solver.solve(r, x);
  return solver.iterations();
}

TEST(Multigrid, IterationsHardlyGrowWithTheMesh) {
  const std::int64_t few = iterationsOf(8), many = iterationsOf(20);
  EXPECT_LT(static_cast<double>(many), 1.5 * static_cast<double>(few));
}

TEST(Multigrid, MotionsStrainNothing) {
  Model model = pressed(3, pointMaterial(neoHookean(1e6, 0.3, 1000.0)));
  model.constraints = {};
  const DofMap dofs(model.constraints, model.nodes);
  linalg::BlockMatrix K = zeroTangent(model);
  model.terms[0]->addTangent(model.nodes, {}, K);
  const std::size_t nodes = model.nodes.X.size();
  std::vector<int> all(nodes);
  std::iota(all.begin(), all.end(), 0);
  const std::vector<std::vector<double>> modes = detail::rigidModes(model.nodes, dofs, all);
  ASSERT_EQ(modes.size(), 6u);
  for (std::size_t m = 0; m < 6; ++m) {
    std::vector<Vec3> u(nodes), f(nodes);
    for (std::size_t n = 0; n < nodes; ++n)
      for (int c = 0; c < 3; ++c) u[n][c] = modes[m][3 * n + static_cast<std::size_t>(c)];
    K.multiply(u, f);
    double largest = 0.0;
    for (const Vec3& force : f) largest = std::max(largest, norm(force));
    EXPECT_LT(largest, 1e-7) << m;  // K is of the order of 1e6 N/m
  }
}

TEST(Multigrid, ImplicitStepsGoOnFromAStateToItsTolerance) {
  const auto box = [] { return pressed(4, pointMaterial(neoHookean(1e6, 0.3, 1000.0))); };
  const ImplicitOptions options{.linear = {.method = byMultigrid}};
  Model whole = box(), part = box(), other = box();
  for (Model* model : {&whole, &part, &other}) addMass(*model);
  ImplicitIntegrator all(whole, 1e-3, options), first(part, 1e-3, options), second(other, 1e-3, options);
  all.run(6);
  first.run(3);
  ByteWriter state;
  first.save(state);
  ByteReader reader(state.bytes());
  second.load(reader);
  second.run(3);
  EXPECT_LT(apart(whole, other), 1e-8);
}

}  // namespace
}  // namespace dovetail::fem
