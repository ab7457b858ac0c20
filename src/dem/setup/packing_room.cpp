// Rooms of packings: cylinders, and the inside of closed surfaces.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/bodies/mass_properties.hpp"
#include "dovetail/dem/setup/packing.hpp"
#include "room_surface.hpp"

namespace dovetail::dem {

PackingRoom cylinderRoom(const Vec3& point, const Vec3& axis, double radius, double length) {
  requirePositive(radius, "radius of the cylinder");
  requirePositive(length, "length of the cylinder");
  if (!isFinite(point)) throw InputError("not a finite vector", "point of the cylinder", "give three finite numbers");
  if (!(norm(axis) > 0.0) || !isFinite(axis))
    throw InputError("the axis of the cylinder has no length", "", "give it a direction, such as [0, 0, 1]");
  const Vec3 along = normalized(axis), end = point + length * along;
  PackingRoom room;
  for (int k = 0; k < 3; ++k) {
    const double width = radius * std::sqrt(std::max(0.0, 1.0 - along[k] * along[k]));
    room.box.lower[k] = std::min(point[k], end[k]) - width;
    room.box.upper[k] = std::max(point[k], end[k]) + width;
  }
  room.walls = {makeCylinder(point, along, radius, true), makePlane(point, along), makePlane(end, -along)};
  room.volume = std::numbers::pi * radius * radius * length;
  return room;
}

PackingRoom roomInside(geometry::TriangleMesh surface) {
  PackingRoom room;
  room.volume = solidInside(surface.x, surface.facets, Density{1.0}).mass;
  room.box = {surface.x.front(), surface.x.front()};
  for (const Vec3& x : surface.x)
    for (int k = 0; k < 3; ++k) {
      room.box.lower[k] = std::min(room.box.lower[k], x[k]);
      room.box.upper[k] = std::max(room.box.upper[k], x[k]);
    }
  room.surface = std::move(surface);
  return room;
}

RoomSurface::RoomSurface(const geometry::TriangleMesh& mesh) : mesh_(mesh) {
  std::vector<Vec3> centre;
  std::vector<double> radius;
  for (const geometry::Facet& facet : mesh_.facets) {
    const auto corner = [&](std::size_t k) { return mesh_.x[static_cast<std::size_t>(facet[k])]; };
    centre.push_back((1.0 / 3.0) * (corner(0) + corner(1) + corner(2)));
    double farthest = 0.0;
    for (const std::size_t k : {0U, 1U, 2U}) farthest = std::max(farthest, norm(corner(k) - centre.back()));
    radius.push_back(farthest);
  }
  if (!centre.empty()) grid_.build(centre, radius);
}

}  // namespace dovetail::dem
