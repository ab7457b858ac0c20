// Stiff and extreme scenes of solids: what comes out, beside what should. Exits with 1 if a row is not as it should be.
//
// usage: fem_extremes [--quick]
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/plasticity.hpp"
#include "dovetail/fem/laws/point_field.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/fem/mesh/mesh_places.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "dovetail/fem/motion/stable_step.hpp"
#include "dovetail/fem/solve/statics.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "program/run.hpp"

namespace {

using namespace dovetail;
using namespace dovetail::fem;

struct Table {
  int failures = 0;
  void row(const char* scene, const std::string& element, const std::string& result, bool good, double seconds) {
    std::printf("%-34s %-18s %-86s %-6s %7.3f s\n", scene, element.c_str(), result.c_str(), good ? "ok" : "FAILED",
                seconds);
    failures += !good;
  }
};

template <class... Values>
std::string text(const char* format, Values... values) {
  char buffer[200];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

class Stopwatch {
public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

struct Beam {
  double length, height, young, nu;
  std::array<int, 3> cells;  // along the axis x, the height y, the width z
  ElementShape shape;
  Formulation formulation;
  double load;  // at the tip, N
};

struct BeamResult {
  double shortening, deflection;
  StaticReport report;
};

/// A cantilever of square section along x, a force at its tip along y.
BeamResult bend(const Beam& b) {
  const SolidMesh mesh = boxOf(b.shape, b.cells, {}, {b.length, b.height, b.height});
  Model model = makeModel(mesh);
  model.add(makeSolid(mesh, pointMaterial(neoHookean(b.young, b.nu, 1000.0)), {.formulation = b.formulation}));
  // The clamp lets the section change its shape, as beam theory does.
  model.constraints.hold(nodesWhere(mesh, [](const Vec3& X) { return X.x == 0.0; }), componentX);
  const double middle = 0.5 * b.height;
  const auto axis = nodesWhere(mesh, [&](const Vec3& X) {
    return X.x == 0.0 && std::abs(X.y - middle) < 1e-9 * b.height && std::abs(X.z - middle) < 1e-9 * b.height;
  });
  model.constraints.hold(axis, componentY | componentZ);
  model.constraints.hold(nodesWhere(mesh,
                                    [&](const Vec3& X) {
                                      return X.x == 0.0 && std::abs(X.y - middle) < 1e-9 * b.height &&
                                             std::abs(X.z - middle) > 1e-9 * b.height;
                                    }),
                         componentY);
  const auto& tip = faceSet(mesh, "x+");
  model.add(deadTraction(mesh, tip, Vec3{0.0, b.load / (b.height * b.height), 0.0}, Amplitude(ramp(1.0, 1.0))));
  const StaticReport report = solveStatics(model, 1.0);
  Vec3 sum;
  const auto end = nodesWhere(mesh, [&](const Vec3& X) { return std::abs(X.x - b.length) < 1e-9 * b.length; });
  for (const int n : end) sum += model.nodes.u[static_cast<std::size_t>(n)];
  return {-sum.x / static_cast<double>(end.size()), sum.y / static_cast<double>(end.size()), report};
}

std::string elementName(ElementShape shape, Formulation formulation) {
  return formulation == Formulation::standard ? name(shape) : std::string(name(shape)) + " " + name(formulation);
}

/// Small deflection against P L³/(3 E I) with the fraction of shear, P L/(⅚ G A).
void smallDeflection(Table& table, const char* scene, Beam b, double tolerance) {
  const Stopwatch watch;
  const double section = b.height * b.height, inertia = section * section / 12.0;
  const double bending = b.length * b.length * b.length / (3.0 * b.young * inertia);
  const double shear = b.length / (5.0 / 6.0 * b.young / (2.0 * (1.0 + b.nu)) * section);
  b.load = 1e-4 * b.length / bending;
  const BeamResult result = bend(b);
  const double expected = b.load * (bending + shear), error = result.deflection / expected - 1.0;
  table.row(scene, elementName(b.shape, b.formulation),
            text("deflection %.5e m, beam %.5e m: %+.3f %%, %d iterations", result.deflection, expected, 100.0 * error,
                 static_cast<int>(result.report.iterations)),
            std::abs(error) < tolerance, watch.seconds());
}

void slenderness(Table& table) {
  for (const auto& [shape, formulation, cells] : {std::tuple(ElementShape::hex8, Formulation::enhanced, 100),
                                                  std::tuple(ElementShape::hex27, Formulation::standard, 50),
                                                  std::tuple(ElementShape::hex20, Formulation::standard, 50)}) {
    smallDeflection(table, "slenderness 1000, small load",
                    {1.0, 1e-3, 1e9, 0.0, {cells, 2, 2}, shape, formulation, 0.0}, 0.01);
    const Stopwatch watch;  // dead tip load P L²/(E I) = 1: w/L 0.30172, u/L 0.05643
    const double height = 1e-3, inertia = std::pow(height, 4) / 12.0;
    const BeamResult result = bend({1.0, height, 1e9, 0.0, {cells, 2, 2}, shape, formulation, 1e9 * inertia});
    const double error =
        std::max(std::abs(result.deflection / 0.30172 - 1.0), std::abs(result.shortening / 0.05643 - 1.0));
    table.row("slenderness 1000, elastica 1", elementName(shape, formulation),
              text("w/L %.5f (0.30172), u/L %.5f (0.05643), %zu steps, %d iterations", result.deflection,
                   result.shortening, result.report.steps.size(), static_cast<int>(result.report.iterations)),
              error < 0.005, watch.seconds());
  }
}

void aspectRatio(Table& table) {
  for (const auto& [shape, formulation] :
       {std::pair(ElementShape::hex8, Formulation::enhanced), std::pair(ElementShape::hex27, Formulation::standard)})
    smallDeflection(table, "aspect ratio 100", {8.0, 0.04, 1e9, 0.3, {4, 2, 2}, shape, formulation, 0.0}, 0.03);
}

void incompressible(Table& table) {
  for (const double nu : {0.499, 0.4999, 0.49999})
    for (const auto& [shape, formulation, height] : {std::tuple(ElementShape::hex8, Formulation::enhanced, 4),
                                                     std::tuple(ElementShape::hex8, Formulation::meanDilatation, 8),
                                                     std::tuple(ElementShape::hex27, Formulation::standard, 2)})
      smallDeflection(table, text("Poisson's ratio %.5f, bending", nu).c_str(),
                      {10.0, 1.0, 1e6, nu, {8 * height, height, height}, shape, formulation, 0.0}, 0.03);
}

/// Two bars end to end, one 1e6 times stiffer: the soft one takes all of the stretch.
void modulusRatio(Table& table) {
  for (const auto& [shape, formulation] :
       {std::pair(ElementShape::hex8, Formulation::standard), std::pair(ElementShape::hex8, Formulation::enhanced),
        std::pair(ElementShape::tet10, Formulation::standard)}) {
    const Stopwatch watch;
    SolidMesh mesh = boxOf(shape, {8, 2, 2}, {}, {2.0, 0.5, 0.5});
    std::vector<int>&soft = mesh.elementSets["soft"], &stiff = mesh.elementSets["stiff"];
    const auto n = static_cast<std::size_t>(nodesOf(shape));
    for (std::size_t e = 0; e < mesh.groups[0].size(); ++e) {
      double x = 0.0;
      for (std::size_t a = 0; a < n; ++a) x += mesh.X[static_cast<std::size_t>(mesh.groups[0].node[n * e + a])].x;
      (x < static_cast<double>(n) ? stiff : soft).push_back(static_cast<int>(e));
    }
    Model model = makeModel(mesh);
    const double young = 1e5, stretch = 1.5;
    model.add(makeSolid(mesh, pointMaterial(neoHookean(young, 0.0, 1.0)),
                        {.formulation = formulation, .elementSet = "soft", .name = "soft"}));
    model.add(makeSolid(mesh, pointMaterial(neoHookean(1e6 * young, 0.0, 1.0)),
                        {.formulation = formulation, .elementSet = "stiff", .name = "stiff"}));
    for (const int axis : {0, 1, 2})
      model.constraints.hold(nodesWhere(mesh, [&](const Vec3& X) { return X[axis] == 0.0; }), 1u << axis);
    // Sides are held, so that the answer is one-dimensional: P(λ) of a confined point.
    for (const int axis : {1, 2})
      model.constraints.hold(nodesWhere(mesh, [&](const Vec3& X) { return X[axis] == 0.5; }), 1u << axis);
    model.constraints.prescribe(nodesWhere(mesh, [](const Vec3& X) { return X.x == 2.0; }), 0,
                                [=](double t) { return (stretch - 1.0) * t; });
    const StaticReport report = solveStatics(model, 1.0);
    double interface = 0.0;
    for (const int node : nodesWhere(mesh, [](const Vec3& X) { return X.x == 1.0; }))
      interface = std::max(interface, std::abs(model.nodes.u[static_cast<std::size_t>(node)].x));
    const double bulk = young / 3.0, shear = young / 2.0;
    const double P = shear * std::pow(stretch, -2.0 / 3.0) * (stretch - (stretch * stretch + 2.0) / (3.0 * stretch)) +
                     0.5 * bulk * (stretch - 1.0 / stretch);
    const double expected = P / (1e6 * young);
    table.row("modulus ratio 1e6", elementName(shape, formulation),
              text("stiff end moves %.4e m, closed form %.4e m, %d iterations, %s", interface, expected,
                   static_cast<int>(report.iterations), report.solver.c_str()),
              std::abs(interface / expected - 1.0) < 1e-3, watch.seconds());
  }
}

/// A confined block pressed to a twentieth of its volume.
void crush(Table& table) {
  for (const auto& [shape, formulation] :
       {std::pair(ElementShape::hex8, Formulation::standard), std::pair(ElementShape::hex8, Formulation::enhanced),
        std::pair(ElementShape::hex8, Formulation::meanDilatation), std::pair(ElementShape::hex8, Formulation::reduced),
        std::pair(ElementShape::tet10, Formulation::standard)}) {
    const Stopwatch watch;
    const SolidMesh mesh = boxOf(shape, {2, 2, 2}, {}, {1.0, 1.0, 1.0});
    Model model = makeModel(mesh);
    const NeoHookean law = neoHookean(1e6, 0.3, 1000.0);
    Solid& solid = model.add(makeSolid(mesh, pointMaterial(law), {.formulation = formulation}));
    for (const int axis : {0, 1, 2})
      model.constraints.hold(nodesWhere(mesh, [&](const Vec3& X) { return X[axis] == 0.0; }), 1u << axis);
    for (const int axis : {1, 2})
      model.constraints.hold(nodesWhere(mesh, [&](const Vec3& X) { return X[axis] == 1.0; }), 1u << axis);
    model.constraints.prescribe(nodesWhere(mesh, [](const Vec3& X) { return X.x == 1.0; }), 0,
                                [](double t) { return -0.95 * t; });
    const StaticReport report = solveStatics(model, 1.0);
    const double J = 0.05, expected = law.shearModulus * std::pow(J, -2.0 / 3.0) * (J - (J * J + 2.0) / (3.0 * J)) +
                                      0.5 * law.bulkModulus * (J - 1.0 / J);
    const double P = solid.sample(model.nodes, {}).P[0];
    table.row("crushed to J = 0.05", elementName(shape, formulation),
              text("P %.6e Pa, closed form %.6e Pa, %zu steps, %d cuts", P, expected, report.steps.size(), report.cuts),
              std::abs(P / expected - 1.0) < 1e-6, watch.seconds());
  }
}

/// A bar of StVenantKirchhoff pressed past λ = 1/√3, where its force falls.
void limitPoint(Table& table) {
  const Stopwatch watch;
  const SolidMesh mesh = boxOf(ElementShape::hex8, {1, 1, 2}, {}, {1.0, 1.0, 2.0});
  Model model = makeModel(mesh);
  model.add(makeSolid(mesh, pointMaterial(Material(StVenantKirchhoff{1e6, 0.0, 1000.0}))));
  for (const int axis : {0, 1, 2})
    model.constraints.hold(nodesWhere(mesh, [&](const Vec3& X) { return X[axis] == 0.0; }), 1u << axis);
  model.constraints.prescribe(nodesWhere(mesh, [](const Vec3& X) { return X.z == 2.0; }), 2,
                              [](double t) { return -2.0 * t; });
  try {
    solveStatics(model, 0.6, {.firstStep = 0.02, .largestStep = 0.02, .smallestStep = 1e-4});
    table.row("St Venant-Kirchhoff past 1/sqrt(3)", "hex8", "ran on", false, watch.seconds());
  } catch (const NumericalError& error) {
    const std::string what = error.what();
    const bool named = what.find("limit point") != std::string::npos;
    const double last = 1.0 - model.t;
    table.row("St Venant-Kirchhoff past 1/sqrt(3)", "hex8",
              text("stopped, last stretch %.4f (0.5774), reason %s", last, named ? "names the limit point" : "MISSING"),
              named && std::abs(last - 1.0 / std::sqrt(3.0)) < 2e-3, watch.seconds());
  }
}

/// Free vibration by central differences: energy at the end over that at the start.
double vibrate(Model& model, Solid& solid, double dt, int steps, double& largest) {
  Nodes& nodes = model.nodes;
  const auto total = [&] { return kineticEnergy(nodes) + solid.energy(nodes, {}); };
  const double before = total();
  largest = 0.0;
  const auto force = [&] {
    clearForces(nodes);
    solid.addForces(nodes, {}, nodes.f);
  };
  force();
  for (int step = 0; step < steps; ++step) {
    kick(nodes, 0.5 * dt);
    drift(nodes, dt);
    force();
    kick(nodes, 0.5 * dt);
    if (step % std::max(1, steps / 200) == 0 || step > steps - 10) {
      const double now = total();
      largest = std::max(largest, std::isfinite(now) ? std::abs(now / before - 1.0) : 1e300);
      if (!(largest < 1e6)) break;
    }
  }
  return largest;
}

/// The integrator refuses a step above the bound of the elements, and says which one sets it.
void refusedStep(Table& table) {
  const Stopwatch watch;
  const SolidMesh mesh = boxOf(ElementShape::hex8, {2, 2, 6}, {}, {0.2, 0.2, 0.6});
  Model model = makeModel(mesh);
  model.add(makeSolid(mesh, pointMaterial(Material(StVenantKirchhoff{1e7, 0.3, 1000.0}))));
  addMass(model);
  const double bound = stableStep(model).dt;
  ExplicitIntegrator(model, 0.99 * bound).step();
  try {
    ExplicitIntegrator(model, 1.01 * bound).step();
    table.row("step of 1.01 of the bound", "hex8", "ran on", false, watch.seconds());
  } catch (const InputError& error) {
    const bool named = std::string(error.what()).find("element ") != std::string::npos;
    table.row("step of 1.01 of the bound", "hex8",
              text("refused by ExplicitIntegrator, element %s", named ? "named" : "MISSING"), named, watch.seconds());
  }
}

void explicitLimit(Table& table, int longRun) {
  for (const auto& [fraction, steps] : {std::pair(0.99, 20000), std::pair(1.01, 20000), std::pair(0.5, longRun)}) {
    const Stopwatch watch;
    const SolidMesh mesh = boxOf(ElementShape::hex8, {2, 2, 6}, {}, {0.2, 0.2, 0.6});
    Model model = makeModel(mesh);
    Solid& solid = model.add(makeSolid(mesh, pointMaterial(Material(StVenantKirchhoff{1e7, 0.3, 1000.0}))));
    addMass(model);
    const double limit = assembledStableStep(model, 1e-8), bound = stableStep(model).dt;
    for (std::size_t n = 0; n < model.nodes.X.size(); ++n)
      model.nodes.v[n] = 1e-3 * Vec3{std::sin(9.0 * model.nodes.X[n].z), std::cos(7.0 * model.nodes.X[n].z),
                                     std::sin(11.0 * model.nodes.X[n].x)};
    double largest = 0.0;
    vibrate(model, solid, fraction * limit, steps, largest);
    const bool good = fraction < 0.98 ? largest < 0.02 : (fraction < 1.0 ? largest < 30.0 : largest > 1e6);
    table.row(fraction > 1.0   ? "1.01 of the limit, unchecked"
              : fraction > 0.9 ? "0.99 of the limit, unchecked"
                               : "long run at half the limit",
              "hex8",
              text("limit %.4e s (bound by elements %.4e s), %d steps, largest change of energy %.2e of it", limit,
                   bound, steps, largest),
              good, watch.seconds());
  }
}

/// The same block near the origin and a million sizes away from it.
void farAway(Table& table) {
  for (const auto& [shape, formulation] :
       {std::pair(ElementShape::hex8, Formulation::standard), std::pair(ElementShape::hex8, Formulation::enhanced),
        std::pair(ElementShape::tet10, Formulation::standard)}) {
    const Stopwatch watch;
    double deflection[2];
    for (const bool far : {false, true}) {
      SolidMesh mesh = boxOf(shape, {2, 2, 8}, {}, {0.25, 0.25, 1.0});
      if (far)
        for (Vec3& X : mesh.X) X += {1e6, -1e6, 1e6};
      Model model = makeModel(mesh);
      model.add(makeSolid(mesh, pointMaterial(neoHookean(1e6, 0.3, 1000.0)), {.formulation = formulation}));
      addMass(model);
      fix(model.nodes, nodeSet(mesh, "z-"));
      model.add(gravity({2.0, 0.0, 0.0}));
      solveStatics(model, 1.0, {.firstStep = 1.0});
      deflection[far] = model.nodes.u[static_cast<std::size_t>(nodeSet(mesh, "z+")[0])].x;
    }
    const double error = deflection[1] / deflection[0] - 1.0;  // positions are known to 1e-10 of the element there
    table.row("1e6 m from the origin", elementName(shape, formulation),
              text("tip moves %.9e m, at the origin %.9e m: %+.1e", deflection[1], deflection[0], error),
              std::abs(error) < 1e-8, watch.seconds());
  }
}

/// A confined block that is pressed to a fifth of its height at a sixteenth of its speed of sound, with the shocks that
/// run up and down in it.
void crushedInFlight(Table& table) {
  for (const double safety : {0.0, 0.8}) {
    const Stopwatch watch;
    const SolidMesh mesh = boxOf(ElementShape::hex8, {1, 1, 16}, {}, {0.1, 0.1, 1.0});
    Model model = makeModel(mesh);
    model.add(makeSolid(mesh, pointMaterial(neoHookean(1e6, 0.0, 1000.0))));
    addMass(model);
    for (const int axis : {0, 1}) model.constraints.hold(nodeSet(mesh, "skin"), 1u << axis);
    model.constraints.hold(nodeSet(mesh, "z-"), componentZ);
    model.constraints.prescribe(nodeSet(mesh, "z+"), 2, [](double t) { return -0.8 * std::min(1.0, t / 0.4); });
    try {
      ExplicitIntegrator run(model, 0.9 * stableStep(model).dt, {.checkEvery = 10, .safety = safety});
      while (model.t < 0.5) run.step();
      run.run(1);
      const DynamicsReport report = run.report();
      const double input = run.ledger().storedMax();
      const double residual = std::abs(run.ledger().residual()) / input;
      table.row("pressed to 0.2 in motion", safety > 0.0 ? "step follows" : "fixed step",
                text("steps %.2e to %.2e s, element %d, residual %.1e of the energy", report.stepRange.shortest,
                     report.stepRange.longest, report.stepRange.element, residual),
                safety > 0.0 && residual < 0.02, watch.seconds());
    } catch (const NumericalError& error) {
      table.row("pressed to 0.2 in motion", safety > 0.0 ? "step follows" : "fixed step",
                text("stopped at t = %.3f s: %.60s", model.t, error.what()), safety == 0.0, watch.seconds());
    }
  }
}

/// Soil whose cohesion falls to a hundredth of its first value, sheared far: it flows, and never gives energy back.
void softened(Table& table) {
  const Stopwatch watch;
  const SolidMesh mesh = boxOf(ElementShape::hex8, {1, 1, 1}, {}, {1.0, 1.0, 1.0});
  Model model = makeModel(mesh);
  DruckerPrager soil{50e6, 0.25, 2000.0, 0.0, 0.5, 0.1, ConeMatch::compression, saturatingYield(1e6, 0.0, 1e4, 30.0)};
  model.add(makeSolid(mesh, pointMaterial(soil), {.formulation = Formulation::meanDilatation}));
  model.constraints.hold(nodeSet(mesh, "z-"));
  model.constraints.hold(nodeSet(mesh, "z+"), componentY);
  model.constraints.prescribe(nodeSet(mesh, "z+"), 2, [](double t) { return -1e-3 * t; });
  model.constraints.prescribe(nodeSet(mesh, "z+"), 0, [](double t) { return 0.5 * t; });
  const StaticReport report = solveStatics(model, 1.0, {.firstStep = 0.01, .largestStep = 0.05});
  table.row("soil that softens to 1 %", "hex8 mean dilatation",
            text("%zu steps, %d cuts, dissipated %.3e J, residual %+.1e J", report.steps.size(), report.cuts,
                 report.dissipated, report.energyResidual()),
            report.dissipated > 0.0 && std::abs(report.energyResidual()) < 0.05 * report.dissipated, watch.seconds());
}

/// Cells of which one fails at a stretch of 1.2: the run stops there, in its last equilibrium, and names it.
void failingPoint(Table& table) {
  struct Cell : FieldPoint {
    bool weak;
    explicit Cell(bool isWeak) : weak(isWeak) {}
    void evaluate(std::span<const double, 9> F, double, bool, PointAnswer answer) override {
      if (weak && F[8] > 1.2) throw NumericalError("the grains of the cell do not settle", "cell", "");
      answer.energy = answer.dissipated = 0.0;
      for (std::size_t k = 0; k < 9; ++k) {
        const double H = F[k] - (k % 4 == 0 ? 1.0 : 0.0);
        answer.P[k] = 1e6 * H;
        answer.energy += 0.5e6 * H * H;
      }
      for (std::size_t k = 0; k < answer.tangent.size(); ++k) answer.tangent[k] = k % 10 == 0 ? 1e6 : 0.0;
    }
    void commit() override {}
    void revert() override {}
    void save(ByteWriter&) const override {}
    void load(ByteReader&) override {}
  };
  const Stopwatch watch;
  const SolidMesh mesh = boxOf(ElementShape::hex8, {2, 2, 4}, {}, {0.5, 0.5, 1.0});
  Model model = makeModel(mesh);
  model.add(makeSolid(
      mesh, pointField({.name = "cells", .density = 1000.0, .isSymmetric = true}, [](const PointPlace& place) {
        return std::make_unique<Cell>(place.element == 9 && place.point == 5);
      })));
  model.constraints.hold(nodeSet(mesh, "z-"));
  model.constraints.prescribe(nodeSet(mesh, "z+"), 2, [](double t) { return t; });
  try {
    solveStatics(model, 1.0, {.firstStep = 0.05, .smallestStep = 1e-4});
    table.row("a point without an answer", "hex8", "ran on", false, watch.seconds());
  } catch (const NumericalError& error) {
    const std::string what = error.what();
    const bool named = what.find("element 9") != std::string::npos && what.find("point 5") != std::string::npos;
    table.row(
        "a point without an answer", "hex8",
        text("stopped at a stretch of %.4f (1.2), element and point %s", 1.0 + model.t, named ? "named" : "MISSING"),
        named && std::abs(model.t - 0.2) < 2e-4, watch.seconds());
  }
}

/// A study that throws is a failure with its reason.
void guarded(Table& table, void (*study)(Table&)) {
  try {
    study(table);
  } catch (const Error& error) {
    table.row("stopped", "", error.what(), false, 0.0);
  }
}

}  // namespace

int main(int argc, char** argv) {
  bool quick = false;
  program::Options options("fem_extremes", "Extreme cases of the solid engine, beside what is known of them.");
  options.flag("--quick", quick, "fewer explicit steps");
  return program::runProgram(options, argc, argv, [&] {
    setThreads(1);
    Table table;
    for (const auto& study : {modulusRatio, slenderness, aspectRatio, incompressible, crush, limitPoint, refusedStep,
                              farAway, crushedInFlight, softened, failingPoint})
      guarded(table, study);
    explicitLimit(table, quick ? 20000 : 1000000);
    std::printf("%d rows are not as they should be\n", table.failures);
    return table.failures == 0;
  });
}
