// Limit pressure of a thick tube of perfectly plastic metal, for elements and meshes.
#include <cstdio>

#include "plasticity_scenes.hpp"
#include "program/run.hpp"

int main(int argc, char** argv) {
  dovetail::program::Options options(
      "plasticity_tube", "Limit pressure of a thick tube of perfectly plastic metal, for elements and meshes.");
  return dovetail::program::runProgram(options, argc, argv, [&] {
    using namespace dovetail::fem;
    std::printf("limit (2/sqrt 3) sigma_y ln(b/a) = %.4f sigma_y\n", Tube::limitPressure() / Tube::yieldStress);
    std::printf("%-8s %-16s %6s %8s %10s %8s %11s %9s\n", "cells", "formulation", "nu", "mesh", "p/sigma_y", "error",
                "iterations", "time, s");
    for (const double nu : {0.3, 0.49})
      for (const auto& [shape, formulation] : {std::pair{ElementShape::hex8, Formulation::meanDilatation},
                                               {ElementShape::hex8, Formulation::enhanced},
                                               {ElementShape::hex8, Formulation::standard},
                                               {ElementShape::hex20, Formulation::standard},
                                               {ElementShape::quad4, Formulation::meanDilatation},
                                               {ElementShape::quad8, Formulation::standard},
                                               {ElementShape::quad8, Formulation::reduced}})
        for (const int refinement : {1, 2, 4}) {
          const Tube tube{shape, formulation, nu, 5 * refinement, 3 * refinement};
          try {
            const TubeResult result = pressurise(tube);
            const double ratio = result.pressure.back() / Tube::limitPressure();
            std::printf("%-8s %-16s %6.2f %5dx%-2d %10.4f %7.2f%% %11ld %9.2f\n", name(shape), name(formulation), nu,
                        tube.radial, tube.around, ratio * Tube::limitPressure() / Tube::yieldStress,
                        100.0 * (ratio - 1.0), static_cast<long>(result.iterations), result.seconds);
          } catch (const std::exception& error) {
            std::printf("%-8s %-16s %6.2f %5dx%-2d %s\n", name(shape), name(formulation), nu, tube.radial, tube.around,
                        error.what());
          }
        }
    return true;
  });
}
