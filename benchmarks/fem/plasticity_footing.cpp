// Bearing capacity of a strip footing on Drucker-Prager soil, for friction angles, flow rules and meshes.
#include <cstdio>

#include "footing_scene.hpp"
#include "program/run.hpp"

int main(int argc, char** argv) {
  dovetail::program::Options options(
      "plasticity_footing",
      "Bearing capacity of a strip footing on Drucker-Prager soil, for friction angles, flow rules and meshes.");
  return dovetail::program::runProgram(options, argc, argv, [&] {
    using namespace dovetail::fem;
    std::printf("%8s %10s %10s %8s %10s %8s %11s %5s %8s\n", "friction", "dilatancy", "mesh", "q/c", "Prandtl", "ratio",
                "iterations", "cuts", "time, s");
    for (const auto& [friction, dilatancy] : {std::pair{0.0, 0.0}, {20.0, 20.0}, {20.0, 10.0}})
      for (const int refinement : {1, 2, 3}) {
        Footing footing{.friction = friction, .dilatancy = dilatancy};
        footing.under *= refinement;
        footing.beside *= refinement;
        footing.deep *= refinement;
        std::printf("%8.0f %10.0f %6dx%-3d ", friction, dilatancy, footing.under + footing.beside, footing.deep);
        try {
          const FootingResult result = settle(footing);
          const double q = result.pressure.back() / Footing::cohesion;
          std::printf("%8.3f %10.3f %8.4f %11ld %5d %8.1f\n", q, footing.prandtlPressure() / Footing::cohesion,
                      q * Footing::cohesion / footing.prandtlPressure(), static_cast<long>(result.iterations),
                      result.cuts, result.seconds);
          if (refinement == 1)
            for (std::size_t k = 0; k < result.pressure.size(); k += 4)
              std::printf("        %10.2e m %8.3f c\n", result.settlement[k], result.pressure[k] / Footing::cohesion);
        } catch (const std::exception& error) {
          std::printf("%s\n", error.what());
        }
      }
    return true;
  });
}
