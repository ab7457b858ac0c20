// Solids that fill closed surfaces.
#include <utility>

#include "dovetail/geometry/surface_checks.hpp"
#include "parts.hpp"

namespace dovetail::scene {

namespace {

VolumeMesher& mesherInUse() {
  static VolumeMesher mesher;
  return mesher;
}

void requireClosed(const geometry::TriangleMesh& surface, const std::string& file) {
  const geometry::SurfaceDefects defects = geometry::checkSurface(surface.x, surface.facets);
  if (!surface.facets.empty() && defects.closedAndOriented() && defects.selfIntersection.empty()) return;
  std::string text = surface.facets.empty() ? "no facets" : geometry::describe(defects);
  for (char& c : text)
    if (c == '\n') c = ';';
  throw InputError("the surface bounds no volume (" + text + ")", file,
                   "close its holes and cuts in an editor of meshes, or mesh the solid with Gmsh");
}

/// A regular tetrahedron in a sphere of radius R has the volume 8/(9 √3) R³; no other one there is larger.
void requireMemoryIn(const geometry::TriangleMesh& surface, double size) {
  requireMemory(geometry::signedVolume(surface.x, surface.facets) / (0.5132 * size * size * size), "tetrahedra",
                BytesPer::cell, "take a larger size");
}

}  // namespace

void useVolumeMesher(VolumeMesher mesher) { mesherInUse() = std::move(mesher); }

fem::SolidMesh meshOf(const TetrahedraMesh& from, std::vector<std::string>& notes) {
  if (!mesherInUse())
    throw InputError("this program cannot fill surfaces with tetrahedra", from.file,
                     "configure it with -D DOVETAIL_PROGRAM_CGAL=ON (CGAL is under the GPL), or mesh the solid with "
                     "Gmsh and write \"mesh\": \"file\"");
  geometry::TriangleMesh surface = repairedSurface({from.file}, 0.0, geometry::ClosedPatches::turn, notes);
  for (Vec3& x : surface.x) x = from.scale * x;
  requireClosed(surface, from.file);
  requireMemoryIn(surface, from.size);
  try {
    return mesherInUse()(surface, from.size, from.surfaceDistance.value_or(from.size / 20.0));
  } catch (const NumericalError& error) {
    throw InputError(error.what(), from.file, "");
  }
}

}  // namespace dovetail::scene
