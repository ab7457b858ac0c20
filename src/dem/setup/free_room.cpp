#include "free_room.hpp"

#include <algorithm>

#include "dovetail/core/parallel.hpp"
#include "dovetail/geometry/triangle.hpp"

namespace dovetail::dem {

namespace {

std::vector<Vec3> periodShifts(const geometry::Periodicity& space) {
  std::vector<Vec3> shifts{Vec3{}};
  for (int k = 0; k < 3; ++k) {
    if (!space.axes[static_cast<std::size_t>(k)]) continue;
    Vec3 period;
    period[k] = space.length(k);
    for (std::size_t n = shifts.size(), s = 0; s < n; ++s)
      for (const double side : {-1.0, 1.0}) shifts.push_back(shifts[s] + side * period);
  }
  return shifts;
}

bool meet(const geometry::Box& a, const geometry::Box& b) {
  for (int k = 0; k < 3; ++k)
    if (a.upper[k] < b.lower[k] || a.lower[k] > b.upper[k]) return false;
  return true;
}

/// Which particles reach into the region, one flag each.
std::vector<char> reachInto(const Particles& particles, const geometry::Periodicity& space,
                            const geometry::Box& region) {
  const Vec3 middle = 0.5 * (region.lower + region.upper), half = 0.5 * (region.upper - region.lower);
  std::vector<char> near(particles.size(), 0);
  parallelFor(near.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 d = space.minimumImage(particles.x[i] - middle);
      const double r = particles.radius[i];
      near[i] = std::abs(d.x) <= half.x + r && std::abs(d.y) <= half.y + r && std::abs(d.z) <= half.z + r;
    }
  });
  return near;
}

}  // namespace

FreeRoom::FreeRoom(const Particles& particles, const Surroundings& surroundings, const geometry::Box& region)
    : surroundings_(surroundings), shifts_(periodShifts(surroundings.space)), grid_(surroundings.space) {
  const std::vector<char> near = reachInto(particles, surroundings.space, region);
  for (std::size_t i = 0; i < near.size(); ++i)
    if (near[i] != 0) {
      x_.push_back(particles.x[i]);
      radius_.push_back(particles.radius[i]);
    }
  sortIn();
  for (const TriangulatedWall* wall : surroundings.meshes) addFacets(*wall, region);
  for (const auto& place : surroundings.placed) addFacets(place(), region);
}

void FreeRoom::addFacets(const TriangulatedWall& wall, const geometry::Box& region) {
  const auto corner = [&](int v) { return wall.x[static_cast<std::size_t>(v)]; };
  for (const geometry::Facet& facet : wall.facets) {
    const Triangle t{corner(facet[0]), corner(facet[1]), corner(facet[2])};
    for (const Vec3& shift : shifts_)
      if (meet(geometry::boundingBox(t[0] + shift, t[1] + shift, t[2] + shift), region))
        facets_.push_back({{t[0] + shift, t[1] + shift, t[2] + shift}, wall.oneSided});
  }
}

void FreeRoom::sortIn() {
  grid_.build(x_, radius_);
  sorted_ = x_.size();
}

void FreeRoom::add(const Vec3& x, double radius) {
  x_.push_back(x);
  radius_.push_back(radius);
  if (x_.size() > sorted_ + 64 + sorted_ / 4) sortIn();
}

bool FreeRoom::clearOf(std::size_t i, const Vec3& x, double radius) const {
  const double sum = radius_[i] + radius;
  return squaredNorm(surroundings_.space.minimumImage(x_[i] - x)) > sum * sum;
}

bool FreeRoom::clearOfWalls(const Vec3& x, double radius) const {
  for (const PrimitiveWall* wall : surroundings_.walls) {
    // Planes and containers stand once; what particles are outside of stands in every period.
    const bool repeats = wall->shape != PrimitiveWall::Shape::plane && !wall->inside;
    for (std::size_t s = 0; s < (repeats ? shifts_.size() : 1); ++s)
      if (!(distanceTo(*wall, x + shifts_[s]).distance >= radius)) return false;
  }
  return true;
}

bool FreeRoom::clearOfFacets(const Vec3& x, double radius) const {
  const Facet* nearest = nullptr;  // of the skins
  double distance = 0.0;
  for (const Facet& facet : facets_) {
    const auto& [a, b, c] = facet.corner;
    const double d2 = squaredNorm(x - geometry::closestPointOnTriangle(x, a, b, c).point);
    if (d2 < radius * radius) return false;
    if (!facet.oneSided || (nearest && d2 >= distance)) continue;
    nearest = &facet;
    distance = d2;
  }
  if (!nearest) return true;
  const auto& [a, b, c] = nearest->corner;
  return dot(geometry::triangleAreaNormal(a, b, c), x - a) > 0.0;
}

bool FreeRoom::isFree(const Vec3& x, double radius) const {
  if (!clearOfWalls(x, radius)) return false;
  const Vec3 reach{radius, radius, radius};
  bool free = true;
  grid_.query(geometry::Box{x - reach, x + reach},
              [&](int i) { free = free && clearOf(static_cast<std::size_t>(i), x, radius); });
  for (std::size_t i = sorted_; free && i < x_.size(); ++i) free = clearOf(i, x, radius);
  return free && clearOfFacets(x, radius);
}

}  // namespace dovetail::dem
