// Sand that softens, pressed together between smooth plates: with and without a width of its bands.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "dovetail/fem/mesh/solid_mesh.hpp"

namespace dovetail::benchmark {

/// 1 m × 2 m in plane strain at 100 kPa all round, quad8 with 2 × 2 points, or quad4. Drucker–Prager: E = 50 MPa,
/// ν = 0.3, √(½ s:s) + 0.3 p ≤ k, no dilatancy, k from 47 kPa to 20 kPa by `softening` per shear strain; 10 % weaker in
/// a spot of 0.1 m on the left side. Explicit, the upper plate at 5 % a second.
struct SoftBiaxial {
  int across = 16;  ///< elements to the width
  fem::ElementShape shape = fem::ElementShape::quad8;
  double softening = 60e3;  ///< Pa
  double modulus = 0.0;     ///< D, N; 0: no gradient
  double skew = 0.0;        ///< of the mesh, fraction of an element
  double end = 0.04;        ///< mean axial strain
};

struct BiaxialCourse {
  std::vector<double> axial;  ///< at 1 %, 2 % …, mean over 0.25 % before, Pa
  double turned = 0.0;        ///< mean axial strain at which an element turned inside out; 0: none did
  double fraction = 0.0;      ///< of the volume that holds half of the shear, at the end
  double largest = 0.0;       ///< shear of a point, |(F₁₁ − F₂₂, F₁₂ + F₂₁)|
  double step = 0.0;          ///< s
  std::int64_t steps = 0;
  double seconds = 0.0;   ///< of the processor
  double residual = 0.0;  ///< of the ledger over the work of the plates
};

BiaxialCourse pressTogether(const SoftBiaxial& settings);

}  // namespace dovetail::benchmark
