#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/plasticity.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/fem/laws/viscosity.hpp"
#include "dovetail/fem/mesh/mesh_shapes.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "plastic_laws.hpp"

namespace dovetail::fem {
namespace {

/// One brick that is set oscillating along x.
struct Oscillator {
  static constexpr double young = 1e6, density = 1000.0, side = 0.1, start = 1e-5;  // m/s
  SolidMesh mesh = boxOf(ElementShape::hex8, {1, 1, 1}, {}, {side, side, side});
  Model model = makeModel(mesh);
  std::shared_ptr<Solid> solid;
  /// Half of the lumped mass oscillations on the stiffness E A/L.
  double omega = std::sqrt(young * side / (0.5 * density * side * side * side));

  explicit Oscillator(double time) {
    solid = makeSolid(mesh, pointMaterial(kelvinVoigt(pointMaterial(Hencky{young, 0.0, density}), time, young, 0.0)));
    model.add(solid);
    addMass(model);
    model.constraints.hold(nodeSet(mesh, "x-"), componentX);
    for (std::size_t n = 0; n < mesh.X.size(); ++n) {
      model.constraints.hold(std::array{static_cast<int>(n)}, componentY | componentZ);
      model.nodes.v[n].x = start * mesh.X[n].x / side;
    }
  }
  double end() const { return model.nodes.u[static_cast<std::size_t>(nodeSet(mesh, "x+")[0])].x; }
};

template <class Advance>
void expectDecay(Oscillator& o, double time, double dt, Advance&& advance) {
  const double ratio = 0.5 * o.omega * time, damped = o.omega * std::sqrt(1.0 - ratio * ratio);
  double worst = 0.0;
  for (int k = 1; dt * k * o.omega < 20.0; ++k) {
    advance();
    const double t = dt * k, expected = std::exp(-ratio * o.omega * t) * std::sin(damped * t) / damped;
    worst = std::max(worst, o.omega * std::abs(o.end() / Oscillator::start - expected));
  }
  EXPECT_LT(worst, 2.0 * ratio * o.omega * dt);  // the rate is that of the middle of the step
}

TEST(KelvinVoigtSolid, VibrationsDecayWithHalfTheRelaxationTimesFrequency) {
  const double time = 2e-3;
  {
    Oscillator o(time);
    const double dt = 0.01 / o.omega;
    ExplicitIntegrator integrator(o.model, dt);
    expectDecay(o, time, dt, [&] { integrator.step(); });
    EXPECT_LT(integrator.ledger().largestResidual(), 0.02 * integrator.ledger().storedAtOpening());
  }
  {
    Oscillator o(time);
    const double dt = 0.01 / o.omega;
    ImplicitIntegrator integrator(o.model, dt, {.scheme = newmark(), .massFraction = 0.0});
    expectDecay(o, time, dt, [&] { integrator.step(); });
    EXPECT_LT(integrator.ledger().largestResidual(), 0.02 * integrator.ledger().storedAtOpening());
  }
}

TEST(KelvinVoigtSolid, ShortensTheStableStepAsItSays) {
  const double time = 2e-3;
  const auto last = [&](double fraction) {
    Oscillator o(time);
    const double bare = 2.0 / o.omega, dt = fraction * (std::sqrt(time * time + bare * bare) - time);
    ExplicitIntegrator integrator(o.model, dt, {.checkStep = false, .energyEvery = 0});
    integrator.run(300);
    return std::abs(o.end()) * o.omega / Oscillator::start;
  };
  EXPECT_LT(last(0.98), 1e-2);
  EXPECT_THROW(last(1.02), NumericalError);  // turned inside out
}

/// The largest residual of the ledger over the energy at the start: one brick on a floor whose top is set moving
/// sideways and down, so that pressure and direction of flow change throughout.
double residualOf(const Named& law, Formulation formulation, int steps) {
  const bool isSoil = law.material->name() == "Drucker-Prager";
  const double side = 0.1, modulus = isSoil ? fem::soil(0.0, 0.0).youngsModulus : young;
  const double crossing = side / std::sqrt(modulus / law.material->density()), speed = 0.05 * side / crossing;
  const SolidMesh mesh = boxOf(ElementShape::hex8, {1, 1, 1}, {}, {side, side, side});
  Model model = makeModel(mesh);
  model.add(makeSolid(mesh, law.material, {.formulation = formulation}));
  addMass(model);
  fix(model.nodes, nodeSet(mesh, "z-"));
  for (const int n : nodeSet(mesh, "z+")) model.nodes.v[static_cast<std::size_t>(n)] = speed * Vec3{0.8, 0.3, -1.0};
  ImplicitIntegrator integrator(model, 4.0 * crossing / steps,
                                {.scheme = newmark(), .massFraction = 0.0, .relativeTolerance = 1e-11});
  integrator.run(steps);
  EXPECT_GT(integrator.ledger().booked(), 0.1 * integrator.ledger().storedAtOpening()) << law.name;
  return integrator.ledger().largestResidual() / integrator.ledger().storedAtOpening();
}

TEST(PlasticSolid, BooksOfAStepBalanceToSecondOrder) {
  const Named soil{"dilating", pointMaterial(fem::soil(0.6, 0.2))},
      metal{"recovering", pointMaterial(steel(20e9, 15.0))};
  for (const auto& [law, formulation] :
       {std::pair(soil, Formulation::standard), {soil, Formulation::meanDilatation}, {metal, Formulation::standard}}) {
    const double coarse = residualOf(law, formulation, 50), fine = residualOf(law, formulation, 200);
    EXPECT_LT(fine, 1e-3) << law.name;
    EXPECT_GT(std::log(coarse / fine) / std::log(4.0), 1.7) << law.name;
  }
}

TEST(PlasticSolid, AnImpactTurnsItsEnergyIntoPlasticWork) {
  // A copper rod meets a rigid wall at 227 m/s.
  const double length = 32.4e-3, radius = 3.2e-3, speed = 227.0, dt = 2.5e-8;
  const SolidMesh mesh = roundBar(ElementShape::hex8, {2, 1, 10}, radius, length);
  Model model = makeModel(mesh);
  const J2Plasticity copper{117e9, 0.35, 8930.0, linearYield(0.4e9, 0.1e9)};
  const std::shared_ptr<Solid> rod =
      makeSolid(mesh, pointMaterial(copper), {.formulation = Formulation::meanDilatation});
  model.add(rod);
  addMass(model);
  model.constraints.hold(nodeSet(mesh, "z-"), componentZ);
  for (std::size_t n = 0; n < mesh.X.size(); ++n) model.nodes.v[n].z = mesh.X[n].z > 0.0 ? -speed : 0.0;
  ExplicitIntegrator integrator(model, dt, {.energyEvery = 20});
  const double start = integrator.kineticEnergy();
  integrator.run(static_cast<std::int64_t>(80e-6 / dt));

  EXPECT_LT(std::abs(integrator.ledger().residual()), 0.02 * start);
  EXPECT_LT(integrator.kineticEnergy(), 0.05 * start);
  const Solid::Sample sample = rod->sample(model.nodes, {model.t, dt});
  const std::size_t size = rod->material()->historySize();
  double dissipated = 0.0, deepest = 0.0, volume = 0.0, before = 0.0;
  for (std::size_t p = 0; p < sample.volume.size(); ++p) {
    const double a = plasticStrain({&sample.history[p * size], size});
    dissipated += sample.volume[p] * copper.yield.stress(0.0) * a;  // what is not stored as hardening
    deepest = std::max(deepest, a);
    before += sample.volume[p];
    const Eigen::Map<const Eigen::Matrix3d> F(&sample.F[9 * p]);
    volume += sample.volume[p] * F.determinant();
  }
  EXPECT_GT(dissipated, 0.7 * start);
  EXPECT_LT(dissipated, start);
  EXPECT_GT(deepest, 1.0);
  EXPECT_NEAR(volume / before, 1.0, 0.01);
  EXPECT_LT(model.nodes.u[static_cast<std::size_t>(nodeSet(mesh, "z+")[0])].z, -0.3 * length);
}

}  // namespace
}  // namespace dovetail::fem
