// Exact signs of determinants, and what follows from them for triangles.
#pragma once

#include <array>

#include "dovetail/core/vec3.hpp"

namespace dovetail::geometry {

/// Sign (−1, 0, 1) of (b − a) × (c − a) · (d − a): 1 where d lies on the side the normal of a, b, c points to.
/// Exact for finite coordinates unless products under- or overflow: floating point with a bound on its error, and
/// expansions (Shewchuk, Discrete Comput. Geom. 18, 1997) where the bound does not decide.
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Sign of the area of the projection of a, b, c along an axis (0, 1, 2): 1 where they run counter-clockwise seen from
/// the positive end of that axis. Exact in the same sense.
int orientation(const Vec3& a, const Vec3& b, const Vec3& c, int axis);

/// Whether a, b, c lie on one line. Exact.
bool areCollinear(const Vec3& a, const Vec3& b, const Vec3& c);

/// Whether the closed segment p q and the closed triangle have a point in common; coplanar ones too. Exact.
/// The triangle must have an area (not areCollinear).
bool segmentMeetsTriangle(const Vec3& p, const Vec3& q, const std::array<Vec3, 3>& triangle);

/// Whether two closed triangles have a point in common. Exact. Both must have an area.
bool trianglesMeet(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

}  // namespace dovetail::geometry
