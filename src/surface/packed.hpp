// Four numbers side by side, for loops over nodes and control points.
#pragma once

#include "dovetail/core/vec3.hpp"
#include "dovetail/core/vector_code.hpp"

namespace dovetail::surface {

/// A vector with a number behind it that nobody reads, or one component of four vectors. Sums of products keep the
/// order, and so the digits, of those of Vec3. Not to be handed to functions that are not inlined (withVectors).
using Packed [[gnu::vector_size(32)]] = double;

[[gnu::always_inline]] inline Packed packed(const Vec3& a) { return Packed{a.x, a.y, a.z, 0.0}; }
[[gnu::always_inline]] inline Vec3 unpacked(const Packed& a) { return {a[0], a[1], a[2]}; }

}  // namespace dovetail::surface
