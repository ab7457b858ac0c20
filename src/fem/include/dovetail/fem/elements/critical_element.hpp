// The element that limits the explicit step.
#pragma once

namespace dovetail::fem {

struct StableStep {
  double dt;    ///< s
  int element;  ///< the one that sets the limit
};

}  // namespace dovetail::fem
