// Static verification cases, every element beside the published or exact answer.
#include <chrono>
#include <cstdio>
#include <exception>
#include <string>

#include "dovetail/core/parallel.hpp"
#include "program/run.hpp"
#include "verification_cases.hpp"

namespace {

using namespace dovetail;
using verification::ElementKind;

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

double percent(double value, double reference) { return 100.0 * (value / reference - 1.0); }

/// All kinds; those of plane strain where that is the case.
std::vector<ElementKind> kindsFor(verification::Sides sides) {
  std::vector<ElementKind> kinds = verification::allKinds();
  if (sides == verification::Sides::held)
    kinds.insert(kinds.end(), verification::planeKinds().begin(), verification::planeKinds().end());
  return kinds;
}

void beams() {
  constexpr Vec3 csm1{-7.18777e-3, -66.1029e-3, 0.0}, csm2{-0.469006e-3, -16.9740e-3, 0.0};
  std::printf("\nBeam behind a cylinder (Turek and Hron), deviations from FeatFlow's finest mesh\n");
  std::printf("%-22s %-8s %22s %22s %8s\n", "element", "cells", "CSM1 u_x, u_y, %", "CSM2 u_x, u_y, %", "seconds");
  for (const ElementKind& kind : kindsFor(verification::Sides::held))
    for (const int n : {1, 2, 4}) {
      const double start = seconds();
      const Vec3 a = verification::beamBehindCylinder(kind, {20 * n, 2 * n}, 0.5e6);
      const Vec3 b = verification::beamBehindCylinder(kind, {20 * n, 2 * n}, 2e6);
      std::printf("%-22s %2d x %-3d %11.3f %10.3f %11.3f %10.3f %8.1f\n", kind.label().c_str(), 20 * n, 2 * n,
                  percent(a.x, csm1.x), percent(a.y, csm1.y), percent(b.x, csm2.x), percent(b.y, csm2.y),
                  seconds() - start);
    }
}

void membranes(double poissonRatio, verification::Sides sides, const char* title) {
  std::printf("\nCook's membrane, nu = %g, %s: u_y of the tip, mm, by cells per edge\n", poissonRatio, title);
  std::printf("%-22s %9d %9d %9d %9d\n", "element", 4, 8, 16, 32);
  for (const ElementKind& kind : kindsFor(sides)) {
    // A plate with free sides is beyond its lateral buckling load; tetrahedra, which are not symmetric about the middle
    // plane, leave it.
    const bool symmetric = fem::nodesOf(kind.shape) != 4 && fem::nodesOf(kind.shape) != 10;
    if (sides == verification::Sides::free && !symmetric) continue;
    std::printf("%-22s", kind.label().c_str());
    for (const int n : {4, 8, 16, 32})
      std::printf(" %9.4f", 1e3 * verification::cooksMembrane(kind, n, poissonRatio, sides).tip);
    std::printf("\n");
  }
}

/// What scripts/compare-plane-peers computes with CalculiX.
void planeMembranes() {
  for (const auto& [law, title] :
       {std::pair(verification::MembraneLaw::neoHookean, "neo-Hookean, 1 N"),
        std::pair(verification::MembraneLaw::stVenantKirchhoff, "St Venant-Kirchhoff, 0.5 N")}) {
    // Under 1 N the corner of the clamp is pressed past the limit point of that law.
    const double force = law == verification::MembraneLaw::neoHookean ? 1.0 : 0.5;
    std::printf("\nCook's membrane, nu = 0.3, plane strain, %s: u_y of the tip, mm, by cells per edge\n", title);
    std::printf("%-22s %9d %9d %9d %9d\n", "element", 4, 8, 16, 32);
    for (const ElementKind& kind : verification::planeKinds()) {
      std::printf("%-22s", kind.label().c_str());
      for (const int n : {4, 8, 16, 32})
        std::printf(" %9.4f",
                    1e3 * verification::cooksMembrane(kind, n, 0.3, verification::Sides::held, law, force).tip);
      std::printf("\n");
    }
  }
}

void pressures() {
  constexpr double away = 12e-3;
  std::printf(
      "\nCook's membrane, nu = 0.4999, 16 cells per edge, plane strain: mean pressures of cells farther than "
      "12 mm from the corners of the clamp\n%-22s %12s %22s %22s\n",
      "element", "range, kPa", "largest step, % of it", "alternating, % of it");
  for (const ElementKind& kind : kindsFor(verification::Sides::held)) {
    const auto steps = verification::pressureSteps(verification::cooksMembrane(kind, 16, 0.4999), away);
    std::printf("%-22s %12.1f %22.1f %22.1f\n", kind.label().c_str(), 1e-3 * steps.range, 100.0 * steps.largest,
                100.0 * steps.checkerboard);
  }
}

void cantilevers() {
  std::printf("\nCantilever of L/h = 100 under a dead tip load, 40 x 2 cells: deviation from the elastica, %%\n");
  std::printf("%-22s", "element");
  for (const double alpha : {0.5, 1.0, 2.0, 3.0}) std::printf("   PL2/EI = %-3g w, u", alpha);
  std::printf("\n");
  for (const ElementKind& kind : verification::allKinds()) {
    std::printf("%-22s", kind.label().c_str());
    for (const double alpha : {0.5, 1.0, 2.0, 3.0}) {
      const auto tip = verification::bentCantilever(kind, {40, 2}, alpha), exact = verification::elastica(alpha);
      std::printf("   %8.3f %8.3f", percent(tip.w, exact.w), percent(tip.u, exact.u));
    }
    std::printf("\n");
  }
}

}  // namespace

int main(int argc, char** argv) {
  bool plane = false;
  program::Options options("fem_verification", "Elements beside exact solutions of beams, membranes and tubes.");
  options.flag("--plane", plane, "plane elements instead");
  return program::runProgram(options, argc, argv, [&] {
    setThreads(1);
    std::setvbuf(stdout, nullptr, _IOLBF, 0);
    if (plane) return planeMembranes(), true;
    cantilevers();
    beams();
    membranes(0.3, verification::Sides::free, "free sides");
    membranes(0.3, verification::Sides::held, "plane strain");
    membranes(0.4999, verification::Sides::held, "plane strain");
    pressures();
    return true;
  });
}
