// A facet as seen from a point: distance, normal and foot, with sign where the wall has an outside.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "dovetail/dem/walls/wall.hpp"
#include "dovetail/geometry/triangle.hpp"

namespace dovetail::dem {

struct FacetView {
  static constexpr double unseen = std::numeric_limits<double>::infinity();
  double distance = unseen;  // m; < 0 below the face of a one-sided wall
  Vec3 normal, foot;         // unit, from the facet to the point; m
  std::array<double, 3> weight{};
  geometry::Feature feature = geometry::Feature::face;
  double sunk = 0.0;  // > 0: how far, m, the point lies inside a one-sided wall behind this edge or vertex (unseen)

  bool face() const { return feature == geometry::Feature::face; }
  /// Of a one-sided wall from its back.
  bool behind() const { return distance < 0.0 || sunk > 0.0; }
  double farness() const { return sunk > 0.0 ? sunk : std::abs(distance); }
};

/// The vertices of a facet seen from an origin near by: differences keep their digits far from the global origin.
class FacetCorners {
public:
  Vec3 a, b, c;
  FacetCorners(const TriangulatedWall& wall, int facet, const Vec3& origin) {
    const auto& vertex = wall.facets[static_cast<std::size_t>(facet)];
    a = wall.x[static_cast<std::size_t>(vertex[0])] - origin;
    b = wall.x[static_cast<std::size_t>(vertex[1])] - origin;
    c = wall.x[static_cast<std::size_t>(vertex[2])] - origin;
  }

  /// Whether even the bounding box is farther than reach from the origin: spares most facets the closer look.
  bool beyond(double reach) const {
    const Vec3 d{gap(a.x, b.x, c.x), gap(a.y, b.y, c.y), gap(a.z, b.z, c.z)};
    return squaredNorm(d) >= reach * reach;
  }

private:
  static double gap(double p, double q, double r) {
    return std::max(std::max(std::min(std::min(p, q), r), -std::max(std::max(p, q), r)), 0.0);
  }
};

namespace detail {

inline void viewFace(const Vec3& d, const Vec3& areaNormal, bool oneSided, FacetView& view) {
  view.normal = areaNormal / norm(areaNormal);
  view.distance = dot(view.normal, d);
  if (view.distance < 0.0 && !oneSided) {
    view.normal = -view.normal;
    view.distance = -view.distance;
  }
}

/// A point on the edge itself has no direction to it: the normal of the facet, or z if it has none.
inline Vec3 normalOnEdge(const Vec3& areaNormal) {
  const double area = norm(areaNormal);
  return area > 0.0 ? areaNormal / area : Vec3{0.0, 0.0, 1.0};
}

}  // namespace detail

/// @param q       the point, in the same frame as the corners
/// @param radius  of the particle; a one-sided face reaches this far below itself
/// @param reach   facets beyond it need not be seen
/// @param view    filled in place, as clearing one would cost as much as looking; of a facet that is not seen only
///   distance and sunk, and where it is sunk the rest as well
inline void viewFacet(const Vec3& q, const FacetCorners& t, double radius, double reach, bool oneSided,
                      FacetView& view) {
  view.distance = FacetView::unseen;
  view.sunk = 0.0;
  const geometry::ClosestPoint closest = geometry::closestPointOnTriangle(q, t.a, t.b, t.c);
  const Vec3 d = q - closest.point;
  const double d2 = squaredNorm(d);
  if (!(d2 < reach * reach)) return;
  view.foot = closest.point;
  view.weight = closest.barycentric;
  view.feature = closest.feature;
  const Vec3 areaNormal = geometry::triangleAreaNormal(t.a, t.b, t.c);
  if (view.face()) {
    detail::viewFace(d, areaNormal, oneSided, view);
    if (view.distance <= -radius) view.distance = FacetView::unseen;
    return;
  }
  const double distance = std::sqrt(d2);
  if (oneSided) {
    // Seen from inside the skin an edge does not push: a face near by does. Facets without area have no inside.
    const double roundOff = 1e-8 * geometry::longestEdgeSquared(t.a, t.b, t.c) * distance;
    if (dot(areaNormal, d) < -roundOff) {
      view.sunk = distance;
      view.normal = d / -distance;
      return;
    }
  }
  view.distance = distance;
  view.normal = distance > 1e-13 * radius ? d / distance : detail::normalOnEdge(areaNormal);
}

}  // namespace dovetail::dem
