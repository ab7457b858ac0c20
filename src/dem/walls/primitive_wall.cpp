#include "dovetail/dem/walls/primitive_wall.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/walls/wall_contacts.hpp"

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

void kickWall(PrimitiveWall& wall, double dt) {
  if (!wall.servo) return;
  takeContact(*wall.servo, wall.force, wall.torque, wall.point);
  kickServo(*wall.servo, dt);
}

namespace {
/// About the servo's axis, on which the wall's point need not lie.
void turnBy(WallServo& servo, PrimitiveWall& wall, double dt) {
  const Quaternion turn = fromRotationVector(dt * servo.speed * servo.direction);
  driftServo(servo, dt);
  wall.point = servo.point + rotate(turn, wall.point - servo.point);
  wall.velocity = servo.velocityAt(wall.point);
  wall.angularVelocity = servo.spin();
}
}  // namespace

void drift(PrimitiveWall& wall, double dt) {
  if (wall.servo && wall.servo->turns) {
    turnBy(*wall.servo, wall, dt);
  } else {
    if (wall.servo) {
      const Vec3& along = wall.servo->direction;
      wall.velocity += (wall.servo->speed - dot(wall.velocity, along)) * along;
      driftServo(*wall.servo, dt);
    }
    wall.point += dt * wall.velocity;
  }
  if (squaredNorm(wall.angularVelocity) == 0.0) return;
  // A turn by the angle |ω| dt about ω (Rodrigues).
  const double speed = norm(wall.angularVelocity), angle = speed * dt;
  const Vec3 about = wall.angularVelocity / speed;
  const auto turned = [&](const Vec3& a) {
    return std::cos(angle) * a + std::sin(angle) * cross(about, a) + (1.0 - std::cos(angle)) * dot(about, a) * about;
  };
  wall.axis = turned(wall.axis);
  wall.axis = wall.axis / norm(wall.axis);
  wall.surfaceVelocity = turned(wall.surfaceVelocity);
}

double drivingPower(const PrimitiveWall& wall) {
  Vec3 driven = wall.velocity + wall.surfaceVelocity, spin = wall.angularVelocity;
  if (wall.servo) driven -= wall.servo->velocityAt(wall.point), spin -= wall.servo->spin();
  return -dot(wall.force, driven) - dot(wall.torque, spin);
}

double renumber(PrimitiveWall& wall, std::span<const int> newNumber) {
  PrimitiveContacts& contacts = wall.contacts;
  const double stored = detail::energyOfLeavers(contacts, newNumber);
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
  wall.search.particleRevision = -1;
  return stored;
}

namespace detail {

namespace {

/// Memories of the old contacts begin … end − 1, to the contacts from those of the same particle on up to the next
/// old one's.
void carryPart(const Particles& particles, PrimitiveContacts& contacts, std::size_t components, std::size_t begin,
               std::size_t end, EndedMemories& ended) {
  const auto at = [&](std::size_t o) {
    if (o == 0) return std::size_t{0};
    if (o == contacts.oldParticle.size()) return contacts.size();
    return static_cast<std::size_t>(
        std::lower_bound(contacts.particle.begin(), contacts.particle.end(), contacts.oldParticle[o]) -
        contacts.particle.begin());
  };
  std::size_t c = at(begin);
  const std::size_t last = at(end);
  const auto place = [&](std::size_t contact) { return contacts.memory.data() + contact * components; };
  const auto startAnew = [&](std::size_t until) { std::fill(place(c), place(until), 0.0); };
  for (std::size_t o = begin; o < end; ++o) {
    std::size_t same = c;
    while (same < last && contacts.particle[same] < contacts.oldParticle[o]) ++same;
    startAnew(same);
    c = same;
    if (c < last && contacts.particle[c] == contacts.oldParticle[o])
      std::copy_n(contacts.oldMemory.data() + o * components, components, place(c++));
    else
      addEnded(ended, particles, contacts.oldParticle[o], contacts.oldMemory, o, components, 1.0);
  }
  startAnew(last);
}

}  // namespace

EndedMemories carryMemory(const Particles& particles, PrimitiveContacts& contacts, int memory,
                          const WallMemoryKind& kind) {
  constexpr std::size_t chunkSize = 1024;
  const auto components = static_cast<std::size_t>(memory);
  const std::size_t old = contacts.oldParticle.size();
  readAs(kind, memory, old, contacts.memoryKind, contacts.oldMemory);
  contacts.memory.resize(components * contacts.size());
  EndedMemories ended;
  if (old == 0) {
    std::fill(contacts.memory.begin(), contacts.memory.end(), 0.0);
    return ended;
  }
  std::vector<EndedMemories> parts((old + chunkSize - 1) / chunkSize);
  parallelFor(old, chunkSize, [&](std::size_t begin, std::size_t end) {
    carryPart(particles, contacts, components, begin, end, parts[begin / chunkSize]);
  });
  for (const EndedMemories& part : parts) {
    ended.memory.insert(ended.memory.end(), part.memory.begin(), part.memory.end());
    ended.material.insert(ended.material.end(), part.material.begin(), part.material.end());
    ended.fraction.insert(ended.fraction.end(), part.fraction.begin(), part.fraction.end());
  }
  return ended;
}

Vec3 relativeVelocity(const Particles& particles, const PrimitiveWall& wall, std::size_t c, bool spins) {
  const PrimitiveContacts& contacts = wall.contacts;
  const auto i = static_cast<std::size_t>(contacts.particle[c]);
  const Vec3 arm = (contacts.overlap[c] - particles.radius[i]) * contacts.normal[c];
  Vec3 velocity = particles.v[i] - velocityAt(wall, particles.x[i] + contacts.shift(c) + arm);
  if (spins && particles.rotates()) velocity += cross(particles.omega[i], arm);
  return velocity;
}

namespace {

/// On the wall.
struct Reaction {
  Vec3 force, torque;
  Reaction& operator+=(const Reaction& other) {
    force += other.force;
    torque += other.torque;
    return *this;
  }
};

}  // namespace

void addToParticles(Particles& particles, PrimitiveWall& wall, bool spins) {
  const PrimitiveContacts& contacts = wall.contacts;
  const Reaction sum = parallelSum(contacts.size(), 512, [&](std::size_t begin, std::size_t end) {
    Reaction part;
    for (std::size_t c = begin; c < end; ++c) {
      const auto i = static_cast<std::size_t>(contacts.particle[c]);
      const Vec3 arm = (contacts.overlap[c] - particles.radius[i]) * contacts.normal[c];
      particles.f[i] += contacts.force[c];
      part.force -= contacts.force[c];
      part.torque -= cross(particles.x[i] + contacts.shift(c) + arm - wall.point, contacts.force[c]);
      if (!spins) continue;
      particles.torque[i] += cross(arm, contacts.force[c]) + contacts.couple[c];
      part.torque -= contacts.couple[c];
    }
    return part;
  });
  wall.force = sum.force;
  wall.torque = sum.torque;
}

}  // namespace detail

}  // namespace dovetail::dem
