#include "wall_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/bodies/body_term.hpp"
#include "dovetail/dem/walls/wall_checks.hpp"
#include "own_paths.hpp"
#include "time_functions.hpp"

namespace dovetail::scene {

dem::WallServo* servoIn(dem::Model& grains, const WallParts& parts) {
  if (!parts.servo) return nullptr;
  if (parts.firstMesh < parts.endMesh)
    return std::get_if<dem::WallServo>(&dem::meshWall(grains, parts.firstMesh).motion);
  auto& servo = dem::primitiveWall(grains, parts.firstPrimitive).servo;
  return servo ? &*servo : nullptr;
}

namespace {

using dem::RigidMotion;

/// Of a part that lies at `arm` from the point of the whole, as described.
RigidMotion partOf(const RigidMotion& whole, const Vec3& arm) {
  const Vec3 turned = rotate(whole.turn, arm);
  return {whole.x + turned, whole.turn, whole.v + cross(whole.omega, turned), whole.omega};
}

/// A belt turns with its wall, whose drift turns it by the velocity of an instant only.
Vec3 beltAlong(const dem::PrimitiveWall& wall) {
  const Vec3& v = wall.surfaceVelocity;
  if (v == Vec3{}) return v;
  const Vec3 part = dot(v, wall.axis) * wall.axis;
  const Vec3 along = wall.shape == dem::PrimitiveWall::Shape::cylinder ? part : v - part;
  return norm(v) / norm(along) * along;
}

/// The wall as it is now, or so that it drifts there in a step that long.
void place(dem::PrimitiveWall& wall, const RigidMotion& now, const Vec3& axis, double dt) {
  wall.velocity = now.v;
  wall.angularVelocity = now.omega;
  wall.point = now.x - dt * now.v;
  wall.axis = rotate(fromRotationVector(-dt * now.omega) * now.turn, axis);
  wall.surfaceVelocity = beltAlong(wall);
}

template <class Act>
void forEachPrimitive(dem::Model& grains, const WallParts& parts, const Act& act) {
  const auto terms = grains.terms.all<dem::PrimitiveWallTerm>();
  for (std::size_t i = parts.firstPrimitive; i < parts.endPrimitive; ++i) act(*terms[i], i - parts.firstPrimitive);
}
template <class Act>
void forEachMesh(dem::Model& grains, const WallParts& parts, const Act& act) {
  const auto terms = grains.terms.all<dem::MeshWallTerm>();
  for (std::size_t i = parts.firstMesh; i < parts.endMesh; ++i) act(*terms[i]);
}

const dem::WallServo* servoIn(const dem::Model& grains, const WallParts& parts) {
  return servoIn(const_cast<dem::Model&>(grains), parts);
}

// ---- servos

/// Calls act(mass, place) for every single grain and every clump.
template <class Act>
void forEachGrain(const dem::Model& grains, const Act& act) {
  const dem::Particles& p = grains.particles;
  for (std::size_t i = 0; i < p.size(); ++i)
    if (!p.isMember(i)) act(p.mass[i], p.x[i]);
  for (const auto* term : grains.terms.all<dem::BodyTerm>())
    for (std::size_t b = 0; b < term->bodies.size(); ++b) act(term->bodies.mass[b], term->bodies.x[b]);
}

double massOfGrains(const dem::Model& grains, const char* key) {
  double mass = 0.0;
  forEachGrain(grains, [&](double m, const Vec3&) { mass += m; });
  if (!(mass > 0.0))
    throw InputError("there are no spheres at the start, clumps left out, whose mass the servo could take", "",
                     std::string("give it a ") + key);
  return mass;
}
double inertiaOfGrains(const dem::Model& grains, const dem::WallServo& servo) {
  massOfGrains(grains, "moment_of_inertia");
  double inertia = 0.0;
  forEachGrain(grains, [&](double m, const Vec3& x) {
    const double lever = servo.leverOf(x);
    inertia += m * lever * lever;
  });
  if (!(inertia > 0.0)) throw InputError("all grains lie on the axis of the servo", "", "give it a moment_of_inertia");
  return inertia;
}

/// N or N m, and whether it changes.
struct LoadOfTime {
  TimeFunction of;
  bool steady;
};
LoadOfTime loadOf(const Servo& servo, const Scene& scene) {
  if (const auto* const force = std::get_if<KeptForce>(&servo.keeps))
    return {functionOf(force->force, scene), isConstant(force->force)};
  if (const auto* const torque = std::get_if<KeptTorque>(&servo.keeps))
    return {functionOf(torque->torque, scene), isConstant(torque->torque)};
  const auto& kept = std::get<KeptPressure>(servo.keeps);
  return {[f = functionOf(kept.pressure, scene), area = kept.area](double t) { return f(t) * area; },
          isConstant(kept.pressure)};
}

const PushedWall* pushedIn(const Servo& servo) {
  if (const auto* const force = std::get_if<KeptForce>(&servo.keeps)) return force;
  return std::get_if<KeptPressure>(&servo.keeps);
}

dem::WallServo servoOf(const Servo& servo, const dem::Model& grains, const Vec3& point, const dem::WallServo* before) {
  constexpr double none = std::numeric_limits<double>::infinity();
  if (norm(servo.axis) == 0.0)
    throw InputError("the axis of the servo has no length", "", "give it a direction, such as [0, 0, -1]");
  dem::WallServo made;
  made.direction = normalized(servo.axis);
  made.localDamping = servo.damping;
  if (const auto* const torque = std::get_if<KeptTorque>(&servo.keeps)) {
    made.turns = true;
    made.point = torque->point.value_or(point);
    made.mass = torque->momentOfInertia ? *torque->momentOfInertia
                : before                ? before->mass
                                        : inertiaOfGrains(grains, made);
    made.fastest = torque->speedLimit.value_or(none);
  } else {
    const PushedWall& pushed = *pushedIn(servo);
    made.mass = pushed.mass ? *pushed.mass : before ? before->mass : massOfGrains(grains, "mass");
    made.fastest = pushed.speedLimit.value_or(none);
  }
  return made;
}

bool isSameAxis(const dem::WallServo& a, const dem::WallServo& b) {
  return a.direction == b.direction && a.turns == b.turns && (!a.turns || a.point == b.point);
}

void requireServoAlone(const WallParts& parts, const WallMotion& motion) {
  if (motion.displacement || motion.turn || norm(motion.angularVelocity) > 0.0 || !isConstant(motion.velocity) ||
      norm(constantOf(motion.velocity)) > 0.0)
    throw InputError("both a servo and a path are given", "",
                     "leave one of them out; a plane that slides in itself has a surface_velocity");
  if (parts.endPrimitive - parts.firstPrimitive > 1)
    throw InputError("the walls of a box cannot have a servo", "",
                     "write the side that moves as a plane of its own, and name it in \"open\"");
}

void setServo(dem::Model& grains, WallParts& parts, const WallMotion& motion, const Scene& scene) {
  requireServoAlone(parts, motion);
  dem::WallServo* const before = servoIn(grains, parts);
  const RigidMotion now = placeOf(parts, grains, grains.time);
  dem::WallServo made = servoOf(*motion.servo, grains, now.x, before);
  if (made.turns) requireRepeatsTurned(grains, parts, made.direction);
  const bool goesOn = before && isSameAxis(*before, made);
  if (goesOn) {
    made.speed = before->speed;
    made.travel = before->travel;
  } else {
    parts.base = {now.x, now.turn, {}, {}};
  }
  if (before) {
    made.work = before->work;
    made.lost = before->lost;
    made.contact = before->contact;
  }
  parts.servo = motion.servo;
  parts.since = grains.time;
  parts.motion = {};
  forEachPrimitive(grains, parts, [&](dem::PrimitiveWallTerm& term, std::size_t i) {
    term.wall.motion = {};
    if (!goesOn) place(term.wall, partOf(parts.base, parts.arms[i]), parts.axes[i], 0.0);
    term.wall.servo = made;
  });
  forEachMesh(grains, parts, [&](dem::MeshWallTerm& term) {
    if (!goesOn) {
      const Vec3 origin = made.turns ? made.point : Vec3{};
      term.mesh.offset.clear();
      for (const Vec3& arm : parts.offsets)
        term.mesh.offset.push_back(parts.base.x + rotate(parts.base.turn, arm) - origin);
    }
    term.mesh.motion = made;
    dem::moveWall(term.mesh, grains.time, 0.0);
  });
  setServoLoad(grains, parts, scene);
}

/// What a servo has done is kept in the model's books.
void endServo(dem::Model& grains, WallParts& parts) {
  if (const dem::WallServo* const servo = servoIn(grains, parts)) {
    grains.booked.damping += servo->lost;
    grains.booked.external += servo->work;
  }
  parts.servo.reset();
}

}  // namespace

void setPath(const MovedModel& model, WallParts& parts, const Vec3& axis, const MakeMotion& motion) {
  dem::Model& grains = model.grains;
  const RigidMotion now = placeOf(parts, grains, grains.time);
  requireRepeatsTurned(grains, parts, axis);
  endServo(grains, parts);
  parts.base = {now.x, now.turn, {}, {}};
  parts.since = grains.time;
  parts.motion = motion(parts);
  const double time = grains.time;
  forEachPrimitive(grains, parts, [&](dem::PrimitiveWallTerm& term, std::size_t i) {
    const Vec3 arm = parts.arms[i], axis = parts.axes[i];
    term.wall.servo.reset();
    place(term.wall, partOf(parts.motion(time), arm), axis, 0.0);
    term.wall.motion = [at = &model.run, path = parts.motion, arm, axis](double t, dem::PrimitiveWall& wall) {
      place(wall, partOf(path(t), arm), axis, at->dt());
    };
  });
  forEachMesh(grains, parts, [&](dem::MeshWallTerm& term) {
    term.mesh.offset = parts.offsets;
    term.mesh.motion = parts.motion;
    dem::moveWall(term.mesh, time, 0.0);
  });
}

void requireRepeatsTurned(const dem::Model& grains, const WallParts& parts, const Vec3& axis) {
  const geometry::Periodicity& space = grains.pairs.periodicity();
  if (norm(axis) == 0.0) return;
  const Vec3 along = normalized(axis);
  for (int k = 0; k < 3; ++k) {
    if (!space.axes[static_cast<std::size_t>(k)] || std::abs(along[k]) > 1.0 - 1e-12) continue;
    for (std::size_t i = 0; i < parts.axes.size(); ++i) {
      const dem::PrimitiveWall& wall = dem::primitiveWall(grains, parts.firstPrimitive + i);
      if (wall.shape != dem::PrimitiveWall::Shape::sphere && norm(cross(wall.axis, along)) > 1e-9)
        throw InputError(std::string("the wall would turn out of the period along ") + "xyz"[k], "",
                         "let its axis be that of the period, the normal of the plane or the axis of the cylinder");
    }
  }
}

dem::PrescribedMotion motionOf(const RigidPath& motion, const WallParts& parts, const Scene& scene,
                               const StepOf& step) {
  return motionOf(motion, parts.base, parts.base.x + rotate(parts.base.turn, parts.centre), parts.since, scene, step);
}

dem::PrescribedMotion motionOf(const RigidPath& motion, const dem::RigidMotion& base, const Vec3& own, double since,
                               const Scene& scene, const StepOf& step) {
  if (motion.turn && norm(motion.angularVelocity) > 0.0)
    throw InputError("both an angular velocity and a turn are given", "", "leave one of them out");
  if (motion.turn && norm(motion.turn->axis) == 0.0)
    throw InputError("the axis of the turn has no length", "", "give it a direction, such as [0, 0, 1]");
  const Path path = pathOf(motion.velocity, motion.displacement, scene, step);
  const double speed = norm(motion.angularVelocity);
  const Vec3 axis = motion.turn ? normalized(motion.turn->axis) : speed > 0.0 ? motion.angularVelocity / speed : Vec3{};
  const Travel angle = motion.turn ? travelOf(motion.turn->angle, scene, step) : travelAt({speed, ""}, scene);
  return rigidMotion(path, angle, axis, motion.turn ? motion.turn->point.value_or(own) : own, base, since);
}

dem::PrescribedMotion rigidMotion(const Path& path, const Travel& angle, const Vec3& axis, const Vec3& centre,
                                  const dem::RigidMotion& base, double since) {
  return [=, arm = base.x - centre](double time) {
    const double t = time - since;
    const Quaternion turn = fromRotationVector(angle.displacement(t) * axis);
    const Vec3 turned = rotate(turn, arm), omega = angle.velocity(t) * axis;
    return RigidMotion{centre + path.displacement(t) + turned, turn * base.turn,
                       path.velocity(t) + cross(omega, turned), omega};
  };
}

RigidMotion placeOf(const WallParts& parts, const dem::Model& grains, double time) {
  if (parts.motion) return parts.motion(time);
  const dem::WallServo* const servo = servoIn(grains, parts);
  if (!servo) return parts.base;
  const RigidMotion moved = servo->pose();
  const Vec3 origin = servo->turns ? servo->point : Vec3{};
  return {moved.x + rotate(moved.turn, parts.base.x - origin), moved.turn * parts.base.turn, {}, {}};
}

Vec3 centreOf(const WallParts& parts, const dem::Model& grains) {
  const RigidMotion now = placeOf(parts, grains, grains.time);
  return now.x + rotate(now.turn, parts.centre);
}

void setMotion(const MovedModel& model, WallParts& parts, const WallMotion& motion, const Scene& scene) {
  if (motion.servo) return setServo(model.grains, parts, motion, scene);
  setPath(model, parts, motion.turn ? motion.turn->axis : motion.angularVelocity,
          [&](const WallParts& now) { return motionOf(motion, now, scene, stepOf(model.run)); });
}

void setServoLoad(dem::Model& grains, const WallParts& parts, const Scene& scene) {
  dem::WallServo* const servo = servoIn(grains, parts);
  if (!servo) return;
  const PushedWall* const pushed = pushedIn(*parts.servo);
  const double weight = pushed && pushed->weight ? servo->mass * dot(grains.gravity, servo->direction) : 0.0;
  const LoadOfTime load = loadOf(*parts.servo, scene);
  servo->loadAt = {};
  if (!load.steady)
    servo->loadAt = [of = load.of, weight, since = parts.since](double t) {
      return of(std::max(0.0, t - since)) + weight;
    };
  servo->load = load.of(std::max(0.0, grains.time - parts.since)) + weight;
}

void setSurfaceVelocity(dem::Model& grains, const WallParts& parts, const Vec3& velocity) {
  const Quaternion turn = placeOf(parts, grains, grains.time).turn;
  forEachPrimitive(grains, parts, [&](dem::PrimitiveWallTerm& term, std::size_t) {
    term.wall.surfaceVelocity = velocity;
    dem::validate(term.wall, std::numeric_limits<int>::max(), grains.pairs.periodicity());
  });
  forEachMesh(grains, parts, [&](dem::MeshWallTerm& term) {
    const dem::TriangulatedWall& wall = term.mesh.wall;
    for (std::size_t k = 0; k < wall.facets.size() && norm(velocity) > 0.0; ++k) {
      const auto corner = [&](std::size_t c) { return wall.x[static_cast<std::size_t>(wall.facets[k][c])]; };
      const Vec3 area = cross(corner(1) - corner(0), corner(2) - corner(0));
      if (std::abs(dot(area, velocity)) > 1e-5 * norm(area) * norm(velocity))
        throw InputError("facet " + std::to_string(k) + " does not lie along the surface_velocity", "",
                         "give the part of the surface that is a belt a mesh of its own");
    }
    term.mesh.surfaceVelocity = rotateBack(turn, velocity);
    dem::moveWall(term.mesh, grains.time, 0.0);
  });
}

void setPresence(dem::Model& grains, const WallParts& parts, bool present) {
  forEachPrimitive(grains, parts, [&](dem::PrimitiveWallTerm& term, std::size_t) { dem::setPresent(term, present); });
  forEachMesh(grains, parts, [&](dem::MeshWallTerm& term) { dem::setPresent(term, present); });
}

}  // namespace dovetail::scene
