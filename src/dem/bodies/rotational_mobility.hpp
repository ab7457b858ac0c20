// By how much a body that turns gives way more than its mass alone.
#pragma once

#include "dovetail/core/vec3.hpp"

namespace dovetail::dem {

/// Largest (r × n)·I⁻¹(r × n) over unit vectors n, 1/kg. @param r, inertia in the principal frame, m, kg m²
double rotationalMobility(const Vec3& r, const Vec3& inertia);

}  // namespace dovetail::dem
