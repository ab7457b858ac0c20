#include <algorithm>
#include <cmath>

#include "dovetail/geometry/box.hpp"
#include "dovetail/geometry/hierarchical_grid.hpp"
#include "dovetail/geometry/predicates.hpp"
#include "dovetail/geometry/surface_checks.hpp"
#include "half_edges.hpp"

namespace dovetail::geometry {

namespace {

using Corners = std::array<Vec3, 3>;

Corners cornersOf(std::span<const Vec3> x, const Facet& f) { return {x[at(f[0])], x[at(f[1])], x[at(f[2])]}; }

bool boxesMeet(const Box& a, const Box& b) {
  for (int k = 0; k < 3; ++k)
    if (a.lower[k] > b.upper[k] || b.lower[k] > a.upper[k]) return false;
  return true;
}

/// Common vertices first, in the same order in both; their number.
int alignCommon(Facet& a, Facet& b) {
  int common = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = common; j < 3; ++j)
      if (a[at(i)] == b[at(j)]) {
        std::swap(a[at(i)], a[at(common)]);
        std::swap(b[at(j)], b[at(common)]);
        ++common;
        break;
      }
  return common;
}

/// Two facets over the common edge a0 a1 with their third vertices: folded onto each other?
bool folded(const Corners& a, const Vec3& third) {
  if (orientation(a[0], a[1], a[2], third) != 0) return false;
  for (int axis = 0; axis < 3; ++axis) {
    const int sense = orientation(a[0], a[1], a[2], axis);
    if (sense != 0) return orientation(a[0], a[1], third, axis) == sense;
  }
  return false;
}

/// Beyond what the numbers say they share.
bool intersect(std::span<const Vec3> x, Facet a, Facet b) {
  const int common = alignCommon(a, b);
  const Corners p = cornersOf(x, a), q = cornersOf(x, b);
  if (common == 0) return trianglesMeet(p, q);
  if (common == 1) return segmentMeetsTriangle(p[1], p[2], q) || segmentMeetsTriangle(q[1], q[2], p);
  return common == 2 && folded(p, q[2]);
}

}  // namespace

std::vector<std::array<int, 2>> selfIntersections(std::span<const Vec3> x, std::span<const Facet> facets) {
  checkVertices(x);
  checkIndices(facets, static_cast<int>(x.size()));
  std::vector<int> number;
  std::vector<Box> box;
  std::vector<Vec3> middle;
  std::vector<double> radius;
  for (std::size_t i = 0; i < facets.size(); ++i) {
    const Corners c = cornersOf(x, facets[i]);
    if (repeatsVertex(facets[i]) || areCollinear(c[0], c[1], c[2])) continue;
    number.push_back(static_cast<int>(i));
    box.push_back(boundingBox(c[0], c[1], c[2]));
    middle.push_back(0.5 * (box.back().lower + box.back().upper));
    const double size = std::max({norm(middle.back()), norm(box.back().upper - box.back().lower)});
    radius.push_back(0.5 * norm(box.back().upper - box.back().lower) + 1e-14 * size);
  }
  HierarchicalGrid grid;
  grid.build(middle, radius);
  std::vector<std::array<int, 2>> found;
  grid.forEachPair([&](int i, int j) {
    if (!boxesMeet(box[at(i)], box[at(j)])) return;
    if (intersect(x, facets[at(number[at(i)])], facets[at(number[at(j)])]))
      found.push_back({number[at(i)], number[at(j)]});
  });
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace dovetail::geometry
