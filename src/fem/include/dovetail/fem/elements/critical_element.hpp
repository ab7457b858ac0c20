// What limits the explicit step of solids.
#pragma once

#include "dovetail/core/step_limit.hpp"

namespace dovetail::fem {

struct StableStep : StepLimit {
  int element = -1;   ///< number in its mesh
  std::string solid;  ///< name of its term
  int node = -1;      ///< at which another term pulls more than elements do; then `solid` is that term
};

}  // namespace dovetail::fem
