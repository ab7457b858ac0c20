#include "dovetail/geometry/surface_topology.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/geometry/triangle.hpp"
#include "half_edges.hpp"

namespace dovetail::geometry {

namespace {

void listFacetsAtVertices(std::span<const Facet> facets, int vertexCount, SurfaceTopology& topology) {
  auto& offsets = topology.vertexFacetOffsets;
  offsets.assign(at(vertexCount) + 1, 0);
  for (const Facet& facet : facets)
    for (int v : facet) ++offsets[at(v) + 1];
  for (std::size_t v = 1; v < offsets.size(); ++v) offsets[v] += offsets[v - 1];
  topology.vertexFacets.resize(3 * facets.size());
  std::vector<int> next(offsets.begin(), offsets.end() - 1);
  for (std::size_t i = 0; i < facets.size(); ++i)
    for (int v : facets[i]) topology.vertexFacets[at(next[at(v)]++)] = static_cast<int>(i);
}

Vec3 areaNormal(std::span<const Vec3> x, const Facet& f) {
  return triangleAreaNormal(x[at(f[0])], x[at(f[1])], x[at(f[2])]);
}

}  // namespace

SurfaceTopology makeTopology(std::span<const Facet> facets, int vertexCount) {
  checkIndices(facets, vertexCount);
  for (std::size_t i = 0; i < facets.size(); ++i)
    if (repeatsVertex(facets[i]))
      throw InputError("a facet names the same vertex twice", "facet " + std::to_string(i),
                       "leave this facet out, or give it three different vertices");
  SurfaceTopology topology;
  topology.neighbours.assign(facets.size(), {-1, -1, -1});
  const auto edges = sortedEdges(facets);
  forEachEdgeGroup(edges, [&](std::span<const HalfEdge> group) {
    if (group.size() != 2) return;
    topology.neighbours[at(group[0].facet)][at(group[0].edge)] = group[1].facet;
    topology.neighbours[at(group[1].facet)][at(group[1].edge)] = group[0].facet;
  });
  listFacetsAtVertices(facets, vertexCount, topology);
  return topology;
}

int sharedEdge(std::span<const Facet> facets, int a, int edge, int b) {
  const Facet &from = facets[at(a)], &to = facets[at(b)];
  for (int k = 0; k < 3; ++k)
    if (std::minmax(tail(to, k), head(to, k)) == std::minmax(tail(from, edge), head(from, edge))) return k;
  return -1;
}

double edgeAngle(std::span<const Vec3> x, std::span<const Facet> facets, int facet, int edge,
                 const SurfaceTopology& topology) {
  const int other = topology.neighbours[at(facet)][at(edge)];
  if (other < 0)
    throw InputError("edge " + std::to_string(edge) + " has no neighbour, hence no angle",
                     "facet " + std::to_string(facet), "ask only where neighbours[facet][edge] ≥ 0");
  const Facet& f = facets[at(facet)];
  const int shared = sharedEdge(facets, facet, edge, other);
  const bool sameSense = tail(facets[at(other)], shared) == tail(f, edge);
  const Vec3 here = areaNormal(x, f), there = (sameSense ? -1.0 : 1.0) * areaNormal(x, facets[at(other)]);
  const Vec3 along = x[at(head(f, edge))] - x[at(tail(f, edge))];
  const double sine = dot(cross(here, there), along), cosine = dot(here, there) * norm(along);
  if (sine == 0.0) return cosine < 0.0 ? std::numbers::pi : 0.0;
  return std::atan2(sine, cosine);
}

std::vector<int> smoothPatches(std::span<const Vec3> x, std::span<const Facet> facets, const SurfaceTopology& topology,
                               double sharpAngle) {
  std::vector<int> patch(facets.size(), -1), front;
  std::vector<char> flat(facets.size());
  for (std::size_t i = 0; i < facets.size(); ++i) flat[i] = relativeHeight(x, facets[i]) <= roundOffHeight;
  int count = 0;
  for (std::size_t seed = 0; seed < facets.size(); ++seed) {
    if (patch[seed] >= 0) continue;
    patch[seed] = count;
    front.assign(1, static_cast<int>(seed));
    while (!front.empty()) {
      const int facet = front.back();
      front.pop_back();
      for (int k = 0; k < 3; ++k) {
        const int other = topology.neighbours[at(facet)][at(k)];
        if (other < 0 || patch[at(other)] >= 0 || flat[at(facet)] || flat[at(other)]) continue;
        if (std::abs(edgeAngle(x, facets, facet, k, topology)) > sharpAngle) continue;
        patch[at(other)] = count;
        front.push_back(other);
      }
    }
    ++count;
  }
  return patch;
}

}  // namespace dovetail::geometry
