// What motions by functions of a program share with those by expressions of a scene.
#pragma once

#include "time_functions.hpp"
#include "wall_motion.hpp"

namespace dovetail::scene {

/// As those of expressions.
Travel travelOf(const TimeFunction& displacement, const StepOf& step);
/// @param before  pieces without a step, s
Travel travelAt(const TimeFunction& velocity, const StepOf& step, double before);
/// Of a displacement, m, or of a velocity, m/s, in a run that has a step.
Path pathOf(const std::function<Vec3(double)>& function, bool isVelocity, const StepOf& step);

/// Along a path, and turned by an angle about an axis (unit) through `centre`; times count from `since`, s.
dem::PrescribedMotion rigidMotion(const Path& path, const Travel& angle, const Vec3& axis, const Vec3& centre,
                                  const dem::RigidMotion& base, double since);
/// Gives a wall a path from now on, made once `parts.base` and `parts.since` are. @param axis  that it turns about
using MakeMotion = std::function<dem::PrescribedMotion(const WallParts& parts)>;
void setPath(const MovedModel& model, WallParts& parts, const Vec3& axis, const MakeMotion& motion);
/// @throws InputError if a primitive would not keep fitting the periods while it turns about the axis
void requireRepeatsTurned(const dem::Model& grains, const WallParts& parts, const Vec3& axis);

}  // namespace dovetail::scene
