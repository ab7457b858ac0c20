#include "dovetail/fem_cgal/tetrahedra.hpp"
#include "dovetail/scene/build.hpp"
#include "verbs.hpp"

namespace dovetail::program {

void offerTetrahedra() {
  scene::useVolumeMesher([](const geometry::TriangleMesh& surface, double size, double surfaceDistance) {
    return fem::tetrahedraInside(surface, {.size = size, .surfaceDistance = surfaceDistance});
  });
}

}  // namespace dovetail::program
