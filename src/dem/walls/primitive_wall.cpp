#include "dovetail/dem/walls/primitive_wall.hpp"

#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::dem {

namespace {

Vec3 unit(const Vec3& direction, const char* what) {
  const double length = norm(direction);
  if (!(length > 0.0) || !std::isfinite(length))
    throw InputError("the vector has no direction", what, "give three finite numbers that are not all zero");
  return direction / length;
}

void requireFinitePoint(const Vec3& point, const char* what) {
  if (!isFinite(point)) throw InputError("not a finite vector", what, "give three finite numbers");
}

/// From the axis or centre to x.
Vec3 fromCore(const PrimitiveWall& wall, const Vec3& x) {
  const Vec3 d = x - wall.point;
  return wall.shape == PrimitiveWall::Shape::cylinder ? d - dot(d, wall.axis) * wall.axis : d;
}

void search(const Particles& particles, PrimitiveWall& wall) {
  wall.near.clear();
  for (std::size_t i = 0; i < particles.size(); ++i)
    if (!(distanceTo(wall, particles.x[i]).distance > particles.radius[i] + wall.skin))
      wall.near.push_back(static_cast<int>(i));
  wall.travel = 0.0;
  wall.particlesAtSearch = particles.size();
  wall.searched = true;
}

}  // namespace

PrimitiveWall makePlane(const Vec3& point, const Vec3& normal) {
  requireFinitePoint(point, "point of the plane");
  PrimitiveWall wall;
  wall.point = point;
  wall.axis = unit(normal, "normal of the plane");
  return wall;
}

PrimitiveWall makeCylinder(const Vec3& point, const Vec3& axis, double radius, bool inside) {
  requireFinitePoint(point, "point on the cylinder's axis");
  PrimitiveWall wall;
  wall.shape = PrimitiveWall::Shape::cylinder;
  wall.point = point;
  wall.axis = unit(axis, "axis of the cylinder");
  wall.radius = requirePositive(radius, "radius of the cylinder");
  wall.inside = inside;
  return wall;
}

PrimitiveWall makeSphere(const Vec3& centre, double radius, bool inside) {
  requireFinitePoint(centre, "centre of the spherical wall");
  PrimitiveWall wall;
  wall.shape = PrimitiveWall::Shape::sphere;
  wall.point = centre;
  wall.radius = requirePositive(radius, "radius of the spherical wall");
  wall.inside = inside;
  return wall;
}

WallDistance distanceTo(const PrimitiveWall& wall, const Vec3& x) {
  if (wall.shape == PrimitiveWall::Shape::plane) return {dot(x - wall.point, wall.axis), wall.axis};
  const Vec3 d = fromCore(wall, x);
  const double length = norm(d);
  const Vec3 outwards = length > 0.0 ? d / length : Vec3{1.0, 0.0, 0.0};
  return wall.inside ? WallDistance{wall.radius - length, -outwards} : WallDistance{length - wall.radius, outwards};
}

void drift(PrimitiveWall& wall, double dt) {
  wall.point += dt * wall.velocity;
  if (squaredNorm(wall.angularVelocity) == 0.0) return;
  // A turn by the angle |ω| dt about ω (Rodrigues).
  const double speed = norm(wall.angularVelocity), angle = speed * dt;
  const Vec3 about = wall.angularVelocity / speed;
  wall.axis = std::cos(angle) * wall.axis + std::sin(angle) * cross(about, wall.axis) +
              (1.0 - std::cos(angle)) * dot(about, wall.axis) * about;
  wall.axis = wall.axis / norm(wall.axis);
}

void findContacts(const Particles& particles, PrimitiveWall& wall, double step) {
  wall.travel += step;
  const bool turns = wall.shape == PrimitiveWall::Shape::plane && squaredNorm(wall.angularVelocity) > 0.0;
  if (!wall.searched || turns || wall.particlesAtSearch != particles.size() || !(wall.travel <= wall.skin) ||
      wall.skin == 0.0)
    search(particles, wall);
  PrimitiveContacts& contacts = wall.contacts;
  contacts.oldParticle.swap(contacts.particle);
  contacts.oldMemory.swap(contacts.memory);
  contacts.particle.clear();
  contacts.normal.clear();
  contacts.overlap.clear();
  for (const int i : wall.near) {
    const auto [distance, normal] = distanceTo(wall, particles.x[static_cast<std::size_t>(i)]);
    const double overlap = particles.radius[static_cast<std::size_t>(i)] - distance;
    if (!(overlap > 0.0)) continue;
    contacts.particle.push_back(i);
    contacts.normal.push_back(normal);
    contacts.overlap.push_back(overlap);
  }
  contacts.engagement.assign(contacts.size(), 1.0);
}

void renumber(PrimitiveWall& wall, std::span<const int> newNumber) {
  PrimitiveContacts& contacts = wall.contacts;
  const std::size_t old = contacts.size(), components = old == 0 ? 0 : contacts.memory.size() / old;
  std::vector<std::pair<int, std::size_t>> kept;
  for (std::size_t c = 0; c < old; ++c)
    if (const int i = newNumber[static_cast<std::size_t>(contacts.particle[c])]; i >= 0) kept.emplace_back(i, c);
  std::sort(kept.begin(), kept.end());
  const std::vector<double> memory = std::move(contacts.memory);
  contacts.particle.clear();
  contacts.memory.clear();
  for (const auto& [i, c] : kept) {
    contacts.particle.push_back(i);
    for (std::size_t m = 0; m < components; ++m) contacts.memory.push_back(memory[c * components + m]);
  }
  wall.searched = false;
}

namespace detail {

EndedMemories carryMemory(PrimitiveContacts& contacts, int memory) {
  const auto components = static_cast<std::size_t>(memory);
  contacts.oldMemory.resize(components * contacts.oldParticle.size());
  contacts.memory.assign(components * contacts.size(), 0.0);
  EndedMemories ended;
  std::size_t c = 0;
  for (std::size_t o = 0; o < contacts.oldParticle.size(); ++o) {
    while (c < contacts.size() && contacts.particle[c] < contacts.oldParticle[o]) ++c;
    const bool stays = c < contacts.size() && contacts.particle[c] == contacts.oldParticle[o];
    for (std::size_t m = 0; m < components; ++m) {
      const double number = contacts.oldMemory[o * components + m];
      if (stays)
        contacts.memory[c * components + m] = number;
      else
        ended.memory.push_back(number);
    }
    if (!stays) ended.particle.push_back(contacts.oldParticle[o]);
  }
  return ended;
}

void addToParticles(Particles& particles, PrimitiveWall& wall, bool spins) {
  const PrimitiveContacts& contacts = wall.contacts;
  wall.force = wall.torque = {};
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const auto i = static_cast<std::size_t>(contacts.particle[c]);
    const Vec3 arm = (contacts.overlap[c] - particles.radius[i]) * contacts.normal[c];
    particles.f[i] += contacts.force[c];
    wall.force -= contacts.force[c];
    wall.torque -= cross(particles.x[i] + arm - wall.point, contacts.force[c]);
    if (!spins) continue;
    particles.torque[i] += cross(arm, contacts.force[c]) + contacts.couple[c];
    wall.torque -= contacts.couple[c];
  }
}

}  // namespace detail

}  // namespace dovetail::dem
