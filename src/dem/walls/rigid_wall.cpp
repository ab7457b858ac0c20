#include "dovetail/dem/walls/rigid_wall.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::dem {

PrescribedMotion steadyMotion(const RigidMotion& start) {
  return [start](double time) {
    return RigidMotion{start.x + time * start.v, normalized(fromRotationVector(time * start.omega) * start.turn),
                       start.v, start.omega};
  };
}

PrescribedMotion vibration(const RigidMotion& start, const Vec3& amplitude, double frequency, double phase) {
  requireNonNegative(frequency, "frequency of a vibration");
  const double rate = 2.0 * std::numbers::pi * frequency;
  return [=](double time) {
    return RigidMotion{start.x + std::sin(rate * time + phase) * amplitude,
                       start.turn,
                       (rate * std::cos(rate * time + phase)) * amplitude,
                       {}};
  };
}

std::vector<Vec3> vertexOffsets(const TriangulatedWall& wall, const Vec3& reference) {
  std::vector<Vec3> offset;
  for (const Vec3& x : wall.x) offset.push_back(x - reference);
  return offset;
}

void placeWall(const RigidMotion& motion, const std::vector<Vec3>& offset, TriangulatedWall& wall) {
  if (offset.size() != wall.x.size())
    throw InputError(
        "there are " + std::to_string(offset.size()) + " offsets for " + std::to_string(wall.x.size()) + " vertices",
        "rigid wall", "take those of vertexOffsets");
  for (std::size_t k = 0; k < offset.size(); ++k) {
    const Vec3 arm = rotate(motion.turn, offset[k]);
    wall.x[k] = motion.x + arm;
    wall.v[k] = motion.v + cross(motion.omega, arm);
  }
}

WallOnBody addWallBody(Bodies& bodies, const TriangulatedWall& wall, Density density, const Vec3& v,
                       const Vec3& omega) {
  return addWallBody(bodies, wall, solidInside(wall.x, wall.facets, density), v, omega);
}

WallOnBody addWallBody(Bodies& bodies, const TriangulatedWall& wall, const MassProperties& properties, const Vec3& v,
                       const Vec3& omega) {
  WallOnBody carrier{addBody(bodies, properties, properties.centre, {}, v, omega),
                     vertexOffsets(wall, properties.centre)};
  for (Vec3& arm : carrier.offset) arm = rotateBack(properties.axes, arm);
  return carrier;
}

void placeWall(const Bodies& bodies, const WallOnBody& carrier, TriangulatedWall& wall) {
  const auto b = static_cast<std::size_t>(carrier.body);
  placeWall({bodies.x[b], bodies.orientation[b], bodies.v[b], angularVelocity(bodies, carrier.body)}, carrier.offset,
            wall);
}

void gatherForces(const TriangulatedWall& wall, const WallOnBody& carrier, Bodies& bodies) {
  const auto b = static_cast<std::size_t>(carrier.body);
  bodies.f[b] += totalForce(wall);
  bodies.torque[b] += totalMoment(wall, bodies.x[b]);
}

}  // namespace dovetail::dem
