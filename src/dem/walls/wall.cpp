#include "dovetail/dem/walls/wall.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "dovetail/core/error.hpp"

namespace dovetail::dem {

TriangulatedWall makeWall(std::vector<Vec3> x, std::vector<geometry::Facet> facets, bool oneSided) {
  for (std::size_t i = 0; i < x.size(); ++i)
    if (!isFinite(x[i]))
      throw InputError("not a finite vector", "wall vertex " + std::to_string(i) + ", position",
                       "give three finite numbers");
  TriangulatedWall wall;
  wall.topology = geometry::makeTopology(facets, static_cast<int>(x.size()));
  wall.v.resize(x.size());
  wall.f.resize(x.size());
  wall.x = std::move(x);
  wall.facets = std::move(facets);
  wall.oneSided = oneSided;
  return wall;
}

void clearForces(TriangulatedWall& wall) { std::fill(wall.f.begin(), wall.f.end(), Vec3{}); }

Vec3 totalForce(const TriangulatedWall& wall) {
  Vec3 sum;
  for (const Vec3& f : wall.f) sum += f;
  return sum;
}

Vec3 totalMoment(const TriangulatedWall& wall, const Vec3& about) {
  Vec3 sum;
  for (std::size_t i = 0; i < wall.f.size(); ++i) sum += cross(wall.x[i] - about, wall.f[i]);
  return sum;
}

double forcePower(const TriangulatedWall& wall) {
  double sum = 0.0;
  for (std::size_t i = 0; i < wall.f.size(); ++i) sum += dot(wall.f[i], wall.v[i]);
  return sum;
}

}  // namespace dovetail::dem
