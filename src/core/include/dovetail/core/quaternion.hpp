// Unit quaternions as rotations.
#pragma once

#include <cmath>

#include "dovetail/core/vec3.hpp"

namespace dovetail {

/// w + x i + y j + z k; as a rotation of unit length, which nothing here enforces but `normalized`.
struct Quaternion {
  double w = 1.0, x = 0.0, y = 0.0, z = 0.0;
  friend constexpr bool operator==(const Quaternion&, const Quaternion&) = default;
};

/// First b, then a.
constexpr Quaternion operator*(const Quaternion& a, const Quaternion& b) {
  return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
          a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
/// The inverse of a unit quaternion.
constexpr Quaternion conjugate(const Quaternion& q) { return {q.w, -q.x, -q.y, -q.z}; }

inline double norm(const Quaternion& q) { return std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z); }
inline Quaternion normalized(const Quaternion& q) {
  const double scale = 1.0 / norm(q);
  return {scale * q.w, scale * q.x, scale * q.y, scale * q.z};
}

/// The vector turned by a unit quaternion.
constexpr Vec3 rotate(const Quaternion& q, const Vec3& a) {
  const Vec3 u{q.x, q.y, q.z}, t = 2.0 * cross(u, a);
  return a + q.w * t + cross(u, t);
}
/// The vector turned back.
constexpr Vec3 rotateBack(const Quaternion& q, const Vec3& a) { return rotate(conjugate(q), a); }

/// By |rotation| radians about the direction of `rotation`, counter-clockwise seen from its tip.
inline Quaternion fromRotationVector(const Vec3& rotation) {
  const double angle = norm(rotation);
  const double scale = angle > 0.0 ? std::sin(0.5 * angle) / angle : 0.5;
  return {std::cos(0.5 * angle), scale * rotation.x, scale * rotation.y, scale * rotation.z};
}

}  // namespace dovetail
