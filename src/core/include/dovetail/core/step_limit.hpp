// The largest step, and what sets it.
#pragma once

#include <limits>
#include <string>
#include <utility>

namespace dovetail {

struct StepLimit {
  double dt = std::numeric_limits<double>::infinity();  ///< s
  std::string owner = "nothing";                        ///< what sets it: "the bond of particle 3 with particle 4"

  /// Takes another limit if that is shorter.
  void lower(StepLimit other) {
    if (other.dt < dt) *this = std::move(other);
  }
};

}  // namespace dovetail
