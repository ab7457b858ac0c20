#include "dovetail/cg/wall_traction.hpp"

#include <algorithm>
#include <numeric>
#include <string>

#include "checks.hpp"
#include "dovetail/core/parallel.hpp"
#include "kernel_sum.hpp"

namespace dovetail::cg {

std::vector<Vec3> surfaceTraction(const Kernel& kernel, std::span<const Vec3> points, const WallForceView& contacts,
                                  const geometry::Periodicity& space) {
  requireValid(kernel);
  if (kernel.dimension != 2)
    throw InputError("the kernel's dimension is " + std::to_string(kernel.dimension), "kernel dimension",
                     "give a kernel of dimension 2");
  requireSameLength(contacts.point.size(), contacts.force.size(), "contact points and forces");
  requireFiniteItems(points, "point", "position");
  requireFiniteItems(contacts.point, "wall contact", "position");
  requireFiniteItems(contacts.force, "wall contact", "force");
  std::vector<Vec3> traction(points.size());
  addKernels(kernel, points, contacts, space, -1.0, traction);
  return traction;
}

namespace {

/// Weights of some contacts on the vertices.
struct Rows {
  std::vector<int> column;
  std::vector<double> weight;
  std::vector<std::size_t> end;  // of each contact's entries
};

}  // namespace

VertexTraction wallTraction(const SurfaceKernel& kernel, std::span<const Vec3> vertices,
                            std::span<const std::array<int, 3>> facets, std::span<const int> patchOfFacet,
                            const FacetForceView& contacts) {
  const std::size_t n = contacts.facet.size();
  requireSameLength(n, contacts.barycentric.size(), "facets and places of wall contacts");
  requireSameLength(n, contacts.force.size(), "facets and forces of wall contacts");
  requireFiniteItems(contacts.force, "wall contact", "force");
  const Projection toVertices = identityProjection(static_cast<int>(vertices.size()));
  const std::size_t chunkSize = std::max<std::size_t>(64, (n + 31) / 32);  // each chunk sorts the facets once
  std::vector<Rows> rows((n + chunkSize - 1) / chunkSize);
  // With no contacts the arguments are checked all the same.
  SurfaceKernelRows checked(kernel, vertices, facets, patchOfFacet, toVertices);
  parallelFor(n, chunkSize, [&](std::size_t begin, std::size_t end) {
    SurfaceKernelRows kernelRows(kernel, vertices, facets, patchOfFacet, toVertices);
    Rows& part = rows[begin / chunkSize];
    for (std::size_t c = begin; c < end; ++c) {
      kernelRows.row(contacts.facet[c], contacts.barycentric[c], part.column, part.weight);
      part.end.push_back(part.column.size());
    }
  });
  VertexTraction result{std::vector<Vec3>(vertices.size()), std::vector<double>(vertices.size())};
  for (std::size_t chunk = 0, c = 0; chunk < rows.size(); ++chunk)
    for (std::size_t k = 0, entry = 0; k < rows[chunk].end.size(); ++k, ++c)
      for (; entry < rows[chunk].end[k]; ++entry)
        result.traction[static_cast<std::size_t>(rows[chunk].column[entry])] -=
            rows[chunk].weight[entry] * contacts.force[c];
  for (const auto& f : facets) {
    const auto corner = [&](int k) { return vertices[static_cast<std::size_t>(f[static_cast<std::size_t>(k)])]; };
    const double third = norm(cross(corner(1) - corner(0), corner(2) - corner(0))) / 6.0;
    for (const int v : f) result.area[static_cast<std::size_t>(v)] += third;
  }
  for (std::size_t v = 0; v < vertices.size(); ++v)
    result.traction[v] = result.area[v] > 0.0 ? result.traction[v] / result.area[v] : Vec3{};
  return result;
}

}  // namespace dovetail::cg
