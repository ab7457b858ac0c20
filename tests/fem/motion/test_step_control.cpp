// Explicit steps that follow the solid.
#include <gtest/gtest.h>

#include <numbers>
#include <sstream>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/motion/stable_step.hpp"
#include "dynamics_helpers.hpp"

namespace dovetail::fem {
namespace {

constexpr double side = 0.1, crush = 0.8, duration = 0.2;  // m, of the height, s

SolidMesh cube(ElementShape shape = ElementShape::hex8) { return boxOf(shape, {2, 2, 2}, {}, {side, side, side}); }

/// A neo-Hookean cube, pressed to a fifth of its height and let go again; it may slide on its plates.
Model pressed(const SolidMesh& mesh) {
  Model model = makeModel(mesh);
  model.add(makeSolid(mesh, std::make_shared<PlainNeoHookean>(1e6, 1e6)));
  addMass(model);
  fix(model.nodes, std::array{nodeSet(mesh, "z-")[0]}, componentX | componentY);
  fix(model.nodes, nodeSet(mesh, "z-"), componentZ);
  model.constraints.prescribe(nodeSet(mesh, "z+"), 2, [](double t) {
    return -0.5 * crush * side * (1.0 - std::cos(2.0 * std::numbers::pi * t / duration));
  });
  return model;
}

double heightOf(const Model& model) {
  double top = -1.0;
  for (std::size_t n = 0; n < model.nodes.X.size(); ++n) top = std::max(top, model.nodes.X[n].z + model.nodes.u[n].z);
  return top;
}

double energyOf(const ExplicitIntegrator& integrator, const std::string& channel) {
  for (const auto& c : integrator.ledger().channels())
    if (c.name == channel) return c.joules;
  return 0.0;
}

TEST(StepControl, ACrushedBlockNeedsShorterStepsAndGetsThem) {
  const SolidMesh mesh = cube();
  Model fixed = pressed(mesh);
  const double first = 0.9 * stableStep(fixed).dt;
  ExplicitIntegrator plain(fixed, first);
  EXPECT_THROW(plain.run(static_cast<std::int64_t>(0.5 * duration / first)), NumericalError);

  Model model = pressed(mesh);
  ExplicitIntegrator integrator(model, 2.0 * first, {.safety = 0.9});
  integrator.runUntil(0.5 * duration);
  EXPECT_EQ(model.t, 0.5 * duration);
  EXPECT_NEAR(heightOf(model), (1.0 - crush) * side, 1e-12);
  const double most = energyOf(integrator, "elastic"), shortest = integrator.report().dt;
  EXPECT_LT(shortest, 0.4 * first);
  EXPECT_LT(shortest, stableStep(model).dt);
  EXPECT_LT(integrator.ledger().largestResidual(), 2e-3 * most);

  integrator.runUntil(duration);
  EXPECT_NEAR(heightOf(model), side, 1e-12);
  const DynamicsReport report = integrator.report();
  EXPECT_GT(report.dt, 0.8 * first) << "the step grows again";
  EXPECT_LT(integrator.ledger().largestResidual(), 2e-3 * most);
  EXPECT_LE(report.stepRange.shortest, shortest);
  EXPECT_GE(report.stepRange.longest, report.dt);
  EXPECT_LE(report.stepRange.longest, 2.0 * first);
  EXPECT_GE(report.stepRange.element, 0);
  EXPECT_LT(report.stepRange.element, 8);
  EXPECT_EQ(report.stepRange.solid, "elastic");
  std::ostringstream text;
  text << report;
  EXPECT_NE(text.str().find("shortest step"), std::string::npos) << text.str();
}

/// Every step is below the bound at its start.
TEST(StepControl, StepsStayBelowTheBound) {
  Model model = pressed(cube());
  ExplicitIntegrator integrator(model, 1.0, {.energyEvery = 0, .safety = 0.9});
  while (model.t < 0.6 * duration) {
    EXPECT_LT(integrator.report().dt, 0.98 * stableStep(model).dt) << model.t;
    integrator.run(7);
  }
}

TEST(StepControl, IsOfSecondOrder) {
  const SolidMesh mesh = cube(ElementShape::tet4);
  const auto endOf = [&](double safety) {
    Model model = pressed(mesh);
    ExplicitIntegrator integrator(model, 1.0, {.energyEvery = 0, .safety = safety});
    integrator.runUntil(0.3 * duration);
    return model.nodes.u;
  };
  const std::vector<Vec3> exact = endOf(0.01);
  const double coarse = largestDifference(endOf(0.4), exact), fine = largestDifference(endOf(0.1), exact);
  EXPECT_GT(coarse, 1e-9);
  EXPECT_NEAR(std::log2(coarse / fine) / 2.0, 2.0, 0.2) << coarse << " " << fine;
}

/// The step that is asked for is the longest; as long as it is shorter than the fraction of the bound nothing changes.
TEST(StepControl, ShortStepsAreAsTheyWere) {
  const SolidMesh mesh = smallMesh();
  std::vector<std::vector<Vec3>> end;
  for (const double safety : {0.0, 0.5}) {
    Model model = smallBody(mesh);
    model.add(gravity(Vec3{0, 0, -9.81}));
    fix(model.nodes, nodeSet(mesh, "x-"));
    ExplicitIntegrator integrator(model, 0.1 * crossing, {.safety = safety});
    integrator.run(500);
    end.push_back(model.nodes.u);
    EXPECT_EQ(integrator.report().dt, 0.1 * crossing);
  }
  EXPECT_EQ(end[0], end[1]);
}

TEST(StepControl, StopsWithTheElementWhenTheStepIsTooShort) {
  Model model = pressed(cube());
  const double first = stableStep(model).dt;
  ExplicitIntegrator integrator(model, first, {.safety = 0.9, .shortest = 0.5});
  try {
    integrator.runUntil(0.5 * duration);
    FAIL();
  } catch (const NumericalError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("element "), std::string::npos) << text;
    EXPECT_NE(text.find("t = "), std::string::npos) << text;
  }
  EXPECT_LT(model.t, 0.5 * duration);
}

TEST(StepControl, StatesGoOnBitwise) {
  const SolidMesh mesh = cube();
  for (const int before : {37, 300, 555}) {
    Model whole = pressed(mesh), resumed = pressed(mesh);
    const ExplicitOptions options{.energyEvery = 3, .safety = 0.8, .measureEvery = 11};
    ExplicitIntegrator one(whole, 1.0, options), two(resumed, 1.0, options);
    one.run(before);
    ByteWriter archive;
    one.save(archive);
    one.run(200);
    ByteReader reader(archive.bytes());
    two.load(reader);
    EXPECT_TRUE(reader.atEnd());
    two.run(200);
    EXPECT_EQ(whole.t, resumed.t);
    EXPECT_EQ(whole.nodes.u, resumed.nodes.u);
    EXPECT_EQ(whole.nodes.v, resumed.nodes.v);
    EXPECT_EQ(one.report().dt, two.report().dt);
    EXPECT_EQ(one.report().stepRange.shortest, two.report().stepRange.shortest);
    EXPECT_EQ(one.report().stepRange.element, two.report().stepRange.element);
    EXPECT_EQ(one.ledger().residual(), two.ledger().residual());

    Model other = pressed(mesh);
    ExplicitIntegrator plain(other, 1e-5);
    ByteReader again(archive.bytes());
    EXPECT_THROW(plain.load(again), InputError);
  }
}

TEST(StepControl, DoesNotDependOnThreads) {
  const SolidMesh mesh = boxOf(ElementShape::hex8, {12, 12, 12}, {}, {side, side, side});
  const auto endOf = [&](int threads) {
    return onThreads(threads, [&] {
      Model model = pressed(mesh);
      ExplicitIntegrator integrator(model, 1.0, {.energyEvery = 10, .safety = 0.9, .measureEvery = 5});
      integrator.run(60);
      return std::pair(model.nodes.u, model.t);
    });
  };
  EXPECT_EQ(endOf(1), endOf(4));
}

TEST(StepControl, RunsEndWhereTheyAreTold) {
  for (const double safety : {0.0, 0.9}) {
    Model model = pressed(cube());
    ExplicitIntegrator integrator(model, 1e-4, {.safety = safety});
    for (const double end : {1e-5, 1e-5, 3.3e-4, 1e-3}) {
      integrator.runUntil(end);
      EXPECT_EQ(model.t, end);
    }
    EXPECT_THROW(integrator.runUntil(5e-4), InputError);
    EXPECT_EQ(integrator.report().dt, 1e-4);
  }
}

TEST(StepControl, OptionsOutOfRangeAreRefused) {
  Model model = pressed(cube());
  EXPECT_THROW(ExplicitIntegrator(model, 1e-4, {.safety = -0.1}), InputError);
  EXPECT_THROW(ExplicitIntegrator(model, 1e-4, {.safety = 1.1}), InputError);
  EXPECT_THROW(ExplicitIntegrator(model, 1e-4, {.safety = 0.5, .measureEvery = 0}), InputError);
  EXPECT_THROW(ExplicitIntegrator(model, 1e-4, {.safety = 0.5, .shortest = -1.0}), InputError);
  Model springs = oscillator();
  EXPECT_THROW(ExplicitIntegrator(springs, 1e-4, {.safety = 0.5}), InputError);
}

}  // namespace
}  // namespace dovetail::fem
