#include "dovetail/geometry_cgal/cgal_surface.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_mesh_to_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <exception>
#include <string>

#include "dovetail/core/error.hpp"

namespace dovetail::geometry {

namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;

struct Soup {
  std::vector<Point> points;
  std::vector<std::array<std::size_t, 3>> facets;
};

Soup makeSoup(std::span<const Vec3> x, std::span<const Facet> facets) {
  Soup soup;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!isFinite(x[i]))
      throw InputError("not a finite vector", "vertex " + std::to_string(i), "give three finite numbers");
    soup.points.emplace_back(x[i].x, x[i].y, x[i].z);
  }
  for (std::size_t f = 0; f < facets.size(); ++f) {
    soup.facets.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const int v = facets[f][k];
      if (v < 0 || static_cast<std::size_t>(v) >= x.size())
        throw InputError("vertex number " + std::to_string(v) + " does not exist", "facet " + std::to_string(f),
                         "use numbers from 0 to " + std::to_string(static_cast<long>(x.size()) - 1));
      soup.facets.back()[k] = static_cast<std::size_t>(v);
    }
  }
  return soup;
}

/// For closed meshes. CGAL by itself also takes one that is inside out as a whole.
bool boundsVolume(const Mesh& mesh) { return pmp::does_bound_a_volume(mesh) && pmp::volume(mesh) > 0.0; }

int fillHoles(Mesh& mesh) {
  std::vector<Mesh::Halfedge_index> borders;
  pmp::extract_boundary_cycles(mesh, std::back_inserter(borders));
  int filled = 0;
  for (const Mesh::Halfedge_index border : borders) {
    std::vector<Mesh::Face_index> patch;
    pmp::triangulate_hole(mesh, border, std::back_inserter(patch));
    filled += !patch.empty();
  }
  return filled;
}

CgalRepair repair(TriangleMesh& surface, const CgalRepairOptions& options) {
  Soup soup = makeSoup(surface.x, surface.facets);
  std::erase_if(soup.facets, [](const auto& f) { return f[0] == f[1] || f[1] == f[2] || f[2] == f[0]; });
  std::vector<std::vector<std::size_t>> polygons;
  for (const auto& f : soup.facets) polygons.emplace_back(f.begin(), f.end());
  pmp::repair_polygon_soup(soup.points, polygons);
  pmp::orient_polygon_soup(soup.points, polygons);
  Mesh mesh;
  pmp::polygon_soup_to_polygon_mesh(soup.points, polygons, mesh);
  pmp::remove_degenerate_faces(mesh);
  pmp::stitch_borders(mesh);
  CgalRepair report;
  if (options.fillHoles) report.filledHoles = fillHoles(mesh);
  report.closed = CGAL::is_closed(mesh);
  report.selfIntersecting = pmp::does_self_intersect(mesh);
  if (report.closed && !mesh.is_empty() && !report.selfIntersecting) pmp::orient_to_bound_a_volume(mesh);
  report.boundsVolume = report.closed && !report.selfIntersecting && boundsVolume(mesh);
  mesh.collect_garbage();
  surface = {};
  for (const auto v : mesh.vertices()) surface.x.push_back({mesh.point(v).x(), mesh.point(v).y(), mesh.point(v).z()});
  for (const auto f : mesh.faces()) {
    Facet facet{};
    std::size_t k = 0;
    for (const auto v : mesh.vertices_around_face(mesh.halfedge(f)))
      if (k < 3) facet[k++] = static_cast<int>(v.idx());
    surface.facets.push_back(facet);
  }
  return report;
}

}  // namespace

CgalReport checkWithCgal(std::span<const Vec3> x, std::span<const Facet> facets) {
  makeTopology(facets, static_cast<int>(x.size()));
  const Soup soup = makeSoup(x, facets);
  CgalReport report;
  report.isMesh = pmp::is_polygon_soup_a_polygon_mesh(soup.facets);
  if (!report.isMesh) return report;
  Mesh mesh;
  pmp::polygon_soup_to_polygon_mesh(soup.points, soup.facets, mesh);
  report.closed = CGAL::is_closed(mesh);
  std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> pairs;
  pmp::self_intersections(mesh, std::back_inserter(pairs));
  for (const auto& [a, b] : pairs) {
    const int i = static_cast<int>(a.idx()), j = static_cast<int>(b.idx());
    report.selfIntersection.push_back({std::min(i, j), std::max(i, j)});
  }
  std::sort(report.selfIntersection.begin(), report.selfIntersection.end());
  report.boundsVolume = report.closed && report.selfIntersection.empty() && boundsVolume(mesh);
  return report;
}

CgalRepair repairWithCgal(TriangleMesh& mesh, const CgalRepairOptions& options) {
  try {
    return repair(mesh, options);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& failure) {
    throw NumericalError(std::string("CGAL could not repair the surface (") + failure.what() + ")", "repairWithCgal",
                         "check it with checkSurface and repair it where it was made");
  }
}

}  // namespace dovetail::geometry
