#include "closed_patches.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dovetail/geometry/box.hpp"
#include "dovetail/geometry/triangle_mesh.hpp"
#include "half_edges.hpp"

namespace dovetail::geometry {

namespace {

struct Link {
  int facet = -1;
  bool sameSense = false;
};

std::vector<std::array<Link, 3>> linksOverEdges(std::span<const Facet> facets) {
  std::vector<std::array<Link, 3>> links(facets.size());
  forEachEdgeGroup(sortedEdges(facets), [&](std::span<const HalfEdge> group) {
    if (group.size() != 2 || repeatsVertex(facets[at(group[0].facet)]) || repeatsVertex(facets[at(group[1].facet)]))
      return;
    const bool same = sameSense(facets, group[0], group[1]);
    links[at(group[0].facet)][at(group[0].edge)] = {group[1].facet, same};
    links[at(group[1].facet)][at(group[1].edge)] = {group[0].facet, same};
  });
  return links;
}

Box boundsOf(std::span<const Vec3> x, std::span<const Facet> facets) {
  Box box{x[at(facets[0][0])], x[at(facets[0][0])]};
  for (const Facet& f : facets)
    for (const int v : f)
      for (int k = 0; k < 3; ++k) {
        box.lower[k] = std::min(box.lower[k], x[at(v)][k]);
        box.upper[k] = std::max(box.upper[k], x[at(v)][k]);
      }
  return box;
}

bool holds(const Box& box, const Vec3& p) {
  for (int k = 0; k < 3; ++k)
    if (p[k] < box.lower[k] || p[k] > box.upper[k]) return false;
  return true;
}

}  // namespace

Patches findPatches(std::span<const Facet> facets) {
  const auto links = linksOverEdges(facets);
  Patches patches;
  patches.turned.assign(facets.size(), 0);
  std::vector<char> seen(facets.size(), 0);
  std::vector<int> front;
  for (std::size_t seed = 0; seed < facets.size(); ++seed) {
    if (seen[seed] || repeatsVertex(facets[seed])) continue;
    seen[seed] = 1;
    std::vector<int> patch;
    bool closed = true, oriented = true;
    for (front.assign(1, static_cast<int>(seed)); !front.empty();) {
      const int facet = front.back();
      front.pop_back();
      patch.push_back(facet);
      for (const Link& link : links[at(facet)]) {
        if (link.facet < 0) {
          closed = false;
          continue;
        }
        const char turned = patches.turned[at(facet)] != static_cast<char>(link.sameSense);
        if (seen[at(link.facet)]) {
          oriented = oriented && patches.turned[at(link.facet)] == turned;
          continue;
        }
        seen[at(link.facet)] = 1;
        patches.turned[at(link.facet)] = turned;
        front.push_back(link.facet);
      }
    }
    std::sort(patch.begin(), patch.end());
    patches.facets.push_back(std::move(patch));
    patches.closed.push_back(closed);
    patches.oriented.push_back(oriented);
  }
  return patches;
}

std::vector<int> wrongSideOut(std::span<const Vec3> x, std::span<const Facet> facets,
                              const std::vector<std::vector<int>>& patches) {
  std::vector<std::vector<Facet>> own;
  std::vector<Box> box;
  for (const auto& patch : patches) {
    own.emplace_back();
    for (const int f : patch) own.back().push_back(facets[at(f)]);
    box.push_back(boundsOf(x, own.back()));
  }
  std::vector<int> wrong;
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const Facet& first = own[p].front();
    const Vec3 point = (x[at(first[0])] + x[at(first[1])] + x[at(first[2])]) / 3.0;
    bool cavity = false;
    for (std::size_t q = 0; q < patches.size(); ++q)
      if (q != p && holds(box[q], point) && std::abs(windingNumber(x, own[q], point)) > 0.5) cavity = !cavity;
    const double volume = signedVolume(x, own[p]);
    if (cavity ? volume > 0.0 : volume < 0.0) wrong.push_back(static_cast<int>(p));
  }
  return wrong;
}

double signedVolume(std::span<const Vec3> x, std::span<const Facet> facets) {
  if (facets.empty()) return 0.0;
  // Taken about a vertex of the surface, so that a body far from the origin loses no digits.
  const Vec3 origin = x[at(facets[0][0])];
  double sum = 0.0;
  for (const Facet& f : facets) sum += dot(x[at(f[0])] - origin, cross(x[at(f[1])] - origin, x[at(f[2])] - origin));
  return sum / 6.0;
}

double windingNumber(std::span<const Vec3> x, std::span<const Facet> facets, const Vec3& point) {
  double sum = 0.0;
  for (const Facet& f : facets) {
    const Vec3 a = x[at(f[0])] - point, b = x[at(f[1])] - point, c = x[at(f[2])] - point;
    const double la = norm(a), lb = norm(b), lc = norm(c);
    sum += std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
  }
  return sum / (2.0 * std::numbers::pi);
}

}  // namespace dovetail::geometry
