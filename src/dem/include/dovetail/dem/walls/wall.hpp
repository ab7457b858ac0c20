// Walls made of triangles whose vertices may move.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "dovetail/core/vec3.hpp"
#include "dovetail/geometry/surface_topology.hpp"

namespace dovetail::dem {

/// A triangulated surface. Its motion is written to x and v, contact forces to f.
struct TriangulatedWall {
  std::vector<Vec3> x;  ///< vertex positions, m
  std::vector<Vec3> v;  ///< vertex velocities, m/s
  std::vector<Vec3> f;  ///< forces on the vertices, N
  std::vector<geometry::Facet> facets;
  geometry::SurfaceTopology topology;
  /// true: a closed skin, counter-clockwise from outside, that pushes outwards along its facets' normals. A centre that
  /// has sunk below a face is still pushed out, down to one radius. The rim of an open surface is then a sharp
  /// end of all contact, so take this for closed skins only.
  /// false: a sheet that pushes to the side on which the centre lies.
  bool oneSided = false;
  /// A closed skin whose patches have vertices of their own along their borders: by vertex, the same number for those
  /// that are one corner of the skin: such borders are no rims. Empty: every vertex is a corner of its own.
  std::vector<int> corner;
  int material = 0;  ///< row of a LawTable
  /// kg, of the body that carries it (moveWall sets it): enters the effective mass that dashpots are made for.
  double mass = std::numeric_limits<double>::infinity();
  /// It moves as a rigid body, or not at all: facets that lie in one plane stay so, which spares most of the work over
  /// them.
  bool rigid = false;
};

/// A wall at rest.
/// @param oneSided  true: a closed skin that pushes outwards only, also those who have sunk in; false: a sheet that
/// pushes
///   to the side on which a centre lies (see TriangulatedWall::oneSided)
/// @throws InputError naming the vertex that is not finite, or the facet that names a missing vertex or one vertex
/// twice
TriangulatedWall makeWall(std::vector<Vec3> x, std::vector<geometry::Facet> facets, bool oneSided = false);

/// Vertex forces to zero.
void clearForces(TriangulatedWall& wall);

/// Total of the vertex forces, N, and of their moments about `about`, N m.
Vec3 totalForce(const TriangulatedWall& wall);
Vec3 totalMoment(const TriangulatedWall& wall, const Vec3& about = {});
/// Σ f·v over the vertices: power the contacts put into the wall, W.
double forcePower(const TriangulatedWall& wall);

}  // namespace dovetail::dem
