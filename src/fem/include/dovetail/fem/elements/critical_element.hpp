// What limits the explicit step of a body.
#pragma once

#include "dovetail/core/step_limit.hpp"

namespace dovetail::fem {

struct StableStep : StepLimit {
  int element = -1;              ///< number in its mesh, or of a material point
  std::string solid;             ///< name of its term
  int node = -1;                 ///< at which another term pulls more than elements do; then `solid` is that term
  const char* part = "element";  ///< what `element` is the number of
};

}  // namespace dovetail::fem
