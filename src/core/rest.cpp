#include "dovetail/core/rest.hpp"

#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail {

void validate(const RestCriterion& criterion, const char* where, std::int64_t leastSteps) {
  requirePositive(criterion.tolerance, "tolerance of rest");
  if (criterion.steps < leastSteps)
    throw InputError("rest is given up after " + std::to_string(criterion.steps) + " steps", where,
                     "give " + std::to_string(leastSteps) + " or more");
}

}  // namespace dovetail
