#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/fem/laws/viscosity.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "dovetail/fem/motion/stable_step.hpp"
#include "dynamics_helpers.hpp"

namespace dovetail::fem {
namespace {

const std::vector<Scheme>& allSchemes() {
  static const std::vector<Scheme> schemes = {newmark(), hht(-0.1), generalisedAlpha(0.5), generalisedAlpha(1.0),
                                              energyMomentum()};
  return schemes;
}

ImplicitOptions optionsOf(const Scheme& scheme, double tolerance = 1e-12) {
  ImplicitOptions options;
  options.scheme = scheme;
  options.relativeTolerance = tolerance;
  return options;
}

/// A block that is shaken at one end, pressed, pulled and damped: everything that forces and constraints may depend on.
Model shakenBlock() {
  const SolidMesh mesh = smallMesh();
  Model model = smallBody(mesh);
  model.constraints.hold(nodeSet(mesh, "x-"), componentY | componentZ);
  model.constraints.prescribe(nodeSet(mesh, "x-"), 0, [](double t) { return 1e-3 * (1.0 - std::cos(300.0 * t)); });
  model.add(followingPressure(mesh, faceSet(mesh, "z+"), [](double t) { return 2e4 * std::sin(200.0 * t); }));
  model.add(deadTraction(mesh, faceSet(mesh, "x+"), {0, 1e4, 0}, sine(30.0, 1.0)));
  model.add(massDamping(20.0));
  model.add(gravity(Vec3{0, 0, -9.81}));
  return model;
}

constexpr double orderTime = 0.02;

std::vector<Vec3> implicitEnd(const Scheme& scheme, int steps) {
  Model model = shakenBlock();
  ImplicitIntegrator integrator(model, orderTime / steps, optionsOf(scheme));
  integrator.run(steps);
  EXPECT_NEAR(model.t, orderTime, 1e-12);
  return model.nodes.u;
}

std::vector<Vec3> explicitEnd(int steps) {
  Model model = shakenBlock();
  ExplicitIntegrator(model, orderTime / steps, {.massFraction = 0.3}).run(steps);
  return model.nodes.u;
}

template <class End>
double observedOrder(End&& end, int coarse) {
  const auto a = end(coarse), b = end(2 * coarse), c = end(4 * coarse);
  return std::log2(largestDifference(a, b) / largestDifference(b, c));
}

TEST(Dynamics, SchemesAreOfSecondOrder) {
  for (const Scheme& scheme : allSchemes()) {
    const double order = observedOrder([&](int steps) { return implicitEnd(scheme, steps); }, 400);
    EXPECT_NEAR(order, 2.0, 0.1) << scheme.name;
  }
  EXPECT_NEAR(observedOrder(explicitEnd, 400), 2.0, 0.1);
}

/// The same block of a material with viscosity, which is being stretched and sheared when the run begins.
Model viscousBlock() {
  const SolidMesh mesh = smallMesh();
  Model model = makeModel(mesh);
  model.add(makeSolid(mesh, pointMaterial(KelvinVoigt{std::make_shared<PlainNeoHookean>(1e6, 1e6), 1500.0, 1500.0})));
  addMass(model);
  for (std::size_t n = 0; n < mesh.X.size(); ++n)
    model.nodes.v[n] = {4.0 * mesh.X[n].x, 10.0 * mesh.X[n].x * mesh.X[n].x, -3.0 * mesh.X[n].z};
  model.constraints.hold(nodeSet(mesh, "x-"), allComponents);
  model.add(deadTraction(mesh, faceSet(mesh, "x+"), {0, 1e4, 0}, sine(30.0, 1.0)));
  return model;
}

TEST(Dynamics, ImplicitSchemesAreOfSecondOrderWithViscosity) {
  for (const Scheme& scheme :
       {newmark(), hht(-0.1), generalisedAlpha(0.5), generalisedAlpha(0.8), generalisedAlpha(1.0)}) {
    const auto end = [&](int steps) {
      Model model = viscousBlock();
      ImplicitIntegrator integrator(model, orderTime / steps, optionsOf(scheme));
      integrator.run(steps);
      return model.nodes.u;
    };
    EXPECT_NEAR(observedOrder(end, 200), 2.0, 0.1) << scheme.name;
  }
}

/// What the ledger misses is the error of the mean force, as for elastic solids.
TEST(Dynamics, LedgerOfAViscousSolidClosesWithTheSquareOfTheStep) {
  const auto missing = [](int steps) {
    Model model = viscousBlock();
    ImplicitIntegrator integrator(model, orderTime / steps, optionsOf(newmark()));
    integrator.run(steps);
    double dissipated = 0.0;
    for (const auto& channel : integrator.ledger().channels())
      if (channel.name == "dissipated by elastic") dissipated = channel.joules;
    EXPECT_GT(dissipated, 0.1 * integrator.ledger().storedAtOpening());
    return integrator.ledger().largestResidual();
  };
  EXPECT_NEAR(std::log2(missing(1600) / missing(6400)) / 2.0, 2.0, 0.1);
}

TEST(Dynamics, NewmarkWithDampingIsOfFirstOrder) {
  EXPECT_NEAR(observedOrder([](int steps) { return implicitEnd(newmark(0.36, 0.7), steps); }, 200), 1.0, 0.15);
}

TEST(Dynamics, SchemesAgreeOnTheSolution) {
  const auto reference = implicitEnd(newmark(), 800);
  double most = 0.0;
  for (const Vec3& u : reference) most = std::max(most, norm(u));
  EXPECT_GT(most, 2e-3);
  for (const Scheme& scheme : allSchemes())
    EXPECT_LT(largestDifference(implicitEnd(scheme, 400), reference), 0.02 * most) << scheme.name;
}

/// Displacements of the oscillator for ω dt of 9000; the roots of the amplification are those at infinity.
std::vector<double> stiffSequence(const Scheme& scheme, int count) {
  Model model = oscillator();
  model.nodes.v[0] = {};
  ImplicitIntegrator integrator(model, 3e3, optionsOf(scheme));
  std::vector<double> x;
  for (int k = 0; k < count; ++k) {
    x.push_back(model.nodes.u[0].x);
    integrator.step();
  }
  return x;
}

/// Largest |x_n+3 − Σ …| over |x|, for a recurrence with the roots.
double recurrenceError(const std::vector<double>& x, double a, double b, double c) {
  double most = 0.0;
  for (std::size_t n = 1; n + 3 < x.size(); ++n) {
    const double sum = x[n + 3] - (a + b + c) * x[n + 2] + (a * b + b * c + c * a) * x[n + 1] - a * b * c * x[n];
    most = std::max(most, std::abs(sum) / (std::abs(x[n]) + std::abs(x[n + 1]) + std::abs(x[n + 2])));
  }
  return most;
}

TEST(Dynamics, HighFrequenciesShrinkByTheSpectralRadius) {
  for (const double rho : {0.3, 0.5, 0.8, 1.0}) {
    const auto x = stiffSequence(generalisedAlpha(rho), 12);
    EXPECT_LT(recurrenceError(x, -rho, -rho, -rho), 1e-6) << rho;
  }
  for (const double alpha : {-0.3, -0.1}) {
    const double rho = (1.0 + alpha) / (1.0 - alpha);
    const auto x = stiffSequence(hht(alpha), 12);
    EXPECT_LT(recurrenceError(x, -rho, -rho, alpha / (1.0 + alpha)), 1e-6) << alpha;
  }
}

TEST(Dynamics, FrequenciesOfTheOscillatorAreThoseOfTheSchemes) {
  Model model = oscillator();
  const double dt = 0.1, omega = 3.0, x0 = 0.1, v0 = 0.4;
  ImplicitIntegrator integrator(model, dt, optionsOf(newmark()));
  integrator.run(50);
  const double phase = 50 * 2.0 * std::atan(0.5 * omega * dt);
  EXPECT_NEAR(model.nodes.u[0].x, x0 * std::cos(phase) + v0 / omega * std::sin(phase), 1e-10);
  Model other = oscillator();
  ExplicitIntegrator(other, dt).run(50);
  const double angle = 50 * 2.0 * std::asin(0.5 * omega * dt);
  const double factor = std::sqrt(1.0 - 0.25 * omega * omega * dt * dt);
  EXPECT_NEAR(other.nodes.u[0].x, x0 * std::cos(angle) + v0 / (omega * factor) * std::sin(angle), 1e-10);
}

TEST(Dynamics, LedgerOfALinearSystemClosesAndNamesWhatTheSchemeDissipates) {
  for (const Scheme& scheme : allSchemes()) {
    Model model = oscillator();
    model.add(groundDashpots(std::array{0}, {0.5, 0.0, 0.1}));
    model.add(nodalForce(std::array{0}, {1, 2, 3}, sine(0.4, 2.0)));
    ImplicitIntegrator integrator(model, 0.2, optionsOf(scheme));
    integrator.run(200);
    EXPECT_LT(integrator.ledger().largestResidual(), 1e-11) << scheme.name;
    double dissipated = 0.0, damped = 0.0;
    for (const auto& channel : integrator.ledger().channels()) {
      if (channel.name == "dissipation of the scheme") dissipated = channel.joules;
      if (channel.name == "work of ground dashpots") damped = channel.joules;
    }
    EXPECT_GT(damped, 0.1) << scheme.name;
    const bool dissipates = scheme.alphaF > 0.0 && scheme.name != generalisedAlpha(1.0).name;
    if (dissipates) {
      EXPECT_GT(dissipated, 1e-3) << scheme.name;
    } else {
      EXPECT_LT(std::abs(dissipated), 1e-11) << scheme.name;
    }
  }
}

TEST(Dynamics, LedgerOfAShakenBlockClosesWithTheSquareOfTheStep) {
  for (const Scheme& scheme : allSchemes()) {
    double residual[2], scale = 0.0;
    for (const int fine : {0, 1}) {
      Model model = shakenBlock();
      ImplicitIntegrator integrator(model, orderTime / (100 << fine), optionsOf(scheme));
      integrator.run(100 << fine);
      residual[fine] = std::abs(integrator.ledger().residual());
      scale = integrator.ledger().storedMax() - integrator.ledger().storedMin();
    }
    EXPECT_GT(scale, 0.1);
    if (scheme.conserving) {
      EXPECT_LT(residual[0], 1e-9 * scale) << scheme.name;
    } else {
      EXPECT_LT(residual[0], 1e-3 * scale) << scheme.name;
      EXPECT_LT(residual[1], 0.4 * residual[0]) << scheme.name;
    }
  }
}

TEST(Dynamics, WorkOfALawWithoutPotentialIsBooked) {
  const SolidMesh mesh = smallMesh();
  Model model = makeModel(mesh);
  model.add(makeSolid(mesh, pointMaterial(DeformedMetricHooke{1e6, 0.3, 1000.0})));
  addMass(model);
  for (std::size_t n = 0; n < mesh.X.size(); ++n)
    model.nodes.v[n] = {-40.0 * mesh.X[n].x, 20.0 * mesh.X[n].x, 30.0 * mesh.X[n].y};
  ImplicitIntegrator integrator(model, crossing, optionsOf(energyMomentum()));
  integrator.run(30);
  const EnergyLedger& ledger = integrator.ledger();
  EXPECT_LT(ledger.largestResidual(), 1e-9 * ledger.storedAtOpening());
  EXPECT_GT(ledger.booked(), 0.1 * ledger.storedAtOpening());
}

TEST(Dynamics, RigidMotionOfSupportsTakesTheBodyAlong) {
  for (const Scheme& scheme : allSchemes()) {
    const SolidMesh mesh = smallMesh();
    Model model = smallBody(mesh);
    for (Vec3& v : model.nodes.v) v = {2.0, 0, 0};
    model.constraints.prescribe(nodeSet(mesh, "x-"), 0, [](double t) { return 2.0 * t; });
    fix(model.nodes, nodeSet(mesh, "y-"), componentY);
    ImplicitIntegrator integrator(model, 0.01, optionsOf(scheme));
    integrator.run(100);
    for (std::size_t n = 0; n < model.nodes.u.size(); ++n) {
      EXPECT_LT(norm(model.nodes.u[n] - Vec3{2.0, 0, 0}), 1e-9) << scheme.name;
      EXPECT_LT(norm(model.nodes.v[n] - Vec3{2.0, 0, 0}), 1e-6) << scheme.name;
    }
  }
}

TEST(Dynamics, FixedComponentsMoveWithTheirVelocity) {
  const SolidMesh mesh = smallMesh();
  Model model = smallBody(mesh), other = smallBody(mesh);
  for (Model* m : {&model, &other}) {
    fix(m->nodes, nodeSet(mesh, "x-"));
    for (const int n : nodeSet(mesh, "x-")) m->nodes.v[static_cast<std::size_t>(n)] = {0, 0, 0.5};
  }
  ImplicitIntegrator integrator(model, 1e-3, optionsOf(newmark()));
  integrator.run(20);
  ExplicitIntegrator steps(other, 1e-4);
  steps.run(200);
  for (const int n : nodeSet(mesh, "x-")) {
    EXPECT_NEAR(model.nodes.u[static_cast<std::size_t>(n)].z, 0.01, 1e-14);
    EXPECT_NEAR(other.nodes.u[static_cast<std::size_t>(n)].z, 0.01, 1e-14);
  }
  EXPECT_LT(std::abs(steps.ledger().residual()), 1e-3 * steps.ledger().stored());
  EXPECT_LT(std::abs(integrator.ledger().residual()), 1e-3 * integrator.ledger().stored());
}

TEST(Dynamics, ExplicitStepsAboveTheStableOneAreRefused) {
  SolidMesh mesh = smallMesh();
  for (Vec3& X : mesh.X)
    if (X.x > 0.15 && X.x < 0.25) X.x = 0.23;  // element 2 is thin now
  Model model = smallBody(mesh);
  const double most = stableStep(model).dt;
  EXPECT_NO_THROW(ExplicitIntegrator(model, most));
  try {
    ExplicitIntegrator(model, 1.01 * most);
    ADD_FAILURE() << "an unstable step was taken";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("element 2 "), std::string::npos) << error.what();
  }
  EXPECT_THROW(ExplicitIntegrator(model, most, {.massFraction = 0.5}), InputError);
  EXPECT_THROW(ExplicitIntegrator(model, 0.0), InputError);
  model.nodes.mass[0] = 0.0;
  EXPECT_THROW(ExplicitIntegrator(model, 0.5 * most), InputError);
}

TEST(Dynamics, UnstableExplicitRunsStopWithTheElement) {
  Model model = shakenBlock();
  ExplicitIntegrator integrator(model, 4.0 * crossing, {.checkStep = false});
  try {
    integrator.run(200);
    ADD_FAILURE() << "an unstable run went through";
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("element"), std::string::npos) << error.what();
  }
}

TEST(Dynamics, OptionsOutOfRangeAreRefused) {
  EXPECT_THROW(newmark(0.2, 0.5), InputError);
  EXPECT_THROW(newmark(0.25, 0.4), InputError);
  EXPECT_THROW(hht(0.1), InputError);
  EXPECT_THROW(hht(-0.4), InputError);
  EXPECT_THROW(generalisedAlpha(1.1), InputError);
  Model model = oscillator();
  EXPECT_THROW(ImplicitIntegrator(model, -1.0), InputError);
  EXPECT_THROW(ImplicitIntegrator(model, 0.1, {.relativeTolerance = 0.0}), InputError);
  EXPECT_THROW(ImplicitIntegrator(model, 0.1, {.massFraction = 2.0}), InputError);
}

}  // namespace
}  // namespace dovetail::fem
