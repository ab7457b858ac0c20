// The closed surface of a packing's room, as spheres inside see it.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "dovetail/geometry/hierarchical_grid.hpp"
#include "dovetail/geometry/triangle.hpp"
#include "dovetail/geometry/triangle_mesh.hpp"

namespace dovetail::dem {

class RoomSurface {
public:
  RoomSurface() = default;
  explicit RoomSurface(const geometry::TriangleMesh& mesh);

  bool isEmpty() const { return mesh_.facets.empty(); }
  bool isInside(const Vec3& x) const { return geometry::windingNumber(mesh_.x, mesh_.facets, x) > 0.5; }
  /// Calls act(distance, direction) for every part of the surface that is nearer than `radius` to a sphere's centre:
  /// all faces above which it lies, and the nearest edge or vertex if that is nearer than all of them. Distances are
  /// < 0 from outside, m; directions are unit, to the inside.
  template <class Act>
  void forEachNear(const Vec3& x, double radius, Act&& act) const;

private:
  struct Near {
    double squared;
    geometry::ClosestPoint at;
    double height;  // over the facet's plane, to the inside, m
    Vec3 inwards;
  };
  static bool isNearer(const Near& a, const Near& b) {
    if (std::abs(a.squared - b.squared) > 1e-12 * (a.squared + b.squared)) return a.squared < b.squared;
    return std::abs(a.height) > std::abs(b.height);  // facets that share an edge: the one that is seen best has the say
  }
  geometry::TriangleMesh mesh_;
  geometry::HierarchicalGrid grid_;  // of spheres around the facets
};

template <class Act>
void RoomSurface::forEachNear(const Vec3& x, double radius, Act&& act) const {
  const Vec3 reach{radius, radius, radius};
  std::vector<Near> found;
  for (const int f : grid_.query(geometry::Box{x - reach, x + reach})) {
    const geometry::Facet& facet = mesh_.facets[static_cast<std::size_t>(f)];
    const auto corner = [&](std::size_t k) { return mesh_.x[static_cast<std::size_t>(facet[k])]; };
    const Vec3 a = corner(0), b = corner(1), c = corner(2), inwards = -geometry::triangleNormal(a, b, c);
    const geometry::ClosestPoint at = geometry::closestPointOnTriangle(x, a, b, c);
    const double squared = squaredNorm(x - at.point);
    if (squared < radius * radius) found.push_back({squared, at, dot(x - a, inwards), inwards});
  }
  if (found.empty()) return;
  std::size_t nearest = 0;
  for (std::size_t k = 1; k < found.size(); ++k)
    if (isNearer(found[k], found[nearest])) nearest = k;
  const Near& first = found[nearest];
  const double distance = std::sqrt(first.squared);
  const bool inside = first.height > 0.0;
  if (first.at.feature != geometry::Feature::face && distance > 0.0)
    act(inside ? distance : -distance, ((inside ? 1.0 : -1.0) / distance) * (x - first.at.point));
  else
    act(first.height, first.inwards);
  for (std::size_t k = 0; k < found.size() && inside; ++k)
    if (k != nearest && found[k].at.feature == geometry::Feature::face && found[k].height > 0.0)
      act(found[k].height, found[k].inwards);
}

}  // namespace dovetail::dem
