// Drift of energy and momenta of a free bar over long runs of energy-momentum steps, for several tolerances.
//
// usage: energy_momentum [steps [dt over the explicit limit]]      default 100000, and both 10 and 100
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "dovetail/core/parallel.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "dovetail/fem/motion/stable_step.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "program/run.hpp"

namespace {

using namespace dovetail;
using namespace dovetail::fem;

/// 0.3 × 0.1 × 0.1 m, E = 2.5 MPa, ν = 0.25, 1000 kg/m³.
SolidMesh bar() { return boxOf(ElementShape::hex8, {3, 1, 1}, {}, {0.3, 0.1, 0.1}); }

Model makeBar() {
  const SolidMesh mesh = bar();
  Model model = makeModel(mesh);
  model.add(makeSolid(mesh, pointMaterial(neoHookean(2.5e6, 0.25, 1000.0))));
  addMass(model);
  return model;
}

/// A short pull at both ends, 1 % of strain, and a push beside the centre; then nothing acts on the bar.
Nodes afterTheLoad(double criticalStep) {
  const SolidMesh mesh = bar();
  Model model = makeBar();
  const double duration = 0.01;
  model.add(deadTraction(mesh, faceSet(mesh, "x+"), {3e4, 0, 0}, halfSine(duration, 1.0)));
  model.add(deadTraction(mesh, faceSet(mesh, "x-"), {-3e4, 0, 0}, halfSine(duration, 1.0)));
  model.add(deadTraction(mesh, faceSet(mesh, "x+"), {0, 500.0, 100.0}, halfSine(duration, 1.0)));
  const int steps = static_cast<int>(std::ceil(duration / (0.25 * criticalStep)));
  ImplicitIntegrator(model, duration / steps, {.scheme = energyMomentum(), .relativeTolerance = 1e-12}).run(steps);
  return model.nodes;
}

struct Result {
  double energy, momentum, angularMomentum, iterations, microseconds;
  long long cuts;
};

Result run(const Nodes& start, double dt, double tolerance, int steps) {
  Model model = makeBar();
  model.nodes.u = start.u;
  model.nodes.v = start.v;
  ImplicitIntegrator integrator(model, dt, {.scheme = energyMomentum(), .relativeTolerance = tolerance});
  const Vec3 p = integrator.momentum(), l = integrator.angularMomentum();
  const auto clock = std::chrono::steady_clock::now();
  integrator.run(steps);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
  const DynamicsReport report = integrator.report();
  return {report.ledger.largestDrift() / report.ledger.storedAtOpening(),
          norm(integrator.momentum() - p) / norm(p),
          norm(integrator.angularMomentum() - l) / norm(l),
          static_cast<double>(report.iterations) / static_cast<double>(report.steps),
          1e6 * seconds / static_cast<double>(steps),
          static_cast<long long>(report.cuts)};
}

}  // namespace

int main(int argc, char** argv) {
  int steps = 100000;
  std::optional<double> only;
  dovetail::program::Options options(
      "energy_momentum", "Energy and momenta of a bar in free flight over long times, for steps and tolerances.");
  options.integer("STEPS", steps, 1, 1000000000, "of each run; 100000 if not given");
  options.number("MULTIPLE", only, dovetail::program::positive(), "of the explicit step; 10 and 100 if not given");
  return dovetail::program::runProgram(options, argc, argv, [&] {
    setThreads(1);
    Model model = makeBar();
    const double critical = assembledStableStep(model);
    const Nodes start = afterTheLoad(critical);
    std::printf("%d steps, largest explicit step %.3g s\n", steps, critical);
    std::printf(
        "| dt / explicit | tolerance | energy | momentum | angular momentum | iterations per step | us per step | cuts "
        "|\n");
    std::printf("|---|---|---|---|---|---|---|---|\n");
    const std::vector<double> multiples = only ? std::vector{*only} : std::vector{10.0, 100.0};
    for (const double multiple : multiples)
      for (const double tolerance : {1e-5, 1e-7, 1e-9, 1e-11}) {
        const Result r = run(start, multiple * critical, tolerance, steps);
        std::printf("| %g | %g | %.1e | %.1e | %.1e | %.1f | %.0f | %lld |\n", multiple, tolerance, r.energy,
                    r.momentum, r.angularMomentum, r.iterations, r.microseconds, r.cuts);
        std::fflush(stdout);
      }
    return true;
  });
}
