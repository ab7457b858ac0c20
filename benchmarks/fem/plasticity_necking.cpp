// Necking of a round bar: force, radius of the neck and Bridgman's factor over the elongation, for meshes.
#include <cstdio>

#include "plasticity_scenes.hpp"

int main() {
  using namespace dovetail::fem;
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
