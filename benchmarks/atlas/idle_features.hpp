// Features that a scene has but does not use.
#pragma once

#include <string>
#include <vector>

#include "price.hpp"

namespace dovetail::atlas {

struct IdleFeature {
  std::string name;
  Duel time;                   ///< the scene with it over the scene without
  double bytesPerGrain = 0.0;  ///< allocated more than without
};

/// Each feature beside the barest lattice: "nothing" (the same scene twice, which tells the noise), a wall that nobody
/// touches, an outlet that nobody reaches, a second contact material that nobody has, the coupled run without solids.
/// @param edge  spheres along each edge of the cube   @param steps  per turn
std::vector<IdleFeature> idleFeatures(int edge, int steps, int turns);

}  // namespace dovetail::atlas
