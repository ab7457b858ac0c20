// Edges of facets, grouped by the vertices they join.
#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "dovetail/core/error.hpp"
#include "dovetail/core/vec3.hpp"
#include "dovetail/geometry/surface_topology.hpp"
#include "dovetail/geometry/triangle.hpp"

namespace dovetail::geometry {

inline std::size_t at(int i) { return static_cast<std::size_t>(i); }

inline int tail(const Facet& facet, int edge) { return facet[at(edge)]; }
inline int head(const Facet& facet, int edge) { return facet[at((edge + 1) % 3)]; }

inline bool repeatsVertex(const Facet& f) { return f[0] == f[1] || f[1] == f[2] || f[2] == f[0]; }

inline void checkIndices(std::span<const Facet> facets, int vertexCount) {
  for (std::size_t i = 0; i < facets.size(); ++i)
    for (int v : facets[i])
      if (v < 0 || v >= vertexCount)
        throw InputError("vertex number " + std::to_string(v) + " does not exist", "facet " + std::to_string(i),
                         "use numbers from 0 to " + std::to_string(vertexCount - 1));
}

inline void checkVertices(std::span<const Vec3> x) {
  for (std::size_t i = 0; i < x.size(); ++i)
    if (!isFinite(x[i]))
      throw InputError("not a finite vector", "vertex " + std::to_string(i), "give three finite numbers");
}

/// Height over the longest edge, as a fraction of that edge; 0 for a point.
inline double relativeHeight(std::span<const Vec3> x, const Facet& f) {
  const Vec3 &a = x[at(f[0])], &b = x[at(f[1])], &c = x[at(f[2])];
  const double longest2 = longestEdgeSquared(a, b, c);
  return longest2 > 0.0 ? norm(triangleAreaNormal(a, b, c)) / longest2 : 0.0;
}

/// Relative height up to which a facet has no area but round-off.
inline constexpr double roundOffHeight = 1e-14;

struct HalfEdge {
  int low, high, facet, edge;
  auto vertices() const { return std::pair(low, high); }
};

/// All facet edges, sorted so that those between the same two vertices are adjacent.
inline std::vector<HalfEdge> sortedEdges(std::span<const Facet> facets) {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * facets.size());
  for (std::size_t i = 0; i < facets.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const int a = tail(facets[i], k), b = head(facets[i], k);
      edges.push_back({std::min(a, b), std::max(a, b), static_cast<int>(i), k});
    }
  std::stable_sort(edges.begin(), edges.end(),
                   [](const HalfEdge& a, const HalfEdge& b) { return a.vertices() < b.vertices(); });
  return edges;
}

/// Calls visit(group) for each group of edges between the same two vertices.
template <class Visit>
void forEachEdgeGroup(const std::vector<HalfEdge>& edges, Visit&& visit) {
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end].vertices() == edges[begin].vertices()) ++end;
    visit(std::span<const HalfEdge>(edges).subspan(begin, end - begin));
  }
}

/// Whether both of the facets that share an edge run through it in the same sense.
inline bool sameSense(std::span<const Facet> facets, const HalfEdge& a, const HalfEdge& b) {
  return tail(facets[at(a.facet)], a.edge) == tail(facets[at(b.facet)], b.edge);
}

}  // namespace dovetail::geometry
