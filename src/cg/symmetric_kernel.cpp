#include "dovetail/cg/symmetric_kernel.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "dovetail/cg/surface_kernel.hpp"
#include "dovetail/core/error.hpp"
#include "mirror_images.hpp"

namespace dovetail::cg {

namespace {

using Facet = std::array<int, 3>;

constexpr int largestIterations = 500;  // each at least halves the error of a kernel without negative modes
constexpr double rowSumTolerance = 1e-14;

struct Vertices {
  std::vector<double> area;  ///< m²
  std::vector<int> facet;    ///< one of each vertex
};

Vertices gatherVertices(std::span<const Vec3> X, std::span<const Facet> facets, std::span<const int> patchOfFacet) {
  Vertices vertices{std::vector<double>(X.size(), 0.0), std::vector<int>(X.size(), -1)};
  for (int f = 0; f < static_cast<int>(facets.size()); ++f) {
    const auto [a, b, c] = facets[f];
    const double third = norm(cross(X[b] - X[a], X[c] - X[a])) / 6.0;
    for (int v : facets[f]) {
      vertices.area[v] += third;
      int& first = vertices.facet[v];
      if (first < 0) first = f;
      if (patchOfFacet[first] != patchOfFacet[f])
        throw InputError("the vertex lies on the patches " + std::to_string(patchOfFacet[first]) + " and " +
                             std::to_string(patchOfFacet[f]),
                         "symmetric kernel, vertex " + std::to_string(v), "split the surface between patches first");
    }
  }
  for (std::size_t v = 0; v < X.size(); ++v)
    if (!(vertices.area[v] > 0.0))
      throw InputError("the vertex has no area around it", "symmetric kernel, vertex " + std::to_string(v),
                       "leave it out, or repair its facets");
  return vertices;
}

/// Per patch: the rectangle that it is, or one without size.
std::map<int, Rectangle> rectangles(std::span<const Vec3> X, std::span<const Facet> facets,
                                    std::span<const int> patchOfFacet) {
  std::map<int, std::vector<int>> facetsOf;
  for (int f = 0; f < static_cast<int>(facets.size()); ++f) facetsOf[patchOfFacet[f]].push_back(f);
  std::map<int, Rectangle> found;
  for (const auto& [patch, members] : facetsOf) found[patch] = asRectangle(X, facets, members);
  return found;
}

/// Vertices × vertices, each row normalised on its own; with mirror images on rectangles.
Projection plainRows(const Kernel& kernel, std::span<const Vec3> X, std::span<const Facet> facets,
                     std::span<const int> patchOfFacet, std::span<const int> facetOfVertex) {
  const int count = static_cast<int>(X.size());
  const Projection identity = identityProjection(count);
  SurfaceKernelRows rows({kernel, KernelCorrection::none}, X, facets, patchOfFacet, identity);
  const std::map<int, Rectangle> rectangleOf = rectangles(X, facets, patchOfFacet);
  Projection plain{count, {0}, {}, {}};
  for (int v = 0; v < count; ++v) {
    const Facet& facet = facets[facetOfVertex[v]];
    std::array<double, 3> corner{};
    for (int k = 0; k < 3; ++k) corner[k] = facet[k] == v ? 1.0 : 0.0;
    const Rectangle& rectangle = rectangleOf.at(patchOfFacet[facetOfVertex[v]]);
    const std::vector<Vec3> images =
        rectangle.length[0] > 0.0 ? mirrorImages(rectangle, X[v], kernel.width) : std::vector<Vec3>{{}};
    rows.row(facetOfVertex[v], corner, images, plain.column, plain.weight);
    plain.offsets.push_back(static_cast<int>(plain.column.size()));
  }
  return plain;
}

double entry(const Projection& map, int row, int column) {
  const auto columns = map.rowColumns(row);
  const auto at = std::lower_bound(columns.begin(), columns.end(), column);
  return at != columns.end() && *at == column ? map.rowWeights(row)[static_cast<std::size_t>(at - columns.begin())]
                                              : 0.0;
}

/// √(A_v P_vl · A_l P_lv): symmetric to the last bit, and W between the two up to factors of v and of l.
Projection symmetricPart(const Projection& plain, std::span<const double> area) {
  Projection part{plain.columns, {0}, {}, {}};
  for (int v = 0; v < plain.rows(); ++v) {
    for (std::size_t k = 0; k < plain.rowColumns(v).size(); ++k) {
      const int l = plain.rowColumns(v)[k];
      const double there = area[v] * plain.rowWeights(v)[k], back = area[l] * entry(plain, l, v);
      if (!(there * back > 0.0)) continue;
      part.column.push_back(l);
      part.weight.push_back(std::sqrt(there * back));
    }
    part.offsets.push_back(static_cast<int>(part.column.size()));
  }
  return part;
}

/// The positive g with Σ_l g_v N_vl g_l = A_v.
std::vector<double> scaling(const Projection& part, std::span<const double> area) {
  std::vector<double> g(area.size(), 1.0), sum(area.size());
  for (int iteration = 0; iteration < largestIterations; ++iteration) {
    apply(part, g, sum);
    double error = 0.0;
    for (std::size_t v = 0; v < g.size(); ++v) {
      const double rowSum = g[v] * sum[v] / area[v];
      error = std::max(error, std::abs(rowSum - 1.0));
      g[v] /= std::sqrt(rowSum);
    }
    if (error <= rowSumTolerance) break;
  }
  return g;
}

}  // namespace

Projection symmetricKernelMap(const Kernel& kernel, std::span<const Vec3> vertices, std::span<const Facet> facets,
                              std::span<const int> patchOfFacet, const Projection& localMap) {
  requireValid(kernel, true);
  if (patchOfFacet.size() != facets.size() || static_cast<std::size_t>(localMap.rows()) != vertices.size())
    throw InputError("there are " + std::to_string(facets.size()) + " facets and " +
                         std::to_string(patchOfFacet.size()) + " patch numbers, " + std::to_string(vertices.size()) +
                         " vertices and " + std::to_string(localMap.rows()) + " rows in the local map",
                     "symmetric kernel", "give one patch per facet and one row per vertex");
  if (kernel.width == 0.0) return localMap;
  const Vertices own = gatherVertices(vertices, facets, patchOfFacet);
  Projection map = symmetricPart(plainRows(kernel, vertices, facets, patchOfFacet, own.facet), own.area);
  const std::vector<double> g = scaling(map, own.area);
  for (int v = 0; v < map.rows(); ++v)
    for (int k = map.offsets[v]; k < map.offsets[v + 1]; ++k) map.weight[k] *= g[v] * g[map.column[k]] / own.area[v];
  return product(map, localMap);
}

}  // namespace dovetail::cg
