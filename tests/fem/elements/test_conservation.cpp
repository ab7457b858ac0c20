// What integrators conserve, how they stop, and how they go on from a checkpoint.
#include <gtest/gtest.h>

#include <sstream>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/fem/laws/plasticity.hpp"
#include "dovetail/fem/model/ties.hpp"
#include "dovetail/fem/terms/contact_plane.hpp"
#include "dynamics_helpers.hpp"

namespace dovetail::fem {
namespace {

/// A free bar that spins by 0.06 rad in the largest step below, and vibrates.
Model spinningBar(const SolidMesh& mesh, Formulation formulation = Formulation::standard) {
  Model model = smallBody(mesh, formulation);
  const Vec3 spin{0.05, 0.1, 0.3}, middle{0.15, 0.05, 0.05};
  for (std::size_t n = 0; n < model.nodes.v.size(); ++n) {
    const Vec3 r = model.nodes.X[n] - middle;
    model.nodes.v[n] = cross(spin, r) + Vec3{0.1 + 0.5 * r.x, 0.2 - 0.5 * r.y, 0.05 + 5.0 * r.x * r.y};
  }
  return model;
}

struct Drift {
  double energy, momentum, angularMomentum;  // relative
};

Drift driftOf(ElementShape shape, double dt, double tolerance, int steps,
              Formulation formulation = Formulation::standard) {
  const SolidMesh mesh = smallMesh(shape);
  Model model = spinningBar(mesh, formulation);
  ImplicitIntegrator integrator(model, dt, {.scheme = energyMomentum(), .relativeTolerance = tolerance});
  const Vec3 p = integrator.momentum(), l = integrator.angularMomentum();
  integrator.run(steps);
  EXPECT_EQ(integrator.report().cuts, 0);
  return {integrator.ledger().largestDrift() / integrator.ledger().storedAtOpening(),
          norm(integrator.momentum() - p) / norm(p), norm(integrator.angularMomentum() - l) / norm(l)};
}

TEST(EnergyMomentum, DriftsAreBoundedByStepsTimesToleranceAndFallWithIt) {
  for (const double multiple : {10.0, 100.0}) {
    const double dt = multiple * crossing;
    const int steps = 1000;
    const Drift loose = driftOf(ElementShape::hex8, dt, 1e-5, steps),
                tight = driftOf(ElementShape::hex8, dt, 1e-7, steps),
                round = driftOf(ElementShape::hex8, dt, 1e-12, steps);
    for (const auto part : {&Drift::energy, &Drift::momentum, &Drift::angularMomentum}) {
      EXPECT_LT(loose.*part, steps * 1e-5) << multiple;
      EXPECT_LT(tight.*part, std::max(0.1 * loose.*part, 1e-11)) << multiple;
      EXPECT_LT(round.*part, 1e-9) << multiple;
    }
  }
}

TEST(EnergyMomentum, HoldsForOtherShapes) {
  for (const ElementShape shape : {ElementShape::hex20, ElementShape::tet4, ElementShape::tet10}) {
    const Drift drift = driftOf(shape, 10.0 * crossing, 1e-12, 100);
    EXPECT_LT(drift.energy, 1e-10) << name(shape);
    EXPECT_LT(drift.momentum, 1e-10) << name(shape);
    EXPECT_LT(drift.angularMomentum, 1e-10) << name(shape);
  }
}

TEST(EnergyMomentum, HoldsForOtherFormulations) {
  for (const auto& [shape, formulation, multiple] : {std::tuple(ElementShape::hex8, Formulation::enhanced, 10.0),
                                                     {ElementShape::hex8, Formulation::meanDilatation, 10.0},
                                                     {ElementShape::hex8, Formulation::reduced, 3.0},
                                                     {ElementShape::hex20, Formulation::meanDilatation, 10.0}}) {
    const Drift drift = driftOf(shape, multiple * crossing, 1e-10, 100, formulation);
    EXPECT_LT(drift.energy, 1e-9) << name(shape) << " " << name(formulation);
    EXPECT_LT(drift.momentum, 1e-9) << name(shape) << " " << name(formulation);
    EXPECT_LT(drift.angularMomentum, 1e-9) << name(shape) << " " << name(formulation);
  }
}

TEST(EnergyMomentum, NamesTheSolidsWhoseEnergyItDoesNotKeep) {
  const SolidMesh mesh = smallMesh();
  Model model = makeModel(mesh);
  model.add(makeSolid(mesh, std::make_shared<PlainNeoHookean>(1e6, 1e6), {.name = "rubber"}));
  model.add(makeSolid(mesh, pointMaterial(J2Plasticity{1e6, 0.3, 1000.0, linearYield(1e4)}), {.name = "steel"}));
  addMass(model);
  ImplicitIntegrator integrator(model, crossing, {.scheme = energyMomentum()});
  integrator.run(1);
  EXPECT_EQ(integrator.report().atMeanState, std::vector<std::string>{"steel"});
}

TEST(EnergyMomentum, NewmarkDoesNotConserveTheEnergyOfLargeSteps) {
  const SolidMesh mesh = smallMesh();
  Model model = spinningBar(mesh);
  ImplicitIntegrator integrator(model, 2.0 * crossing, {.scheme = newmark(), .relativeTolerance = 1e-12});
  integrator.run(200);
  const double conserving = driftOf(ElementShape::hex8, 2.0 * crossing, 1e-12, 200).energy;
  EXPECT_GT(integrator.ledger().largestDrift() / integrator.ledger().storedAtOpening(), 1e3 * conserving);
}

TEST(ExplicitSteps, KeepBothMomentaAndNearlyTheEnergy) {
  const SolidMesh mesh = smallMesh();
  Model model = spinningBar(mesh);
  ExplicitIntegrator integrator(model, 0.3 * crossing);
  const Vec3 p = momentum(model.nodes), l = angularMomentum(model.nodes);
  integrator.run(20000);
  EXPECT_LT(norm(momentum(model.nodes) - p), 1e-12 * norm(p));
  EXPECT_LT(norm(angularMomentum(model.nodes) - l), 1e-11 * norm(l));
  EXPECT_LT(integrator.ledger().largestDrift(), 5e-3 * integrator.ledger().storedAtOpening());
}

/// Two bars, the finer one tied to the end of the coarser.
Model tiedBars() {
  SolidMesh mesh = boxOf(ElementShape::hex8, {2, 1, 1}, {}, {0.2, 0.1, 0.1});
  const SolidMesh fine = boxOf(ElementShape::hex8, {4, 2, 2}, {0.2, 0, 0}, {0.4, 0.1, 0.1});
  const int shift = static_cast<int>(mesh.X.size());
  mesh.X.insert(mesh.X.end(), fine.X.begin(), fine.X.end());
  for (const int n : fine.groups[0].node) mesh.groups[0].node.push_back(n + shift);
  std::vector<int> slaves;
  for (const int n : nodeSet(fine, "x-")) slaves.push_back(n + shift);
  Model model = smallBody(mesh);
  model.constraints.ties = tieInterface(mesh, slaves, faceSet(mesh, "x+"), 1e-9);
  for (std::size_t n = 0; n < model.nodes.v.size(); ++n)
    model.nodes.v[n] = cross(Vec3{0, 0, 50.0}, model.nodes.X[n]) + Vec3{10.0 * model.nodes.X[n].x, 1.0, 2.0};
  return model;
}

TEST(Ties, TiedBodiesKeepEnergyAndMomenta) {
  Model model = tiedBars();
  ExplicitIntegrator integrator(model, 0.1 * crossing);
  const Vec3 p = momentum(model.nodes), l = angularMomentum(model.nodes);
  integrator.run(5000);
  EXPECT_LT(norm(momentum(model.nodes) - p), 1e-12 * norm(p));
  EXPECT_LT(norm(angularMomentum(model.nodes) - l), 1e-11 * norm(l));
  EXPECT_LT(integrator.ledger().largestDrift(), 5e-3 * integrator.ledger().storedAtOpening());
  Model other = tiedBars();
  ImplicitIntegrator implicit(other, 5.0 * crossing, {.scheme = energyMomentum(), .relativeTolerance = 1e-12});
  const Vec3 p0 = implicit.momentum(), l0 = implicit.angularMomentum();
  implicit.run(200);
  EXPECT_LT(implicit.ledger().largestDrift(), 1e-9 * implicit.ledger().storedAtOpening());
  EXPECT_LT(norm(implicit.momentum() - p0), 1e-9 * norm(p0));
  EXPECT_LT(norm(implicit.angularMomentum() - l0), 1e-9 * norm(l0));
}

TEST(ModelMass, SolvesTheTiedMassMatrix) {
  Model model = tiedBars();
  model.constraints.hold(std::array{0}, componentX);
  const DofMap dofs(model.constraints, model.nodes);
  for (const double fraction : {0.0, 0.4, 1.0}) {
    ModelMass mass(model, dofs, fraction);
    std::vector<Vec3> f(model.nodes.u.size()), a(f.size()), Ma(f.size());
    setRandom(f, 1.0, 5);
    mass.accelerate(f, a);
    mass.multiply(a, Ma);
    std::vector<double> left(dofs.size()), right(dofs.size());
    dofs.reduce(Ma, left);
    dofs.reduce(f, right);
    for (std::size_t i = 0; i < left.size(); ++i) EXPECT_NEAR(left[i], right[i], 1e-11) << fraction;
    std::vector<Vec3> again = a;
    dofs.applyVelocity(0.0, 1.0, again);
    EXPECT_LT(largestDifference(a, again), 1e-11 * largestDifference(a, std::vector<Vec3>(a.size())));
  }
}

/// A block that falls on a rigid plane.
Model fallingBlock(const SolidMesh& mesh, double friction) {
  Model model = smallBody(mesh);
  model.add(gravity(Vec3{0, 0, -9.81}));
  ContactOptions contact;
  contact.penalty = 5e8;
  contact.friction = friction;
  model.add(makeContactPlane(mesh, faceSet(mesh, "z-"), {{0, 0, -0.001}, {0, 0, 1}, {}}, contact));
  for (Vec3& v : model.nodes.v) v = {1.0, 0, -2.0};
  return model;
}

TEST(Contact, ReboundKeepsTheBooksOfEveryScheme) {
  const SolidMesh mesh = smallMesh();
  for (const double friction : {0.0, 0.3}) {
    Model model = fallingBlock(mesh, friction);
    ExplicitIntegrator integrator(model, 0.02 * crossing, {.checkStep = false});
    integrator.run(2000);
    EXPECT_LT(integrator.ledger().largestResidual(), 2e-3 * integrator.ledger().storedAtOpening());
    EXPECT_GT(momentum(model.nodes).z, 0.0);
    Model other = fallingBlock(mesh, friction);
    ImplicitIntegrator implicit(other, 0.1 * crossing, {.scheme = energyMomentum(), .relativeTolerance = 1e-11});
    implicit.run(400);
    EXPECT_GT(momentum(other.nodes).z, 0.0);
    if (friction == 0.0) {
      EXPECT_LT(implicit.ledger().largestResidual(), 1e-8 * implicit.ledger().storedAtOpening());
    } else {
      EXPECT_LT(implicit.ledger().largestResidual(), 0.02 * implicit.ledger().storedAtOpening());
      EXPECT_LT(momentum(other.nodes).x, momentum(fallingBlock(mesh, friction).nodes).x);
    }
  }
}

template <class Integrator, class Options>
void expectBitwiseRestart(double dt, const Options& options, int before, int after) {
  const SolidMesh mesh = smallMesh();
  Model whole = fallingBlock(mesh, 0.3), resumed = fallingBlock(mesh, 0.3);
  whole.add(massDamping(3.0));
  resumed.add(massDamping(3.0));
  Integrator one(whole, dt, options);
  one.run(before);
  ByteWriter writer;
  one.save(writer);
  one.run(after);
  Integrator two(resumed, dt, options);
  ByteReader reader(writer.bytes());
  two.load(reader);
  EXPECT_TRUE(reader.atEnd());
  two.run(after);
  EXPECT_EQ(whole.t, resumed.t);
  for (std::size_t n = 0; n < whole.nodes.u.size(); ++n) {
    EXPECT_EQ(whole.nodes.u[n], resumed.nodes.u[n]);
    EXPECT_EQ(whole.nodes.v[n], resumed.nodes.v[n]);
  }
  for (std::size_t k = 0; k < one.ledger().channels().size(); ++k)
    EXPECT_EQ(one.ledger().channels()[k].joules, two.ledger().channels()[k].joules) << one.ledger().channels()[k].name;
  EXPECT_EQ(one.ledger().residual(), two.ledger().residual());
  EXPECT_EQ(one.report().steps, two.report().steps);
}

TEST(Checkpoints, RunsGoOnBitwise) {
  expectBitwiseRestart<ExplicitIntegrator>(0.02 * crossing, ExplicitOptions{.checkStep = false}, 137, 200);
  expectBitwiseRestart<ImplicitIntegrator>(0.1 * crossing, ImplicitOptions{}, 27, 40);
  expectBitwiseRestart<ImplicitIntegrator>(0.1 * crossing, ImplicitOptions{.scheme = energyMomentum()}, 27, 40);
}

TEST(Checkpoints, OfOtherModelsAreRefused) {
  const SolidMesh mesh = smallMesh(), other = smallMesh(ElementShape::hex20);
  Model model = smallBody(mesh), bigger = smallBody(other), loaded = smallBody(mesh);
  loaded.add(gravity(Vec3{0, 0, -1.0}));
  ImplicitIntegrator one(model, 1e-3), two(bigger, 1e-3), three(loaded, 1e-3);
  ByteWriter writer;
  one.save(writer);
  ByteReader first(writer.bytes()), second(writer.bytes());
  EXPECT_THROW(two.load(first), InputError);
  EXPECT_THROW(three.load(second), InputError);
}

TEST(Threads, DoNotChangeADigit) {
  const SolidMesh mesh = boxOf(ElementShape::hex8, {16, 12, 12}, {}, {0.27, 0.2, 0.2});
  const int before = threads();
  std::vector<std::vector<Vec3>> ends;
  for (const int count : {1, 3}) {
    setThreads(count);
    Model model = fallingBlock(mesh, 0.3), other = fallingBlock(mesh, 0.3);
    ExplicitIntegrator(model, 0.002 * crossing, {.checkStep = false}).run(20);
    ImplicitIntegrator(other, 0.1 * crossing).run(1);
    ends.push_back(model.nodes.u);
    ends.push_back(other.nodes.u);
  }
  setThreads(before);
  EXPECT_GT(largestDifference(ends[0], std::vector<Vec3>(ends[0].size())), 1e-6);
  EXPECT_EQ(ends[0], ends[2]);
  EXPECT_EQ(ends[1], ends[3]);
}

TEST(Failure, StepsThatDoNotConvergeAreCut) {
  const SolidMesh mesh = smallMesh();
  Model model = smallBody(mesh);
  model.constraints.hold(nodeSet(mesh, "x-"));
  for (const int n : nodeSet(mesh, "x+")) model.nodes.v[static_cast<std::size_t>(n)] = {-80.0, 0, 0};
  ImplicitIntegrator integrator(model, 4.0 * crossing, {.scheme = newmark(), .maxIterations = 5});
  integrator.run(5);
  EXPECT_GT(integrator.report().cuts, 0);
  EXPECT_NEAR(model.t, 20.0 * crossing, 1e-12);
}

TEST(Failure, StopsWithTheElementAndTheLastAcceptedState) {
  const SolidMesh mesh = smallMesh();
  Model model = smallBody(mesh);
  model.constraints.hold(nodeSet(mesh, "x-"));
  model.constraints.prescribe(nodeSet(mesh, "x+"), 0, ramp(1e-3, -0.5));  // through the other end
  ImplicitIntegrator integrator(model, 1e-4, {.scheme = newmark(), .maxIterations = 10, .maxCuts = 3});
  std::vector<Vec3> u = model.nodes.u, v = model.nodes.v;
  double t = 0.0;
  try {
    for (int k = 0; k < 10; ++k) {
      u = model.nodes.u;
      v = model.nodes.v;
      t = model.t;
      integrator.step();
    }
    ADD_FAILURE() << "the bar was pushed through itself";
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("t = "), std::string::npos) << error.what();
  }
  EXPECT_GE(model.t, t);
  EXPECT_LT(model.t, t + 1e-4);
  if (model.t == t) {
    EXPECT_EQ(largestDifference(model.nodes.u, u), 0.0);
    EXPECT_EQ(largestDifference(model.nodes.v, v), 0.0);
  }
  for (const auto& term : model.terms) EXPECT_NO_THROW(term->requireValid(model.nodes, "after", Scrutiny::all));
}

TEST(Report, HasAPageOfText) {
  const SolidMesh mesh = smallMesh();
  Model model = fallingBlock(mesh, 0.0);
  ImplicitIntegrator integrator(model, 0.1 * crossing);
  integrator.run(10);
  std::ostringstream text;
  text << integrator.report();
  for (const char* word : {"generalised alpha", "consistent", "iterations", "factorisations", "kinetic", "elastic",
                           "gravity", "contact plane", "residual", "assembly"})
    EXPECT_NE(text.str().find(word), std::string::npos) << word << '\n' << text.str();
}

}  // namespace
}  // namespace dovetail::fem
