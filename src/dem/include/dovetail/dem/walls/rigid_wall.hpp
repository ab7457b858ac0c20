// Triangulated walls that move as rigid bodies: along a given motion, or freely under the forces of their contacts.
#pragma once

#include <functional>
#include <vector>

#include "dovetail/dem/bodies/bodies.hpp"
#include "dovetail/dem/walls/rigid_motion.hpp"
#include "dovetail/dem/walls/wall.hpp"

namespace dovetail::dem {

/// A motion as a function of time, s. It must give v and omega as the rates of x and turn: contacts take the wall's
/// velocity from it, and the work of the wall is wrong if they disagree.
using PrescribedMotion = std::function<RigidMotion(double time)>;

/// Steady velocity and steady turning about an axis through the reference point that moves along.
/// @param start where and how at startTime, s @return a function of time
PrescribedMotion steadyMotion(const RigidMotion& start, double startTime = 0.0);

/// x(t) = start.x + amplitude sin(2π frequency t + phase), not turning.
/// @param amplitude m, per direction @param frequency Hz @param phase rad
PrescribedMotion vibration(const RigidMotion& start, const Vec3& amplitude, double frequency, double phase = 0.0);

/// Vertices of the wall as it lies now, from a point of it, m. The point is the one that RigidMotion::x is the place of
/// from then on, and RigidMotion::turn counts from how the wall lies now: {reference, {}, …} is where it is.
/// @param reference in space, m
std::vector<Vec3> vertexOffsets(const TriangulatedWall& wall, const Vec3& reference);

/// x and v of the wall's vertices. Returns how far the vertex that moved most has moved, m.
/// @throws InputError if the number of offsets is not that of the vertices
double placeWall(const RigidMotion& motion, const std::vector<Vec3>& offset, TriangulatedWall& wall);

/// A wall carried by one of the Bodies.
struct WallOnBody {
  int body = -1;
  std::vector<Vec3> offset;  ///< vertices from the centre of mass in the principal frame, m
};

/// Makes a free body of a closed wall: solid, with the mass properties of what it encloses.
/// @throws InputError as solidInside and addBody
WallOnBody addWallBody(Bodies& bodies, const TriangulatedWall& wall, Density density, const Vec3& v = {},
                       const Vec3& omega = {});
/// Makes a free body of any wall with mass properties of the caller's own, described in the frame in which the wall
/// lies now. @throws InputError as addBody
WallOnBody addWallBody(Bodies& bodies, const TriangulatedWall& wall, const MassProperties& properties,
                       const Vec3& v = {}, const Vec3& omega = {});

RigidMotion poseOf(const Bodies& bodies, const WallOnBody& carrier);
/// x and v of the wall's vertices from its body's; after driftBodies and after kickBodies. Returns how far the vertex
/// that moved most has moved, m.
double placeWall(const Bodies& bodies, const WallOnBody& carrier, TriangulatedWall& wall);

/// Adds the vertex forces and their moment about the centre of mass to the body, whose motion they are adjoint to: the
/// power they put into the body is forcePower(wall). The wall's own forces stay as they are.
void gatherForces(const TriangulatedWall& wall, const WallOnBody& carrier, Bodies& bodies);

}  // namespace dovetail::dem
