// How walls of a scene move, as rigid wholes.
#pragma once

#include "dovetail/dem/model/walls.hpp"
#include "dovetail/scene/build.hpp"
#include "time_functions.hpp"

namespace dovetail::scene {

/// The particles' model of a run, or a copy of it.
struct MovedModel {
  dem::Model& grains;
  const coupling::CoupledRun& run;
};

/// Of a point of a rigid whole that is at `base` at time `since`, s; functions of time count from there.
/// @param centre  that it turns about unless its turn has a point, m
/// @throws InputError for a path and a turn that are given twice, or an axis of no length
dem::PrescribedMotion motionOf(const RigidPath& motion, const dem::RigidMotion& base, const Vec3& centre, double since,
                               const Scene& scene, const StepOf& step);
/// Of the point of a wall from `parts.base` and `parts.since` on.
dem::PrescribedMotion motionOf(const RigidPath& motion, const WallParts& parts, const Scene& scene, const StepOf& step);

/// Where the point of a wall is now, and how the wall is turned.
dem::RigidMotion placeOf(const WallParts& parts, const dem::Model& grains, double time);
/// Where its centre is now, m, about which moments on it are.
Vec3 centreOf(const WallParts& parts, const dem::Model& grains);

/// Gives the wall a motion from now on: a path or a servo. Of a servo about the same axis the load changes alone.
/// @throws InputError for what its shape cannot do
void setMotion(const MovedModel& model, WallParts& parts, const WallMotion& motion, const Scene& scene);
/// Null for a wall without one.
dem::WallServo* servoIn(dem::Model& grains, const WallParts& parts);
/// Load of the servo with the weight of the wall under the present gravity, if it has any.
void setServoLoad(dem::Model& grains, const WallParts& parts, const Scene& scene);
/// @throws InputError if it does not lie in the surface
void setSurfaceVelocity(dem::Model& grains, const WallParts& parts, const Vec3& velocity);
void setPresence(dem::Model& grains, const WallParts& parts, bool present);

}  // namespace dovetail::scene
