// Friction that scatters along a diagonal, as in Figs 13 to 15 of Desrues et al. 2019.
#pragma once

#include <cstdint>

#include "band_biaxial.hpp"

namespace dovetail::benchmark {

/// 8 × 16 elements to 2.5 % of strain, of which the 28 nearest to a diagonal have the friction of softSand() times
/// 1 ± scatter, half of them each, at random; no weak spot.
BiaxialCourse pressScattered(double scatter, double modulus, std::uint64_t seed);

}  // namespace dovetail::benchmark
