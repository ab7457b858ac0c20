// Necking of a round bar and of a strip in plane strain: force, radius of the neck and Bridgman's factor over the
// elongation, for meshes.
#include <algorithm>
#include <cstdio>
#include <utility>

#include "plasticity_scenes.hpp"
#include "program/run.hpp"

namespace {

using namespace dovetail::fem;

void strips() {
  std::printf("\nstrip in plane strain, 1 m thick; greatest force of an even one (Considere): %.4f MN\n",
              NeckingStrip::considereForce() / 1e6);
  std::printf("%-22s %8s %12s %14s %11s %8s\n", "element", "cells", "greatest, MN", "width at 5 mm", "iterations",
              "time, s");
  for (const auto& [shape, formulation] : {std::pair{ElementShape::quad4, Formulation::meanDilatation},
                                           {ElementShape::quad8, Formulation::reduced},
                                           {ElementShape::quad8, Formulation::meanDilatation},
                                           {ElementShape::hex8, Formulation::meanDilatation}})
    for (const int refinement : {1, 2, 4}) {
      const NeckingStrip strip{shape, formulation, 4 * refinement, 10 * refinement};
      const StripResult result = stretch(strip);
      double greatest = 0.0;
      for (const StripStep& step : result.steps) greatest = std::max(greatest, step.force);
      std::printf("%-5s %-16s %3d x %-3d %12.4f %14.4f %11ld %8.2f\n", name(shape), name(formulation), strip.across,
                  strip.along, greatest / 1e6, result.steps.back().neckHalfWidth / NeckingStrip::halfWidth,
                  static_cast<long>(result.iterations), result.seconds);
    }
}

void bars() {
  std::printf("greatest force of an even bar (Considere): %.3f kN\n", NeckingBar::considereForce() / 1e3);
  for (const int refinement : {1, 2, 3}) {
    NeckingBar bar;
    bar.across = bar.around = 2 * refinement;
    bar.along = 10 * refinement;
    const NeckingResult result = stretch(bar);
    std::printf("\n%zu cells, %ld iterations, %d cuts, %.1f s, energy residual %.1e of the work\n", result.cells,
                static_cast<long>(result.iterations), result.cuts, result.seconds, result.energyResidual);
    std::printf("%12s %10s %10s %10s %10s %10s\n", "u, mm", "F, kN", "a/R0", "strain", "F/A sigma", "Bridgman");
    double greatest = 0.0;
    for (std::size_t k = 0; k < result.steps.size(); ++k) {
      const NeckingStep& step = result.steps[k];
      greatest = std::max(greatest, step.force);
      if (k % 3 != 0 && k + 1 != result.steps.size()) continue;
      const double area = 3.14159265358979 * step.neckRadius * step.neckRadius;
      std::printf("%12.3f %10.3f %10.4f %10.4f %10.4f %10.4f\n", 1e3 * step.elongation, step.force / 1e3,
                  step.neckRadius / NeckingBar::radius, step.deepestStrain, step.force / (area * step.flowStress),
                  bridgmanFactor(step.neckRadius, step.neckCurve));
    }
    std::printf("greatest force %.3f kN\n", greatest / 1e3);
  }
}

}  // namespace

int main(int argc, char** argv) {
  dovetail::program::Options options("plasticity_necking",
                                     "Necking of a round bar and of a strip in plane strain, for meshes.");
  return dovetail::program::runProgram(options, argc, argv, [&] {
    bars();
    strips();
    return true;
  });
}
