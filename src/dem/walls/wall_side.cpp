#include "wall_side.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dovetail::dem {

bool onRim(const MetWall& met, std::size_t entry, geometry::Feature feature) {
  const TriangulatedWall& wall = *met.wall;
  if (feature == geometry::Feature::face || !wall.corner.empty()) return false;
  const auto open = [&](int f) {
    const auto& neighbours = wall.topology.neighbours[static_cast<std::size_t>(f)];
    return std::find(neighbours.begin(), neighbours.end(), -1) != neighbours.end();
  };
  const int facet = met.encounter.facet[entry];
  if (!geometry::isVertex(feature)) return open(facet);
  const auto corner = static_cast<std::size_t>(feature) - static_cast<std::size_t>(geometry::Feature::vertex0);
  const auto around = wall.topology.facetsAtVertex(wall.facets[static_cast<std::size_t>(facet)][corner]);
  return std::any_of(around.begin(), around.end(), open);
}

namespace {

/// Angle of the facet around a point of one of its features.
double angleAround(const FacetCorners& t, geometry::Feature feature) {
  using enum geometry::Feature;
  if (feature == face) return 2.0 * std::numbers::pi;
  if (geometry::isEdge(feature)) return std::numbers::pi;
  const auto between = [](const Vec3& at, const Vec3& p, const Vec3& q) {
    return std::atan2(norm(cross(p - at, q - at)), dot(p - at, q - at));
  };
  if (feature == vertex0) return between(t.a, t.b, t.c);
  return feature == vertex1 ? between(t.b, t.c, t.a) : between(t.c, t.a, t.b);
}

}  // namespace

bool insideWall(std::span<const MetWall> walls, double nearest) {
  double side = 0.0;
  for (const MetWall& met : walls) {
    if (!met.wall->oneSided) continue;
    const double reach = nearest + 2.0 * sameFoot * met.encounter.radius;
    for (std::size_t k = 0; k < met.encounter.size(); ++k) {
      const FacetCorners t = met.corners(k);
      if (t.beyond(reach)) continue;
      const geometry::ClosestPoint closest = geometry::closestPointOnTriangle({}, t.a, t.b, t.c);
      const double distance = norm(closest.point);
      const Vec3 normal = geometry::triangleNormal(t.a, t.b, t.c);
      const double across = -dot(normal, closest.point);
      if (!(distance < reach) || (across < 0.0 && onRim(met, k, closest.feature))) continue;
      side += angleAround(t, closest.feature) * across;
    }
  }
  return side < -sameFoot * nearest;
}

}  // namespace dovetail::dem
