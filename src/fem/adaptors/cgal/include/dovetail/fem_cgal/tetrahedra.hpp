// Tetrahedra inside closed surfaces by CGAL's Mesh_3, which is under the GPL: a program that links this component is
// bound by it. Nothing else in the library needs it.
#pragma once

#include "dovetail/fem/mesh/solid_mesh.hpp"
#include "dovetail/geometry/triangle_mesh.hpp"

namespace dovetail::fem {

struct TetrahedraOptions {
  /// Largest circumradius of tetrahedra and of faces on the surface, m, and largest length of edges along sharp edges.
  double size;
  double surfaceDistance = 0.0;  ///< largest distance of faces from the surface, m; 0 = size/20
  /// Edges of the surface whose facets meet at an angle of normals above this one, rad, stay edges.
  double sharpAngle = 0.9;
  double faceAngle = 25.0;    ///< least angle of faces, degrees; above 30 CGAL may not come to an end
  double radiusToEdge = 2.5;  ///< largest circumradius over shortest edge of a tetrahedron; below 2 likewise
};

/// Meshes the inside of a surface with tet4 elements by Delaunay refinement (Jamin, Alliez, Yvinec & Boissonnat 2015).
/// Flat sides and sharp edges are kept, curved sides approached from the surface's own facets. Node and face set:
/// "skin". Elements with the same input are the same on every run.
/// @throws InputError if sizes are not positive and finite, angles out of range, or the surface is not closed, not
///         oriented outwards, or cuts itself; NumericalError if CGAL gives up or leaves nothing
SolidMesh tetrahedraInside(const geometry::TriangleMesh& surface, const TetrahedraOptions& options);

}  // namespace dovetail::fem
