#pragma once

#include "dovetail/rve/equilibrium.hpp"

namespace dovetail::rve {

/// @throws InputError if the tolerance is not > 0 or the fraction of the step not in (0, 1)
void validate(const RestOptions& settings);

}  // namespace dovetail::rve
