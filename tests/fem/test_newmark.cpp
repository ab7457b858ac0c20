#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/motion/newmark.hpp"
#include "dovetail/fem/motion/stable_step.hpp"
#include "helpers.hpp"

namespace dovetail::fem {
namespace {

struct Beam {
  Mesh mesh;
  ElementBlock block;
  Nodes nodes;
};

/// A cantilever of 1 × 1 × 5 m along z.
Beam makeBeam(ElementType type = ElementType::hex8) {
  const Mesh mesh = boxMesh({1, 1, 5}, {}, {1.0, 1.0, 5.0});
  Beam beam{mesh, makeElements(mesh, type, StVenantKirchhoff{1.0e6, 0.3, 1000.0}), makeNodes(mesh)};
  addLumpedMass(beam.block, beam.nodes);
  fix(beam.nodes, nodeSet(mesh, "z-"));
  return beam;
}

std::vector<Vec3> tipLoad(const Beam& beam, const Vec3& total) {
  std::vector<Vec3> load(beam.nodes.X.size());
  for (const int node : nodeSet(beam.mesh, "z+")) load[static_cast<std::size_t>(node)] = 0.25 * total;
  return load;
}

double work(const std::vector<Vec3>& force, const std::vector<Vec3>& after, const std::vector<Vec3>& before) {
  return flat(force).dot(flat(after) - flat(before));
}

TEST(Newmark, RestWithoutLoadStaysToTheLastBit) {
  Beam beam = makeBeam();
  NewmarkSolver solver(beam.block, beam.nodes, 0.01);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(solver.step(beam.nodes, {}).iterations, 0);
  for (std::size_t n = 0; n < beam.nodes.u.size(); ++n) {
    EXPECT_EQ(beam.nodes.u[n], Vec3{});
    EXPECT_EQ(beam.nodes.v[n], Vec3{});
  }
}

TEST(Newmark, SmallVibrationsKeepTheirEnergyAtTenTimesTheExplicitLimit) {
  for (const double share : {0.0, 0.5, 1.0})
    for (const ElementType type : bothTypes) {
      Beam beam = makeBeam(type);
      setRandom(beam.nodes.v, 1e-7, 2);
      for (const int node : nodeSet(beam.mesh, "z-")) beam.nodes.v[static_cast<std::size_t>(node)] = {};
      NewmarkSolver solver(beam.block, beam.nodes, 10.0 * stableStep(beam.block).dt, {.consistentShare = share});
      const double start = solver.kineticEnergy(beam.nodes);
      for (int i = 0; i < 200; ++i) {
        solver.step(beam.nodes, {});
        const double energy = solver.kineticEnergy(beam.nodes) + strainEnergy(beam.block, beam.nodes);
        ASSERT_NEAR(energy, start, 1e-6 * start) << "step " << i;
      }
    }
}

TEST(Newmark, SmallMotionTakesUpExactlyTheWorkOfTheLoad) {
  Beam beam = makeBeam();
  NewmarkSolver solver(beam.block, beam.nodes, 0.03, {.consistentShare = 0.3});
  double before = 0.0;
  for (int i = 0; i < 50; ++i) {
    const std::vector<Vec3> load = tipLoad(beam, 1e-3 * Vec3{std::sin(0.4 * i), 1.0, std::cos(0.9 * i)});
    const std::vector<Vec3> u = beam.nodes.u;
    solver.step(beam.nodes, load);
    const double energy = solver.kineticEnergy(beam.nodes) + strainEnergy(beam.block, beam.nodes);
    EXPECT_NEAR(energy - before, work(load, beam.nodes.u, u), 1e-6 * energy);
    before = energy;
  }
}

/// Tip motion at t = 0.4 s of a large smooth swing; the load is the mean over each step.
Vec3 swing(double dt, bool implicit, double share = 0.0) {
  Beam beam = makeBeam();
  NewmarkSolver solver(beam.block, beam.nodes, dt, {.consistentShare = share});
  const double rate = 0.5 * std::numbers::pi / 0.4;
  const int steps = static_cast<int>(std::lround(0.4 / dt));
  for (int i = 0; i < steps; ++i) {
    const double t = i * dt;
    // ∫ sin²(rate t) dt over the step, divided by it.
    const double mean = 0.5 - (std::sin(2.0 * rate * (t + dt)) - std::sin(2.0 * rate * t)) / (4.0 * rate * dt);
    const std::vector<Vec3> load = tipLoad(beam, mean * Vec3{6000.0, 2000.0, 1000.0});
    if (implicit) {
      solver.step(beam.nodes, load);
      continue;
    }
    const auto force = [&] {
      beam.nodes.f = load;
      addInternalForces(beam.block, beam.nodes);
    };
    force();
    kick(beam.nodes, 0.5 * dt);
    drift(beam.nodes, dt);
    force();
    kick(beam.nodes, 0.5 * dt);
  }
  return beam.nodes.u.back();
}

TEST(Newmark, IsOfSecondOrderInTime) {
  for (const double share : {0.0, 1.0}) {
    const Vec3 fine = swing(0.4 / 2560, true, share);
    const double coarse = norm(swing(0.4 / 160, true, share) - fine), half = norm(swing(0.4 / 320, true, share) - fine);
    EXPECT_GT(norm(fine), 0.15);
    EXPECT_NEAR(std::log2(coarse / half), 2.0, 0.1);
  }
}

TEST(Newmark, AgreesWithExplicitStepsAsBothAreRefined) {
  const double coarse = norm(swing(0.4 / 160, true) - swing(0.4 / 160, false));
  const double half = norm(swing(0.4 / 320, true) - swing(0.4 / 320, false));
  EXPECT_NEAR(std::log2(coarse / half), 2.0, 0.1);
  EXPECT_LT(half, 1e-4);
}

TEST(Newmark, ReportsTheForceThatIsLeftOver) {
  Beam beam = makeBeam();
  NewmarkSolver solver(beam.block, beam.nodes, 0.02);
  const std::vector<Vec3> load = tipLoad(beam, {100.0, 0.0, 0.0});
  const NewmarkReport report = solver.step(beam.nodes, load);
  EXPECT_GT(report.iterations, 0);
  EXPECT_EQ(report.factorisations, 1);
  EXPECT_EQ(solver.stepsDone(), 1);
  Nodes expected = beam.nodes;
  expected.f = load;
  addInternalForces(beam.block, expected);
  EXPECT_LT((flat(expected.f) - flat(beam.nodes.f)).norm(), 1e-9);
}

TEST(Newmark, TheFactorisationIsKeptWhileItConverges) {
  Beam beam = makeBeam();
  NewmarkSolver solver(beam.block, beam.nodes, 0.002);
  for (int i = 0; i < 20; ++i) solver.step(beam.nodes, tipLoad(beam, {100.0, 0.0, 0.0}));
  EXPECT_EQ(solver.factorisationsDone(), 1);
}

TEST(Newmark, ASolverThatWasResetStepsLikeANewOne) {
  Beam beam = makeBeam();
  const std::vector<Vec3> load = tipLoad(beam, {3000.0, 0.0, 0.0});
  NewmarkSolver solver(beam.block, beam.nodes, 0.01);
  for (int i = 0; i < 10; ++i) solver.step(beam.nodes, load);
  Nodes copy = beam.nodes;
  NewmarkSolver other(beam.block, copy, 0.01);
  solver.reset();
  for (int i = 0; i < 3; ++i) {
    solver.step(beam.nodes, load);
    other.step(copy, load);
  }
  EXPECT_TRUE(copy.u == beam.nodes.u);
  EXPECT_TRUE(copy.v == beam.nodes.v);
}

TEST(Newmark, HeldComponentsFollowTheirVelocity) {
  Beam beam = makeBeam();
  for (const int node : nodeSet(beam.mesh, "z-")) beam.nodes.v[static_cast<std::size_t>(node)].x = 0.5;
  NewmarkSolver solver(beam.block, beam.nodes, 0.01);
  for (int i = 0; i < 10; ++i) solver.step(beam.nodes, {});
  for (const int node : nodeSet(beam.mesh, "z-")) {
    EXPECT_NEAR(beam.nodes.u[static_cast<std::size_t>(node)].x, 0.05, 1e-15);
    EXPECT_EQ(beam.nodes.u[static_cast<std::size_t>(node)].z, 0.0);
    EXPECT_EQ(beam.nodes.v[static_cast<std::size_t>(node)].x, 0.5);
  }
  EXPECT_GT(beam.nodes.u[4].x, 1e-3);  // one brick away
}

TEST(Newmark, FailureSaysWhereAndLeavesTheStateAlone) {
  Beam beam = makeBeam();
  NewmarkSolver solver(beam.block, beam.nodes, 0.5, {.maxIterations = 3});
  setRandom(beam.nodes.v, 0.01, 4);
  const Nodes before = beam.nodes;
  try {
    solver.step(beam.nodes, tipLoad(beam, {1.0e5, 0.0, 0.0}));
    FAIL();
  } catch (const NumericalError& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("step 0"), std::string::npos) << what;
    EXPECT_NE(what.find("iteration"), std::string::npos);
    EXPECT_NE(what.find("residual"), std::string::npos);
  }
  EXPECT_TRUE(beam.nodes.u == before.u);
  EXPECT_TRUE(beam.nodes.v == before.v);
}

TEST(Newmark, ConvergesWithTheUnsymmetricTangentOfTheDeformedMetric) {
  const Mesh mesh = boxMesh({1, 1, 5}, {}, {1.0, 1.0, 5.0});
  const ElementBlock block = makeElements(mesh, ElementType::hex8, DeformedMetricHooke{1.0e6, 0.3, 1000.0});
  Nodes nodes = makeNodes(mesh);
  addLumpedMass(block, nodes);
  fix(nodes, nodeSet(mesh, "z-"));
  std::vector<Vec3> load(nodes.X.size());
  for (const int node : nodeSet(mesh, "z+")) load[static_cast<std::size_t>(node)].x = 750.0;
  NewmarkSolver solver(block, nodes, 0.02);
  for (int i = 0; i < 20; ++i) EXPECT_LT(solver.step(nodes, load).iterations, 15);
}

TEST(Newmark, BadInputIsRefused) {
  Beam beam = makeBeam();
  EXPECT_THROW(NewmarkSolver(beam.block, beam.nodes, 0.0), InputError);
  EXPECT_THROW(NewmarkSolver(beam.block, beam.nodes, 0.1, {.consistentShare = 1.5}), InputError);
  EXPECT_THROW(NewmarkSolver(beam.block, beam.nodes, 0.1, {.maxIterations = 0}), InputError);
  NewmarkSolver solver(beam.block, beam.nodes, 0.1);
  EXPECT_THROW(solver.step(beam.nodes, std::vector<Vec3>(3)), InputError);
  beam.nodes.mass.back() = 0.0;
  EXPECT_THROW(NewmarkSolver(beam.block, beam.nodes, 0.1), InputError);
}

}  // namespace
}  // namespace dovetail::fem
