// Stages and outputs of a scene in macro steps of its steps.
#pragma once

#include <cstdint>
#include <vector>

#include "dovetail/scene/build.hpp"

namespace dovetail::scene {

struct Plan {
  std::vector<std::int64_t> stages;                      ///< macro steps, of stages that relax at most; load steps
  std::int64_t series = 0, frames = 0, checkpoints = 0;  ///< macro steps between two; 0: none
};

/// Of a started run. @throws InputError for times of more than 1e15 macro steps, and for outputs that would do nothing
/// or that this build does not write
Plan planOf(const Built& built, const Scene& scene);

}  // namespace dovetail::scene
