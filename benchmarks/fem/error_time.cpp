// Error against run time of every element: bending, torsion, a nearly incompressible membrane, a plastic tube.
//
// usage: fem_error_time [--quick] [--csv FILE]
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "plasticity_scenes.hpp"
#include "program/run.hpp"
#include "verification_cases.hpp"

namespace {

using namespace dovetail;
using fem::ElementShape;
using fem::Formulation;
using verification::ElementKind;

/// What a case gives for an element and a number of cells, and what it should give.
struct Case {
  const char* name;
  double reference;
  std::function<double(const ElementKind&, int)> solve;
  std::vector<int> bricks, higher;  ///< cells of first and second order elements
};

/// Stored energy of a square bar (1 × 1 × 4 m) twisted by a small angle with free warping, J.
double twist(const ElementKind& kind, int cells) {
  constexpr double length = 4.0, angle = 1e-4;
  const fem::SolidMesh mesh = fem::boxOf(kind.shape, {cells, cells, 2 * cells}, {-0.5, -0.5, 0.0}, {0.5, 0.5, length});
  fem::Model model = fem::makeModel(mesh);
  model.add(
      fem::makeSolid(mesh, fem::pointMaterial(fem::neoHookean(1e6, 0.3, 1000.0)), {.formulation = kind.formulation}));
  model.constraints.hold(fem::nodeSet(mesh, "z-"), fem::componentX | fem::componentY);
  for (const int node : fem::nodeSet(mesh, "z+")) {
    const Vec3& X = mesh.X[static_cast<std::size_t>(node)];
    model.constraints.prescribe(std::span(&node, 1), 0, [y = X.y](double t) { return -angle * t * y; });
    model.constraints.prescribe(std::span(&node, 1), 1, [x = X.x](double t) { return angle * t * x; });
  }
  for (std::size_t n = 0; n < mesh.X.size(); ++n)
    if (norm(mesh.X[n]) < 1e-9) {
      const int axis = static_cast<int>(n);
      model.constraints.hold(std::span(&axis, 1), fem::componentZ);
    }
  return fem::solveStatics(model, 1.0, {.firstStep = 1.0}).storedAfter;
}

/// ½ G J φ²/L with J of the square by de Saint-Venant's series.
double twistEnergy() {
  constexpr double pi = std::numbers::pi;
  double sum = 0.0;
  for (int n = 1; n < 60; n += 2) sum += std::tanh(n * pi / 2.0) / std::pow(n, 5);
  return 0.5 * 1e6 / 2.6 * (1.0 / 3.0 - 64.0 / std::pow(pi, 5) * sum) * 1e-8 / 4.0;
}

double tubePressure(const ElementKind& kind, int refinement) {
  fem::Tube tube;
  tube.shape = kind.shape;
  tube.formulation = kind.formulation;
  tube.radial = 5 * refinement;
  tube.around = 3 * refinement;
  return fem::pressurise(tube).pressure.back();
}

std::vector<Case> cases(bool quick) {
  const ElementKind best{ElementShape::hex27, Formulation::meanDilatation};
  const double membrane = verification::cooksMembrane(best, quick ? 8 : 32, 0.4999).tip;
  return {{"bending",
           verification::elastica(2.0).w,
           [](const ElementKind& kind, int n) {
             return verification::bentCantilever(kind, {10 * n, n}, 2.0).w;
           },
           {1, 2, 4, 8},
           {1, 2, 4}},
          {"torsion", twistEnergy(), twist, {2, 4, 8, 12}, {2, 4, 6}},
          {"nearly incompressible",
           membrane,
           [](const ElementKind& kind, int n) { return verification::cooksMembrane(kind, n, 0.4999).tip; },
           {4, 8, 16, 32},
           {2, 4, 8, 16}},
          {"plastic tube", fem::Tube::limitPressure(), tubePressure, {1, 2, 4}, {1, 2}}};
}

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

void study(const Case& scene, bool quick, std::FILE* csv) {
  std::printf("\n%s: error, %% (seconds)\n", scene.name);
  for (const ElementKind& kind : verification::allKinds()) {
    const std::vector<int>& meshes = fem::nodesOf(kind.shape) > 8 ? scene.higher : scene.bricks;
    std::printf("%-24s", kind.label().c_str());
    for (std::size_t k = 0; k < (quick ? 1 : meshes.size()); ++k) {
      const double start = now();
      try {
        const double error = scene.solve(kind, meshes[k]) / scene.reference - 1.0, seconds = now() - start;
        std::printf("  %9.4f (%7.3f)", 100.0 * error, seconds);
        if (csv != nullptr)
          std::fprintf(csv, "%s,%s,%d,%.6g,%.6g\n", scene.name, kind.label().c_str(), meshes[k], error, seconds);
      } catch (const NumericalError& error) {
        std::printf("  stopped: %.60s", error.what());
        break;
      }
    }
    std::printf("\n");
  }
}

}  // namespace

int main(int argc, char** argv) {
  bool quick = false;
  std::string file;
  program::Options options("fem_error_time", "Error against time of element kinds and meshes.");
  options.flag("--quick", quick, "the coarsest meshes");
  options.text("--csv FILE", file, "rows for other programs");
  return program::runProgram(options, argc, argv, [&] {
    setThreads(1);
    std::FILE* const csv = file.empty() ? nullptr : std::fopen(file.c_str(), "w");
    if (csv == nullptr && !file.empty()) throw InputError("the file cannot be written", file, "give another name");
    std::setvbuf(stdout, nullptr, _IOLBF, 0);
    if (csv != nullptr) std::fprintf(csv, "case,element,cells,error,seconds\n");
    for (const Case& scene : cases(quick)) study(scene, quick, csv);
    if (csv != nullptr) std::fclose(csv);
    return true;
  });
}
