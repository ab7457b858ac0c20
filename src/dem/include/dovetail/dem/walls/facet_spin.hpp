// How a facet turns, and couples as forces on its vertices.
#pragma once

#include <array>

#include "dovetail/core/vec3.hpp"

namespace dovetail::dem {

/// A linear triangle's angular velocity as a function of its vertices' velocities: that of a rigid body if it moves as
/// one, else how its normal turns, and half the curl about the normal. A facet without area does not turn.
class FacetSpin {
public:
  FacetSpin(const Vec3& a, const Vec3& b, const Vec3& c);

  /// rad/s, from the velocities of the vertices
  Vec3 operator()(const Vec3& va, const Vec3& vb, const Vec3& vc) const;
  /// Forces on the vertices, N, that do the work of a couple (N m) on that spin: their sum is zero, their moment the
  /// couple.
  std::array<Vec3, 3> forces(const Vec3& couple) const;

private:
  Vec3 normal_;           // unit, or zero
  Vec3 slope1_, slope2_;  // in the plane, 1/m: gradients of what is 1 at b (at c) and 0 at the others
};

}  // namespace dovetail::dem
