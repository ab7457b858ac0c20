// When something is at rest.
#pragma once

#include <cstdint>

namespace dovetail {

/// The residual is what falls to zero at rest: the function that goes there says which, and in which unit.
struct RestCriterion {
  double tolerance = 1e-4;      ///< at rest when the residual is no more than this, > 0
  std::int64_t steps = 200000;  ///< given up after so many
};

/// @throws InputError naming the caller unless the tolerance is finite and > 0, and there are as many steps
void validate(const RestCriterion& criterion, const char* where, std::int64_t leastSteps = 0);

struct RestReport {
  bool atRest = false;
  double residual = 0.0;   ///< as it was last
  std::int64_t steps = 0;  ///< taken

  /// Takes the residual after so many steps. @return whether that is the end: at rest, or given up
  bool judge(double now, const RestCriterion& criterion) {
    residual = now;
    atRest = residual <= criterion.tolerance;
    return atRest || steps >= criterion.steps;
  }
};

}  // namespace dovetail
