// Cells of Hertz's and Mindlin's spheres under 416 kPa.
#pragma once

#include <cstdint>

#include "dovetail/rve/rve.hpp"

namespace dovetail::benchmark {

/// Table I of Liu, Sun, Yuan & Fish 2015. Density, distribution of sizes and the friction of the preparation are not
/// printed: 1650 kg/m³ over the solid fraction, even numbers of all diameters, and no friction, which gives the
/// contacts.
rve::Rve elasticSpheres(int count, std::uint64_t seed);

}  // namespace dovetail::benchmark
