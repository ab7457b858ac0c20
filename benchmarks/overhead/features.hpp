// What single features cost beside the barest scene.
#pragma once

#include <string>
#include <vector>

#include "overhead.hpp"

namespace dovetail::overhead {

struct Feature {
  std::string name;
  bool used = false;           ///< or only there
  Duel time;                   ///< the barest scene, and the scene with it; s per turn
  double bytesPerGrain = 0.0;  ///< allocated more than without
};

/// Each feature beside the barest lattice. There and not used: "nothing" (the same scene twice, which tells the noise),
/// a wall that nobody touches, an outlet that nobody reaches, a second contact material that nobody has, the coupled
/// run without solids. Used: booked energies, friction with spins and dashpots, rolling and twisting beside it, gravity
/// and a wall to lie on.
/// @param edge  spheres along each edge of the cube   @param steps  per turn
std::vector<Feature> featuresOf(int edge, int steps, int turns);

}  // namespace dovetail::overhead
