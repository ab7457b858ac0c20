#include "dovetail/fem_cgal/tetrahedra.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polyhedral_mesh_domain_with_features_3.h>
#include <CGAL/Random.h>
#include <CGAL/make_mesh_3.h>

#include <algorithm>
#include <exception>
#include <map>
#include <numbers>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/geometry/surface_checks.hpp"

namespace dovetail::fem {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Polyhedron = CGAL::Mesh_polyhedron_3<Kernel>::type;
using Domain = CGAL::Polyhedral_mesh_domain_with_features_3<Kernel>;
using Triangulation = CGAL::Mesh_triangulation_3<Domain>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation, Domain::Corner_index, Domain::Curve_index>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;
namespace parameters = CGAL::parameters;

Polyhedron makePolyhedron(const geometry::TriangleMesh& surface) {
  std::vector<Kernel::Point_3> points;
  for (const Vec3& x : surface.x) points.emplace_back(x.x, x.y, x.z);
  std::vector<std::vector<std::size_t>> facets;
  for (const auto& facet : surface.facets) facets.emplace_back(facet.begin(), facet.end());
  Polyhedron polyhedron;
  CGAL::Polygon_mesh_processing::polygon_soup_to_polygon_mesh(points, facets, polyhedron);
  return polyhedron;
}

SolidMesh toMesh(const Complex& complex) {
  SolidMesh mesh;
  ElementGroup& group = mesh.groups.emplace_back(ElementGroup{ElementShape::tet4, {}});
  std::map<Triangulation::Vertex_handle, int> number;
  for (auto cell = complex.cells_in_complex_begin(); cell != complex.cells_in_complex_end(); ++cell)
    for (int k = 0; k < 4; ++k) {
      const auto vertex = cell->vertex(k);
      const auto [entry, isNew] = number.emplace(vertex, static_cast<int>(mesh.X.size()));
      if (isNew) mesh.X.push_back({vertex->point().x(), vertex->point().y(), vertex->point().z()});
      group.node.push_back(entry->second);
    }
  return mesh;
}

void addSkin(SolidMesh& mesh) {
  const std::vector<Face> skin = boundaryFaces(mesh);
  std::vector<int> nodes;
  for (const Face& face : skin) nodes.insert(nodes.end(), face.node.begin(), face.node.begin() + 3);
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  mesh.faceSets["skin"] = skin;
  mesh.nodeSets["skin"] = nodes;
}

SolidMesh fill(const geometry::TriangleMesh& surface, const TetrahedraOptions& options) {
  CGAL::get_default_random() = CGAL::Random(1);
  CGAL::Random random(1);
  const Polyhedron polyhedron = makePolyhedron(surface);
  Domain domain(polyhedron, &random);
  domain.detect_features(options.sharpAngle * 180.0 / std::numbers::pi);
  const double distance = options.surfaceDistance > 0.0 ? options.surfaceDistance : options.size / 20.0;
  const Criteria criteria(parameters::edge_size = options.size, parameters::facet_angle = options.faceAngle,
                          parameters::facet_size = options.size, parameters::facet_distance = distance,
                          parameters::cell_radius_edge_ratio = options.radiusToEdge,
                          parameters::cell_size = options.size);
  // CGAL's own limit on the removal of slivers is a time, and meshes would depend on how busy the machine is.
  return toMesh(CGAL::make_mesh_3<Complex>(domain, criteria, parameters::no_perturb(),
                                           parameters::exude(parameters::time_limit = 0.0)));
}

void requireOptions(const TetrahedraOptions& options) {
  requirePositive(options.size, "size of the tetrahedra");
  requireNonNegative(options.surfaceDistance, "distance from the surface");
  const auto require = [](double value, double least, double most, const char* what) {
    if (!(value >= least && value <= most))
      throw InputError(std::string("the ") + what + " is " + formatNumber(value), "tetrahedra",
                       "give " + formatNumber(least) + " to " + formatNumber(most));
  };
  require(options.sharpAngle, 0.0, std::numbers::pi, "sharp angle");
  require(options.faceAngle, 1.0, 30.0, "least angle of faces");
  require(options.radiusToEdge, 2.0, 100.0, "ratio of radius to edge");
}

}  // namespace

SolidMesh tetrahedraInside(const geometry::TriangleMesh& surface, const TetrahedraOptions& options) {
  requireOptions(options);
  const geometry::SurfaceDefects defects = geometry::checkSurface(surface.x, surface.facets);
  const bool bounds = defects.closedAndOriented() && defects.selfIntersection.empty() && defects.insideOut.empty() &&
                      defects.repeatedVertex.empty() && defects.zeroArea.empty() && defects.duplicate.empty();
  if (surface.facets.empty() || !bounds)
    throw InputError("the surface does not bound a volume (" + geometry::describe(defects) + ")", "tetrahedra",
                     "weld, repair and orient it (geometry::repairSurface)");
  SolidMesh mesh;
  try {
    mesh = fill(surface, options);
  } catch (const std::exception& failure) {
    throw NumericalError(std::string("CGAL could not mesh the surface (") + failure.what() + ")", "tetrahedra",
                         "check the surface, or give another size");
  }
  if (mesh.elementCount() == 0) throw NumericalError("CGAL made no tetrahedra", "tetrahedra", "give a smaller size");
  addSkin(mesh);
  validate(mesh);
  return mesh;
}

}  // namespace dovetail::fem
