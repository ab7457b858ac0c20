// Implicit steps between kicks: a step of Newmark's average acceleration under a constant load.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/motion/implicit_motion.hpp"
#include "dovetail/fem/motion/motion.hpp"
#include "dovetail/fem/motion/stable_step.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "solid_helpers.hpp"

namespace dovetail::fem {
namespace {

struct Beam {
  SolidMesh mesh;
  Model model;
  std::shared_ptr<Solid> solid;
  double energy(const ImplicitMotion& motion) { return motion.kineticEnergy() + solid->energy(model.nodes, {}); }
};

/// A cantilever of 1 × 1 × 5 m along z.
Beam makeBeam(Formulation formulation = Formulation::standard,
              const Material& law = StVenantKirchhoff{1.0e6, 0.3, 1000.0}) {
  Beam beam{boxOf(ElementShape::hex8, {1, 1, 5}, {}, {1.0, 1.0, 5.0}), {}, {}};
  SolidScene scene = sceneOf(beam.mesh, formulation, law);
  beam.model = std::move(scene.model);
  beam.solid = scene.solid;
  addMass(beam.model);
  fix(beam.model.nodes, nodeSet(beam.mesh, "z-"));
  return beam;
}

ImplicitOptions averageAcceleration(double fraction, double tolerance = 1e-12) {
  return {.scheme = newmark(), .massFraction = fraction, .relativeTolerance = tolerance};
}

std::vector<Vec3> tipLoad(const Beam& beam, const Vec3& total) {
  std::vector<Vec3> load(beam.mesh.X.size());
  for (const int node : nodeSet(beam.mesh, "z+")) load[static_cast<std::size_t>(node)] = 0.25 * total;
  return load;
}

void pushed(ImplicitMotion& motion, const std::vector<Vec3>& load, double dt) {
  motion.kick(load, 0.5 * dt);
  motion.step(dt);
  motion.kick(load, 0.5 * dt);
}

TEST(ImplicitMotion, RestWithoutLoadStaysToTheLastBit) {
  Beam beam = makeBeam();
  ImplicitMotion motion(beam.model, averageAcceleration(1.0));
  for (int i = 0; i < 3; ++i) motion.step(0.01);
  EXPECT_EQ(motion.steps(), 3);
  EXPECT_EQ(flat(beam.model.nodes.u).norm(), 0.0);
  EXPECT_EQ(flat(beam.model.nodes.v).norm(), 0.0);
}

/// A large oscillation: the load as kicks, and as a term.
TEST(ImplicitMotion, KicksAroundAStepAreAStepUnderAConstantLoad) {
  for (const double fraction : {0.0, 0.5, 1.0}) {
    Beam kicked = makeBeam(), loaded = makeBeam();
    loaded.model.add(nodalForce(nodeSet(loaded.mesh, "z+"), {1500.0, 500.0, 250.0}));
    const std::vector<Vec3> load = tipLoad(kicked, {6000.0, 2000.0, 1000.0});
    ImplicitMotion motion(kicked.model, averageAcceleration(fraction));
    ImplicitIntegrator integrator(loaded.model, 0.02, averageAcceleration(fraction));
    for (int i = 0; i < 20; ++i) pushed(motion, load, 0.02);
    integrator.run(20);
    const Eigen::VectorXd u = flat(loaded.model.nodes.u), v = flat(loaded.model.nodes.v);
    EXPECT_GT(u.lpNorm<Eigen::Infinity>(), 0.15);
    EXPECT_LT((flat(kicked.model.nodes.u) - u).norm(), 1e-9 * u.norm());
    EXPECT_LT((flat(kicked.model.nodes.v) - v).norm(), 1e-9 * v.norm());
    EXPECT_DOUBLE_EQ(kicked.model.t, loaded.model.t);
  }
}

/// u₁ − u₀ = ½dt (v₀ + v₁) and M (v₁ − v₀) = dt f + ½dt (f₀ + f₁).
TEST(ImplicitMotion, StepsSatisfyTheirEquations) {
  Beam beam = makeBeam();
  Nodes& nodes = beam.model.nodes;
  const double dt = 0.03;
  ImplicitMotion motion(beam.model, averageAcceleration(0.4));
  const std::vector<Vec3> load = tipLoad(beam, {6000.0, 2000.0, 1000.0});
  for (int i = 0; i < 5; ++i) {
    const Eigen::VectorXd u = flat(nodes.u), v = flat(nodes.v), f = flat(forcesOf(*beam.solid, nodes));
    const std::vector<Vec3> before = nodes.v;
    pushed(motion, load, dt);
    EXPECT_LT((flat(nodes.u) - u - 0.5 * dt * (v + flat(nodes.v))).norm(), 1e-14);
    std::vector<Vec3> change(before.size()), impulse(before.size());
    for (std::size_t n = 0; n < before.size(); ++n) change[n] = nodes.v[n] - before[n];
    motion.mass().multiply(change, impulse);
    const Eigen::VectorXd expected = dt * flat(load) + 0.5 * dt * (f + flat(forcesOf(*beam.solid, nodes)));
    const Eigen::VectorXd difference = flat(impulse) - expected;
    for (const int dof : motion.dofs().freeDofs()) EXPECT_LT(std::abs(difference[dof]), 1e-9 * expected.norm());
  }
}

TEST(ImplicitMotion, SmallVibrationsKeepTheirEnergyAtTenTimesTheExplicitLimit) {
  for (const double fraction : {0.0, 0.5, 1.0})
    for (const Formulation formulation : brickFormulations) {
      Beam beam = makeBeam(formulation);
      setRandom(beam.model.nodes.v, 1e-7, 2);
      fix(beam.model.nodes, nodeSet(beam.mesh, "z-"));
      const double dt = 10.0 * stableStep(beam.model).dt;
      ImplicitMotion motion(beam.model, averageAcceleration(fraction, 1e-9));
      const double start = motion.kineticEnergy();
      for (int i = 0; i < 200; ++i) {
        motion.step(dt);
        ASSERT_NEAR(beam.energy(motion), start, 1e-6 * start) << "step " << i;
      }
    }
}

TEST(ImplicitMotion, SmallMotionTakesUpExactlyTheWorkOfTheLoad) {
  Beam beam = makeBeam();
  ImplicitMotion motion(beam.model, averageAcceleration(0.3, 1e-9));
  double before = 0.0;
  for (int i = 0; i < 50; ++i) {
    const std::vector<Vec3> load = tipLoad(beam, 1e-3 * Vec3{std::sin(0.4 * i), 1.0, std::cos(0.9 * i)});
    const Eigen::VectorXd u = flat(beam.model.nodes.u);
    pushed(motion, load, 0.03);
    const double energy = beam.energy(motion);
    EXPECT_NEAR(energy - before, flat(load).dot(flat(beam.model.nodes.u) - u), 1e-6 * energy);
    before = energy;
  }
}

/// Tip motion at t = 0.4 s of a large smooth oscillation; the load is the mean over each step.
Vec3 swing(double dt, bool implicit, double fraction = 0.0) {
  Beam beam = makeBeam();
  const double rate = 0.5 * std::numbers::pi / 0.4;
  const int steps = static_cast<int>(std::lround(0.4 / dt));
  ImplicitMotion motion(beam.model, averageAcceleration(fraction, 1e-9));
  Motion verbs(beam.model, fraction);
  std::vector<Vec3>& f = beam.model.nodes.f;
  for (int i = 0; i < steps; ++i) {
    const double t = i * dt;
    // ∫ sin²(rate t) dt over the step, divided by it.
    const double mean = 0.5 - (std::sin(2.0 * rate * (t + dt)) - std::sin(2.0 * rate * t)) / (4.0 * rate * dt);
    const std::vector<Vec3> load = tipLoad(beam, mean * Vec3{6000.0, 2000.0, 1000.0});
    if (implicit) {
      pushed(motion, load, dt);
      continue;
    }
    const auto halfKick = [&] {
      verbs.forces(dt);
      for (std::size_t n = 0; n < f.size(); ++n) f[n] += load[n];
      EXPECT_TRUE(verbs.kick(0.5 * dt));
    };
    halfKick();
    verbs.drift(dt);
    halfKick();
    EXPECT_EQ(verbs.commit(dt), 0.0);
  }
  return beam.model.nodes.u.back();
}

TEST(ImplicitMotion, IsOfSecondOrderInTime) {
  for (const double fraction : {0.0, 1.0}) {
    const Vec3 fine = swing(0.4 / 2560, true, fraction);
    const double coarse = norm(swing(0.4 / 160, true, fraction) - fine),
                 half = norm(swing(0.4 / 320, true, fraction) - fine);
    EXPECT_GT(norm(fine), 0.15);
    EXPECT_NEAR(std::log2(coarse / half), 2.0, 0.1);
  }
}

TEST(ImplicitMotion, AgreesWithExplicitStepsAsBothAreRefined) {
  const double coarse = norm(swing(0.4 / 160, true) - swing(0.4 / 160, false));
  const double half = norm(swing(0.4 / 320, true) - swing(0.4 / 320, false));
  EXPECT_NEAR(std::log2(coarse / half), 2.0, 0.1);
  EXPECT_LT(half, 1e-4);
}

TEST(ImplicitMotion, TheFactorisationIsKeptWhileItConverges) {
  Beam beam = makeBeam();
  beam.model.add(nodalForce(nodeSet(beam.mesh, "z+"), {25.0, 0.0, 0.0}));
  ImplicitIntegrator integrator(beam.model, 0.002, averageAcceleration(0.0, 1e-9));
  integrator.run(20);
  EXPECT_EQ(integrator.report().factorisations, 1);
}

/// After u was changed between steps, as new; without a change, as if not restarted.
TEST(ImplicitMotion, ARestartSeesTheStateAsItIs) {
  for (const double jump : {0.0, 0.02}) {
    Beam beam = makeBeam();
    const std::vector<Vec3> load = tipLoad(beam, {3000.0, 0.0, 0.0});
    ImplicitMotion motion(beam.model, averageAcceleration(1.0));
    for (int i = 0; i < 10; ++i) pushed(motion, load, 0.01);
    beam.model.nodes.u.back().y += jump;
    Beam copy = makeBeam();
    copy.model.nodes = beam.model.nodes;
    ImplicitMotion other(copy.model, averageAcceleration(1.0));
    if (jump != 0.0) motion.restart();
    for (int i = 0; i < 3; ++i) {
      pushed(motion, load, 0.01);
      pushed(other, load, 0.01);
    }
    const Eigen::VectorXd u = flat(copy.model.nodes.u), v = flat(copy.model.nodes.v);
    EXPECT_LT((flat(beam.model.nodes.u) - u).norm(), 1e-10 * u.norm());
    EXPECT_LT((flat(beam.model.nodes.v) - v).norm(), 1e-9 * v.norm());
  }
}

TEST(ImplicitMotion, FailureSaysWhereAndLeavesTheStateAlone) {
  Beam beam = makeBeam();
  ImplicitOptions options = averageAcceleration(1.0);
  options.maxIterations = 3;
  options.maxCuts = 0;
  ImplicitMotion motion(beam.model, options);
  setRandom(beam.model.nodes.v, 0.01, 4);
  fix(beam.model.nodes, nodeSet(beam.mesh, "z-"));
  motion.kick(tipLoad(beam, {1.0e5, 0.0, 0.0}), 0.25);
  const Nodes before = beam.model.nodes;
  try {
    motion.step(0.5);
    FAIL();
  } catch (const NumericalError& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("t = 0 s"), std::string::npos) << what;
    EXPECT_NE(what.find("0.5 s"), std::string::npos) << what;
  }
  EXPECT_TRUE(beam.model.nodes.u == before.u);
  EXPECT_TRUE(beam.model.nodes.v == before.v);
  EXPECT_EQ(beam.model.t, 0.0);
  EXPECT_EQ(motion.steps(), 0);
}

TEST(ImplicitMotion, ConvergesWithTheUnsymmetricTangentOfTheDeformedMetric) {
  Beam beam = makeBeam(Formulation::standard, DeformedMetricHooke{1.0e6, 0.3, 1000.0});
  beam.model.add(nodalForce(nodeSet(beam.mesh, "z+"), {750.0, 0.0, 0.0}));
  ImplicitIntegrator integrator(beam.model, 0.02, averageAcceleration(0.0, 1e-9));
  integrator.run(20);
  EXPECT_EQ(integrator.report().cuts, 0);
  EXPECT_LT(integrator.report().iterations, 20 * 15);
}

TEST(ImplicitMotion, BadInputIsRefused) {
  Beam beam = makeBeam();
  EXPECT_THROW(ImplicitMotion(beam.model, {.massFraction = 1.5}), InputError);
  EXPECT_THROW(ImplicitMotion(beam.model, {.maxIterations = 0}), InputError);
  ImplicitMotion motion(beam.model);
  EXPECT_THROW(motion.step(0.0), InputError);
  EXPECT_THROW(motion.step(-0.1), InputError);
  beam.model.nodes.mass.back() = 0.0;
  EXPECT_THROW(ImplicitMotion(beam.model), InputError);
}

}  // namespace
}  // namespace dovetail::fem
