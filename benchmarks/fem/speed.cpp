// Time of what a step of a solid consists of: forces and tangent per element, and implicit steps of two beams.
//
// usage: fem_speed [--threads N] [--beams] [--cube N] [--elements] [--memory] [--leaving-out] [--solvers]
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "dovetail/core/parallel.hpp"
#include "dovetail/core/team.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/plasticity.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/fem/laws/viscosity.hpp"
#include "dovetail/fem/model/model.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "dovetail/fem/solve/linear_solver.hpp"
#include "dovetail/fem/solve/statics.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "dovetail/linalg/block_matrix.hpp"
#include "dovetail/linalg/multigrid.hpp"
#include "dovetail/linalg/partition.hpp"
#include "program/run.hpp"

namespace {

using namespace dovetail;
using namespace dovetail::fem;

/// Median time of `samples` calls, s, after one that is not counted.
double median(int samples, const std::function<void()>& call) {
  call();
  std::vector<double> seconds;
  for (int s = 0; s < samples; ++s) {
    const auto start = std::chrono::steady_clock::now();
    call();
    seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  std::nth_element(seconds.begin(), seconds.begin() + samples / 2, seconds.end());
  return seconds[static_cast<std::size_t>(samples / 2)];
}

struct Kind {
  ElementShape shape;
  Formulation formulation;
  std::array<int, 3> cells;
};

void bend(Nodes& nodes, double amplitude = 1e-3) {
  for (std::size_t n = 0; n < nodes.X.size(); ++n) {
    const Vec3& X = nodes.X[n];
    nodes.u[n] = amplitude * Vec3{std::sin(3.0 * X.z), std::cos(2.0 * X.z), std::sin(X.x)};
  }
}

struct NamedLaw {
  bool onHex8Only;
  std::shared_ptr<const PointMaterial> material;
};

std::vector<NamedLaw> timedLaws() {
  const auto elastic = pointMaterial(Material(StVenantKirchhoff{1e6, 0.3, 1000.0}));
  return {{false, elastic},
          {false, pointMaterial(neoHookean(1e6, 0.3, 1000.0))},
          {true, pointMaterial(Hencky{1e6, 0.3, 1000.0})},
          {true, pointMaterial(J2Plasticity{1e6, 0.3, 1000.0, linearYield(1e3, 1e5)})},
          {true, pointMaterial(DruckerPrager{1e6, 0.3, 1000.0, 1e3, 0.6, 0.2})},
          {true, pointMaterial(kelvinVoigt(elastic, 1e-6, 1e6, 0.3))}};
}

/// Times per element, ns, of calls at states that differ by 1e-4 of the displacement gradient from one to the next.
struct ElementTimes {
  double forces[2], tangent[2];  ///< on one thread and on several
};
ElementTimes timeSolid(Solid& solid, const SolidMesh& mesh, int threadCount) {
  Model model = makeModel(mesh);
  Nodes states[2] = {model.nodes, model.nodes};
  bend(states[0], 1e-3);
  bend(states[1], 1.05e-3);
  linalg::MatrixPattern pattern(mesh.X.size());
  solid.addPattern(pattern);
  linalg::BlockMatrix K(std::move(pattern));
  ElementTimes times{};
  for (int run = 0; run < 2; ++run) {
    setThreads(run == 0 ? 1 : threadCount);
    const double scale = 1e9 / static_cast<double>(solid.size());
    int turn = 0;
    times.forces[run] = scale * median(15, [&] { solid.addForces(states[++turn % 2], {}, model.nodes.f); });
    times.tangent[run] = scale * median(5, [&] { solid.addTangent(states[++turn % 2], {}, K); });
  }
  return times;
}

void timeElements(int threadCount) {
  const std::vector<Kind> kinds = {{ElementShape::hex8, Formulation::standard, {10, 10, 150}},
                                   {ElementShape::hex8, Formulation::assumedStress, {10, 10, 150}},
                                   {ElementShape::hex8, Formulation::enhanced, {10, 10, 150}},
                                   {ElementShape::hex8, Formulation::meanDilatation, {10, 10, 150}},
                                   {ElementShape::hex8, Formulation::reduced, {10, 10, 150}},
                                   {ElementShape::hex20, Formulation::standard, {5, 5, 75}},
                                   {ElementShape::hex27, Formulation::standard, {5, 5, 75}},
                                   {ElementShape::tet4, Formulation::standard, {10, 10, 50}},
                                   {ElementShape::tet10, Formulation::standard, {5, 5, 40}}};
  std::printf("%-6s %-16s %-22s %8s | forces, ns: 1 thread, %d, ratio | tangent, ns: 1 thread, %d, ratio | bytes\n",
              "shape", "formulation", "law", "elements", threadCount, threadCount);
  for (const Kind& kind : kinds)
    for (const auto& [onHex8Only, law] : timedLaws()) {
      if (kind.formulation == Formulation::assumedStress && !law->brickLaw()) continue;
      if (onHex8Only && kind.shape != ElementShape::hex8) continue;
      const SolidMesh mesh = boxOf(kind.shape, kind.cells, {}, {1.0, 1.0, 15.0});
      const auto solid = makeSolid(mesh, law, {.formulation = kind.formulation});
      const auto& [forces, tangent] = timeSolid(*solid, mesh, threadCount);
      std::printf("%-6s %-16s %-22s %8zu | %8.1f %8.1f %5.2f | %9.0f %9.0f %5.2f | %.0f\n", name(kind.shape),
                  name(kind.formulation), law->name().c_str(), solid->size(), forces[0], forces[1],
                  forces[0] / forces[1], tangent[0], tangent[1], tangent[0] / tangent[1],
                  static_cast<double>(solid->memory()) / static_cast<double>(solid->size()));
    }
}

/// Implicit steps of a cantilever under a sudden force at its tip: E 1 MPa, ν 0.3, ρ 1000 kg/m³, width 1 m.
void timeBeam(std::array<int, 3> cells, Formulation formulation, double tolerance, int steps) {
  const double length = static_cast<double>(cells[2]) / cells[0], dt = 1e-2;
  const SolidMesh mesh = boxOf(ElementShape::hex8, cells, {}, {1.0, 1.0, length});
  Model model = makeModel(mesh);
  model.add(
      makeSolid(mesh, pointMaterial(Material(StVenantKirchhoff{1e6, 0.3, 1000.0})), {.formulation = formulation}));
  addMass(model);
  fix(model.nodes, nodeSet(mesh, "z-"));
  const std::vector<int>& tip = nodeSet(mesh, "z+");
  model.add(nodalForce(tip, {2000.0 / static_cast<double>(tip.size()), 0.0, 0.0}));
  ImplicitIntegrator solver(model, dt, {.scheme = newmark(), .relativeTolerance = tolerance, .energyEvery = 0});
  std::vector<double> seconds;
  double atTen = 0.0;
  for (int step = 0; step < steps; ++step) {
    const auto start = std::chrono::steady_clock::now();
    solver.step();
    seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    if (step == 9) atTen = model.nodes.u[static_cast<std::size_t>(tip[0])].x;
  }
  double total = 0.0;
  for (const double s : seconds) total += s;
  std::vector<double> sorted(seconds.begin() + 1, seconds.end());
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
  const DynamicsReport report = solver.report();
  std::printf(
      "beam %dx%dx%d %s tolerance %.0e: mean %.3f ms/step, median %.3f ms, first %.1f ms, %.1f iterations, %lld "
      "factorisations, tip u_x after 10 steps %.6e m\n",
      cells[0], cells[1], cells[2], name(formulation), tolerance, 1e3 * total / static_cast<double>(steps),
      1e3 * sorted[sorted.size() / 2], 1e3 * seconds[0], static_cast<double>(report.iterations) / steps,
      static_cast<long long>(report.factorisations), atTen);
}

void timeBeams() {
  for (const Formulation formulation : {Formulation::standard, Formulation::assumedStress})
    for (const double tolerance : {1e-5, 1e-10}) timeBeam({2, 2, 30}, formulation, tolerance, 110);
  for (const double tolerance : {1e-5, 1e-10}) timeBeam({10, 10, 150}, Formulation::standard, tolerance, 20);
}

/// A body of a cube of E 1 MPa, by the name of its law.
std::shared_ptr<Solid> cubeOf(const SolidMesh& mesh, const std::string& law, bool onRanks) {
  if (law == "nearly-incompressible")
    return makeSolid(mesh, pointMaterial(neoHookean(1e6, 0.499, 1000.0)),
                     {.formulation = Formulation::meanDilatation, .onRanks = onRanks});
  if (law == "drucker-prager")
    return makeSolid(mesh,
                     pointMaterial(DruckerPrager{.youngsModulus = 1e6,
                                                 .poissonRatio = 0.3,
                                                 .density = 1000.0,
                                                 .cohesion = 5e3,
                                                 .frictionAngle = 0.5,
                                                 .dilatancyAngle = 0.1}),
                     {.onRanks = onRanks});
  return makeSolid(mesh, pointMaterial(Material(StVenantKirchhoff{1e6, 0.3, 1000.0})), {.onRanks = onRanks});
}

/// A cube of n³ bricks of 1 m, E 1 MPa, by default St Venant-Kirchhoff with ν 0.3, clamped below and pressed by a
/// fraction of its height between rough platens, in one step.
void timeCube(int n, double fraction, linalg::LinearMethod method, const std::string& law) {
  const auto start = std::chrono::steady_clock::now();
  const SolidMesh mesh = boxOf(ElementShape::hex8, {n, n, n}, {}, {1.0, 1.0, 1.0});
  Model model = makeModel(mesh);
  Solid& solid = model.add(cubeOf(mesh, law, method == linalg::LinearMethod::multigrid));
  model.constraints.hold(nodeSet(mesh, "z-"));
  model.constraints.hold(nodeSet(mesh, "z+"), componentX | componentY);
  model.constraints.prescribe(nodeSet(mesh, "z+"), 2, [fraction](double t) { return -fraction * t; });
  const double tolerance = method == linalg::LinearMethod::multigrid ? 1e-5 : 1e-2;  // multigrid loosens it itself
  const StaticReport report = solveStatics(model, 1.0,
                                           {.newton = {.relativeTolerance = 1e-6,
                                                       .reuseContraction = 0.3,
                                                       .linear = {.method = method, .relativeTolerance = tolerance}},
                                            .firstStep = 1.0});
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::vector<Vec3> f(mesh.X.size());
  solid.addForces(model.nodes, {}, f);
  double force = 0.0;
  for (const int node : nodeSet(mesh, "z+")) force += f[static_cast<std::size_t>(node)].z;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const double ownSeconds =
      static_cast<double>(usage.ru_utime.tv_sec) + 1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
  const double memory = static_cast<double>(usage.ru_maxrss) / 1024.0;
  const double busiest = team().largest(ownSeconds), all = team().sum(ownSeconds), most = team().largest(memory);
  if (team().rank() > 0) return;
  std::printf(
      "cube %d %s ranks %d threads %d %s: %.2f s (assembly %.2f, solver %.2f), %lld iterations, %lld factorisations, "
      "%lld "
      "linear "
      "iterations, force %.9e N, %.0f MB at the most, user CPU %.2f s in all, %.2f s of the busiest\n",
      n, law.c_str(), team().size(), threads(), report.solver.c_str(), seconds, report.assemblySeconds,
      report.solverSeconds, static_cast<long long>(report.iterations), static_cast<long long>(report.factorisations),
      static_cast<long long>(report.linearIterations), force, most, all, busiest);
}

/// Bytes per brick without the arrays of the nodes, after explicit forces on one and two threads, and after a tangent.
void countBytes() {
  std::printf("%-10s %-16s | bytes: forces, 1 thread, 2 threads, after a tangent\n", "bricks", "formulation");
  for (const bool distorted : {false, true})
    for (const Formulation formulation : {Formulation::standard, Formulation::assumedStress}) {
      SolidMesh mesh = boxOf(ElementShape::hex8, {20, 20, 40}, {}, {1.0, 1.0, 2.0});
      if (distorted)
        for (Vec3& X : mesh.X) X.x += 0.01 * std::sin(9.0 * X.y + 5.0 * X.z);
      Model model = makeModel(mesh);
      Solid& solid = model.add(
          makeSolid(mesh, pointMaterial(Material(StVenantKirchhoff{1e6, 0.3, 1000.0})), {.formulation = formulation}));
      const auto each = [&] { return static_cast<double>(solid.memory()) / static_cast<double>(solid.size()); };
      double bytes[3];
      for (const int count : {1, 2}) {
        setThreads(count);
        solid.addForces(model.nodes, {}, model.nodes.f);
        bytes[count - 1] = each();
      }
      setThreads(1);
      linalg::BlockMatrix K(zeroTangent(model));
      solid.addTangent(model.nodes, {}, K);
      bytes[2] = each();
      std::printf("%-10s %-16s | %.0f %.0f %.0f\n", distorted ? "distorted" : "boxes", name(formulation), bytes[0],
                  bytes[1], bytes[2]);
    }
}

/// Explicit steps of an elastic beam: the verbs alone, a model of nothing but the solid, and what each part costs that
/// is present but idle.
void timeLeavingOut() {
  const SolidMesh mesh = boxOf(ElementShape::hex8, {10, 10, 150}, {}, {1.0, 1.0, 15.0});
  const StVenantKirchhoff law{1e6, 0.3, 1000.0};
  const double dt = 1e-4;
  constexpr int steps = 40, samples = 15;
  struct Scene {
    std::string label;
    std::function<void()> steps;
    std::vector<double> seconds;
  };
  std::vector<Scene> scenes;
  Model bare = makeModel(mesh);
  const auto elastic = pointMaterial(Material(law));
  Solid& alone = bare.add(makeSolid(mesh, elastic));
  addMass(bare);
  bend(bare.nodes);
  scenes.push_back({"by hand: kick, drift, forces",
                    [&] {
                      for (int step = 0; step < steps; ++step) {
                        kick(bare.nodes, 0.5 * dt);
                        drift(bare.nodes, dt);
                        clearForces(bare.nodes);
                        alone.addForces(bare.nodes, {}, bare.nodes.f);
                        kick(bare.nodes, 0.5 * dt);
                      }
                    },
                    {}});
  std::vector<std::unique_ptr<Model>> models;
  std::vector<std::unique_ptr<ExplicitIntegrator>> integrators;
  const auto addScene = [&](const std::string& label, const std::shared_ptr<const PointMaterial>& material,
                            const std::shared_ptr<Term>& extra) {
    models.push_back(std::make_unique<Model>(makeModel(mesh)));
    Model& model = *models.back();
    model.add(makeSolid(mesh, material));
    if (extra) model.add(extra);
    addMass(model);
    bend(model.nodes);
    integrators.push_back(
        std::make_unique<ExplicitIntegrator>(model, dt, ExplicitOptions{.energyEvery = 0, .checkEvery = 0}));
    scenes.push_back({label, [integrator = integrators.back().get()] { integrator->run(steps); }, {}});
  };
  addScene("model, elastic", elastic, nullptr);
  addScene("model, elastic, again", elastic, nullptr);
  addScene("model, with mass damping", elastic, massDamping(1.0));
  addScene("model, with viscosity", pointMaterial(kelvinVoigt(elastic, 1e-6, 1e6, 0.3)), nullptr);
  addScene("model, neo-Hookean", pointMaterial(neoHookean(1e6, 0.3, 1000.0)), nullptr);
  for (int sample = 0; sample < samples; ++sample)
    for (Scene& scene : scenes) {
      const auto start = std::chrono::steady_clock::now();
      scene.steps();
      scene.seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
  std::printf("explicit steps of %zu bricks, one thread, turn by turn\n", mesh.elementCount());
  double reference = 0.0;
  for (Scene& scene : scenes) {
    std::nth_element(scene.seconds.begin(), scene.seconds.begin() + samples / 2, scene.seconds.end());
    const double each = 1e9 * scene.seconds[samples / 2] / steps / static_cast<double>(mesh.elementCount());
    if (reference == 0.0) reference = each;
    std::printf("%-40s %7.1f ns per element and step, %+6.1f %%\n", scene.label.c_str(), each,
                100.0 * (each / reference - 1.0));
  }
}

/// One linear system of a cube that is pressed on one side, solved twice by each method up to the size that suits it.
/// Levels of multigrid are made by the first solution.
void timeSolvers() {
  struct Way {
    linalg::LinearMethod method;
    const char* name;
    int largest;
  };
  std::vector<Way> ways{{linalg::LinearMethod::direct, "direct", 32},
                        {linalg::LinearMethod::conjugateGradients, "conjugate gradients", 32}};
  if (linalg::Multigrid::available()) ways.push_back({linalg::LinearMethod::multigrid, "multigrid", 69});
  std::printf("%-10s %9s  %-20s %10s %19s %10s\n", "cube", "unknowns", "method", "factor, s", "first solution, s",
              "second, s");
  for (const int n : {8, 16, 24, 32, 47, 69}) {
    const SolidMesh mesh = boxOf(ElementShape::hex8, {n, n, n}, {}, {1.0, 1.0, 1.0});
    Model model = makeModel(mesh);
    model.add(makeSolid(mesh, pointMaterial(neoHookean(1e6, 0.3, 1000.0))));
    model.constraints.hold(nodeSet(mesh, "z-"));
    const DofMap dofs(model.constraints, model.nodes);
    linalg::BlockMatrix K = zeroTangent(model);
    model.terms[0]->addTangent(model.nodes, {}, K);
    std::vector<Vec3> load(mesh.X.size());
    for (const int node : nodeSet(mesh, "z+")) load[static_cast<std::size_t>(node)] = {1.0, 0.0, -2.0};
    std::vector<double> r(dofs.size()), x(dofs.size());
    dofs.reduce(load, r);
    for (const Way& way : ways) {
      if (n > way.largest) continue;
      LinearSolver solver(dofs, {.method = way.method}, &model.nodes);
      double seconds[3];
      auto start = std::chrono::steady_clock::now();
      const auto lap = [&] {
        const auto last = std::exchange(start, std::chrono::steady_clock::now());
        return std::chrono::duration<double>(start - last).count();
      };
      if (!solver.factor(K, true)) std::printf("the matrix is singular\n");
      seconds[0] = lap();
      for (int k = 1; k < 3; ++k) solver.solve(r, x), seconds[k] = lap();
      std::printf("%2dx%2dx%2d   %9zu  %-20s %10.3f %19.3f %10.4f", n, n, n, dofs.size(), way.name, seconds[0],
                  seconds[1], seconds[2]);
      if (solver.iterations() > 0)
        std::printf("  %lld iterations each", static_cast<long long>(solver.iterations() / 2));
      std::printf("\n");
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  int threadCount = 2;
  std::optional<int> cube;
  double press = 0.1;
  std::string law = "st-venant-kirchhoff";
  bool beams = false, elements = false, memory = false, leavingOut = false, solvers = false, multigrid = false;
  program::Options options("fem_speed", "Times the solid engine: all parts, or those that are named.");
  options.integer("--threads N", threadCount, 1, 1024, "of elements and cubes");
  options.flag("--beams", beams, "statics of beams, one thread");
  options.integer("--cube N", cube, 1, 1000, "a cube of N elements each way, pressed in one step");
  options.number("--press F", press, program::positive("a fraction above 0, up to 0.5", 0.5),
                 "fraction of its height that the cube is pressed by");
  options.word("--law", law, "st-venant-kirchhoff|nearly-incompressible|drucker-prager", "of the cube");
  options.flag("--multigrid", multigrid,
               "the cube by multigrid in place of conjugate gradients, and by all ranks under mpirun");
  options.flag("--elements", elements, "internal forces and stiffness, by element");
  options.flag("--memory", memory, "bytes per element");
  options.flag("--leaving-out", leavingOut, "what parts of a step cost");
  options.flag("--solvers", solvers, "linear systems by factors, conjugate gradients and multigrid");
  return program::runProgram(options, argc, argv, [&] {
    const bool all = !beams && !cube && !elements && !memory && !leavingOut && !solvers;
    if (elements || all) timeElements(threadCount);
    setThreads(threadCount);
    if (cube && multigrid) linalg::meetRanks();
    if (cube)
      timeCube(*cube, press, multigrid ? linalg::LinearMethod::multigrid : linalg::LinearMethod::conjugateGradients,
               law);
    setThreads(1);
    if (beams || all) {
      std::printf("one thread, %s\n", linalg::SparseCholesky::name());
      timeBeams();
    }
    if (memory || all) countBytes();
    if (leavingOut || all) timeLeavingOut();
    if (solvers || all) timeSolvers();
    return true;
  });
}
