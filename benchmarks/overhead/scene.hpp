// What the programs of single parts have in common.
#pragma once

#include <cstdio>
#include <cstdlib>

#include "dovetail/core/vec3.hpp"

namespace dovetail::overhead {

inline constexpr double radius = 5e-3, density = 2500.0, stiffness = 1e4;  // of grains: m, kg/m³, N/m
inline constexpr double dt = 2e-5;                                         // s
inline constexpr Vec3 gravity{0.0, 0.0, -9.81};                            // m/s²

/// What a program is called with.
struct Size {
  int edge;  ///< grains along each edge of a cube, a multiple of 4
  int steps;
};
inline Size sizeFrom(int argc, char** argv) {
  const Size size{argc > 1 ? std::atoi(argv[1]) : 20, argc > 2 ? std::atoi(argv[2]) : 100};
  if (argc <= 3 && size.edge >= 4 && size.edge <= 200 && size.edge % 4 == 0 && size.steps >= 1) return size;
  std::fprintf(stderr, "usage: %s [EDGE [STEPS]]: grains along an edge, 4, 8, … 200; steps, from 1\n", argv[0]);
  std::exit(2);
}
inline double widthOf(const Size& size) { return 2.0 * radius * size.edge + 1e-4; }

/// For whoever compares programs.
inline void printEnergy(double kinetic) { std::printf("kinetic_J %.17g\n", kinetic); }

}  // namespace dovetail::overhead
