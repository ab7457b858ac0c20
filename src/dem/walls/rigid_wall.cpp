#include "dovetail/dem/walls/rigid_wall.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/walls/wall_search.hpp"

namespace dovetail::dem {

PrescribedMotion steadyMotion(const RigidMotion& start, double startTime) {
  return [start, startTime](double time) {
    const double t = time - startTime;
    return RigidMotion{start.x + t * start.v, normalized(fromRotationVector(t * start.omega) * start.turn), start.v,
                       start.omega};
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

double placeWall(const RigidMotion& motion, const std::vector<Vec3>& offset, TriangulatedWall& wall) {
  if (offset.size() != wall.x.size())
    throw InputError(
        "there are " + std::to_string(offset.size()) + " offsets for " + std::to_string(wall.x.size()) + " vertices",
        "rigid wall", "take those of vertexOffsets");
  return std::sqrt(parallelSum(offset.size(), 4096, [&](std::size_t begin, std::size_t end) {
                     Largest squared;
                     for (std::size_t k = begin; k < end; ++k) {
                       const Vec3 arm = rotate(motion.turn, offset[k]), x = motion.x + arm;
                       squared.meet(squaredNorm(x - wall.x[k]));
                       wall.x[k] = x;
                       wall.v[k] = motion.v + cross(motion.omega, arm);
                     }
                     return squared;
                   }).value);
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

RigidMotion poseOf(const Bodies& bodies, const WallOnBody& carrier) {
  const auto b = static_cast<std::size_t>(carrier.body);
  return {bodies.x[b], bodies.orientation[b], bodies.v[b], angularVelocity(bodies, carrier.body)};
}

double placeWall(const Bodies& bodies, const WallOnBody& carrier, TriangulatedWall& wall) {
  return placeWall(poseOf(bodies, carrier), carrier.offset, wall);
}

void gatherForces(const TriangulatedWall& wall, const WallOnBody& carrier, Bodies& bodies) {
  const auto b = static_cast<std::size_t>(carrier.body);
  bodies.f[b] += totalForce(wall);
  bodies.torque[b] += totalMoment(wall, bodies.x[b]);
}

}  // namespace dovetail::dem
