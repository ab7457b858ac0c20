// Near in number means near in space.
#pragma once

#include <span>
#include <vector>

#include "dovetail/dem/particles/particles.hpp"

namespace dovetail::dem::detail {

/// New numbers along a space-filling curve through bricks of a few particles; within a brick in the given order.
std::vector<int> numbersAlongCurve(const Particles& particles, std::span<const int> order);

}  // namespace dovetail::dem::detail
