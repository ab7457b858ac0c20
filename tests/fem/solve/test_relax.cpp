#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/fem/solve/relax.hpp"
#include "dynamics_helpers.hpp"

namespace dovetail::fem {
namespace {

/// A cantilever under a force that bends it by about its own length over five.
struct Cantilever {
  SolidMesh mesh = boxOf(ElementShape::hex8, {1, 2, 10}, {}, {0.1, 0.1, 0.5});
  Model model = makeModel(mesh);
  int tip = nodeSet(mesh, "z+")[0];

  Cantilever() {
    model.add(makeSolid(mesh, std::make_shared<PlainNeoHookean>(1e6, 1e6)));
    addMass(model);
    model.constraints.hold(nodeSet(mesh, "z-"));
    model.add(nodalForce(nodeSet(mesh, "z+"), {0.0, 10.0, 0.0}, ramp(1.0, 1.0)));
  }
  Vec3 moved() const { return model.nodes.u[static_cast<std::size_t>(tip)]; }
};

TEST(Relax, FindsTheEquilibriaOfNewtonsMethod) {
  Cantilever newton, swung;
  solveStatics(newton.model, 1.0);
  const StaticReport report = relax(swung.model, 1.0, {.rest = {.tolerance = 1e-7}, .firstStep = 0.5});
  EXPECT_GT(newton.moved().y, 0.05);
  EXPECT_LT(largestDifference(newton.model.nodes.u, swung.model.nodes.u), 1e-5 * newton.moved().y);
  EXPECT_EQ(swung.model.t, 1.0);
  EXPECT_EQ(swung.model.nodes.v, std::vector<Vec3>(swung.model.nodes.v.size()));
  EXPECT_EQ(report.factorisations, 0);
  EXPECT_EQ(report.solver, "dynamic relaxation");
  EXPECT_LT(report.iterations, 20000);
  EXPECT_LT(std::abs(report.energyResidual()), 0.1 * report.storedAfter);
}

TEST(Relax, DigitsDoNotDependOnTheNumberOfThreads) {
  Cantilever one, two;
  relax(one.model, 0.2, {.rest = {.tolerance = 1e-4}});
  setThreads(2);
  relax(two.model, 0.2, {.rest = {.tolerance = 1e-4}});
  setThreads(1);
  EXPECT_EQ(one.model.nodes.u, two.model.nodes.u);
}

TEST(Relax, PrescribedMotionAndTiesAreKept) {
  const auto shear = [](Model& model, const SolidMesh& mesh) {
    model.constraints.hold(nodeSet(mesh, "z-"));
    model.constraints.prescribe(nodeSet(mesh, "z+"), 1, [](double t) { return 0.05 * t; });
    const int a = nodeSet(mesh, "z+")[0], b = nodeSet(mesh, "z+")[1];
    model.constraints.ties.push_back({a, 0, {{b, 0, 1.0}}, 0.0, {}});
  };
  const SolidMesh mesh = boxOf(ElementShape::tet10, {1, 1, 2}, {}, {0.1, 0.1, 0.2});
  Model newton = smallBody(mesh), swung = smallBody(mesh);
  shear(newton, mesh);
  shear(swung, mesh);
  solveStatics(newton, 1.0);
  relax(swung, 1.0, {.rest = {.tolerance = 1e-8}, .firstStep = 0.5});
  EXPECT_LT(largestDifference(newton.nodes.u, swung.nodes.u), 1e-7);
}

TEST(Relax, AFailureLeavesTheLastEquilibrium) {
  Cantilever c;
  EXPECT_THROW(relax(c.model, 1.0, {.rest = {.steps = 30}, .smallestStep = 0.01}), NumericalError);
  EXPECT_EQ(c.model.t, 0.0);
  EXPECT_EQ(c.model.nodes.u, std::vector<Vec3>(c.model.nodes.u.size()));
  EXPECT_THROW(relax(c.model, 0.0), InputError);
  EXPECT_THROW(relax(c.model, 1.0, {.rest = {.tolerance = 0.0}}), InputError);
}

}  // namespace
}  // namespace dovetail::fem
