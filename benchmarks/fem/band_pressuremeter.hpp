// A hole in sand that softens, under growing pressure, as in Fig. 21 of Desrues et al. 2019.
#pragma once

#include <vector>

namespace dovetail::benchmark {

/// A quarter in plane strain, radii of 1 m and 10 m, quad8 with 2 × 2 points that grow with the radius; softSand(),
/// weaker at one place of the hole. Outside the pressure stays that of the ground, in the hole it grows by as much in
/// 0.2 s. Explicit.
struct Pressuremeter {
  int along = 36, around = 24;  ///< elements
  double modulus = 0.0;         ///< D, N; 0: no gradient
  double end = 6.5;             ///< pressure in the hole over that of the ground
};

/// At every quarter of the pressure of the ground. A band is an arc of the circle of 1.3 m, as it was, whose points
/// have more shear than the mean over the circle.
struct PressuremeterLook {
  double pressure = 0.0;  ///< over that of the ground
  double opening = 0.0;   ///< mean radial displacement of the hole over its radius
  int bands = 0;
  double width = 0.0;     ///< mean of the bands, m
  double contrast = 0.0;  ///< largest shear on the circle over the mean
};

struct PressuremeterCourse {
  std::vector<PressuremeterLook> looks;
  double broken = 0.0;  ///< pressure over that of the ground where an element turned inside out; 0: none did
  double step = 0.0, seconds = 0.0;  ///< s; of the processor
  double residual = 0.0;             ///< of the ledger over the work of the pressure in the hole
};

PressuremeterCourse inflate(const Pressuremeter& settings);

}  // namespace dovetail::benchmark
