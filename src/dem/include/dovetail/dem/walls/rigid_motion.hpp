// Place and motion of a rigid wall.
#pragma once

#include "dovetail/core/quaternion.hpp"

namespace dovetail::dem {

/// Where a rigid wall is, and how it moves: its reference point x, its turn from how it was described, v and omega.
struct RigidMotion {
  Vec3 x;           ///< m
  Quaternion turn;  ///< unit
  Vec3 v;           ///< m/s
  Vec3 omega;       ///< rad/s, in space
};

}  // namespace dovetail::dem
