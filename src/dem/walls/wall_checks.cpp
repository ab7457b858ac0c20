#include "dovetail/dem/walls/wall_checks.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::dem {

namespace {

void requireVector(const Vec3& v, const std::string& what) {
  if (!isFinite(v)) throw InputError("not a finite vector", what, "give three finite numbers");
}

void requireCommon(const std::optional<double>& skin, int material, int materials, const std::string& what) {
  if (skin) requireNonNegative(*skin, "skin of " + what);
  if (material < 0 || material >= materials)
    throw InputError("there is no law for material " + std::to_string(material), what,
                     "make the table as large as Particles::material and the walls' materials require");
}

/// Of the surface velocity that a shape can have and stay the same.
void requireAlongSurface(const PrimitiveWall& wall) {
  const Vec3& v = wall.surfaceVelocity;
  const double speed = norm(v), along = std::abs(dot(v, wall.axis)), small = 1e-9 * speed;
  const bool fits = wall.shape == PrimitiveWall::Shape::plane      ? along <= small
                    : wall.shape == PrimitiveWall::Shape::cylinder ? norm(cross(v, wall.axis)) <= small
                                                                   : speed == 0.0;
  if (!fits)
    throw InputError("its surface velocity points out of the surface", "primitive wall",
                     "along a plane, along the axis of a cylinder; a surface that turns has an angularVelocity");
}

}  // namespace

void validate(const PrimitiveWall& wall, int materials, const geometry::Periodicity& periodicity) {
  requireVector(wall.point, "point of a primitive wall");
  requireVector(wall.velocity, "velocity of a primitive wall");
  requireVector(wall.angularVelocity, "angular velocity of a primitive wall");
  requireVector(wall.surfaceVelocity, "surface velocity of a primitive wall");
  if (!(std::abs(norm(wall.axis) - 1.0) < 1e-9))
    throw InputError("its axis is no unit vector", "primitive wall", "take makePlane, makeCylinder or makeSphere");
  if (wall.shape != PrimitiveWall::Shape::plane) requirePositive(wall.radius, "radius of a primitive wall");
  requireCommon(wall.skin, wall.material, materials, "a primitive wall");
  requireAlongSurface(wall);
  if (wall.servo) validate(*wall.servo);
  requireRepeats(wall, periodicity, 0.0);
}

void validate(const MeshWall& mesh, int materials) {
  const TriangulatedWall& wall = mesh.wall;
  const std::string what = "a triangulated wall";
  if (wall.v.size() != wall.x.size() || wall.f.size() != wall.x.size() ||
      wall.topology.neighbours.size() != wall.facets.size())
    throw InputError("its arrays differ in length", what, "take makeWall");
  makeWall(wall.x, wall.facets, wall.oneSided);
  requireCommon(mesh.candidates.skin, wall.material, materials, what);
  requireVector(mesh.surfaceVelocity, "surface velocity of " + what);
  if (const auto* motion = std::get_if<PrescribedMotion>(&mesh.motion)) {
    if (!*motion) throw InputError("its motion is empty", what, "give a function, or leave it at rest");
    if (mesh.offset.size() != wall.x.size())
      throw InputError("its motion has no offsets", what, "set it by prescribe(mesh, motion, reference)");
  }
  if (const auto* servo = std::get_if<WallServo>(&mesh.motion)) validate(*servo);
}

namespace {

[[noreturn]] void refuseContacts(const std::string& problem) {
  throw InputError(problem, "contacts with a wall", "take an older checkpoint");
}

/// Numbers that are not finite, and lists that are not there for each of so many items.
class Lists {
public:
  explicit Lists(std::size_t items) : items_(items) {}
  /// @return itself, for one list after the other
  template <class... List>
  const Lists& each(const List&... lists) const {
    (need(lists.size() == items_, lists), ...);
    return *this;
  }
  /// Those that are empty where nobody uses them.
  template <class... List>
  const Lists& eachOrNone(const List&... lists) const {
    (need(lists.empty() || lists.size() == items_, lists), ...);
    return *this;
  }
  /// As many of each, whatever number that is.
  const Lists& several(const std::vector<double>& list) const {
    need(items_ == 0 ? list.empty() : list.size() % items_ == 0, list);
    return *this;
  }

private:
  static bool finite(double x) { return std::isfinite(x); }
  static bool finite(const Vec3& x) { return isFinite(x); }
  static bool finite(const std::array<double, 3>& x) { return isFinite({x[0], x[1], x[2]}); }
  template <class Whole>
  static bool finite(const Whole&) {
    return true;
  }
  template <class List>
  static void need(bool fits, const List& list) {
    if (!fits) refuseContacts("lists of a state do not fit each other");
    for (const auto& value : list)
      if (!finite(value)) refuseContacts("a number of a state is not finite");
  }
  std::size_t items_;
};

template <class Number>
void requireBelow(const std::vector<Number>& list, std::size_t end, const char* what) {
  for (const auto number : list)
    if (number < 0 || static_cast<std::size_t>(number) >= end)
      refuseContacts(std::string("there is no ").append(what).append(" ") + std::to_string(number));
}

}  // namespace

/// The numbers of particles are kept where some have left since contacts were found, the rest is not cut to length.
void requireWhole(const PrimitiveContacts& c) {
  Lists(c.normal.size()).each(c.normal, c.overlap, c.force).eachOrNone(c.couple, c.energy, c.sideEnergy, c.image);
  Lists(c.particle.size()).several(c.memory);
  if (c.particle.size() > c.normal.size()) refuseContacts("lists of a state do not fit each other");
}

void requireWhole(const WallContacts& c) {
  Lists(c.particle.size())
      .each(c.facet, c.weight, c.normal, c.overlap, c.engagement, c.energyFraction, c.force)
      .eachOrNone(c.couple, c.energy, c.sideEnergy, c.image);
  const WallSprings& s = c.springs;
  Lists(s.particle.size()).each(s.normal, s.fraction).several(s.memory);
}

void requireRows(const PrimitiveContacts& contacts, const WallRows& rows) {
  requireBelow(contacts.particle, rows.particles, "particle");
}

void requireRows(const WallContacts& contacts, const WallRows& rows, bool current) {
  requireBelow(contacts.springs.particle, rows.particles, "particle");
  requireBelow(contacts.facet, rows.facets, "facet");
  if (current) requireBelow(contacts.particle, rows.particles, "particle");
}

namespace {

/// FNV-1a, 64 bits.
class Hash {
public:
  void add(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (std::size_t k = 0; k < size; ++k) value_ = (value_ ^ bytes[k]) * 1099511628211ull;
  }
  template <class T>
  void add(const std::vector<T>& values) {
    const std::uint64_t count = values.size();
    add(&count, sizeof count);
    if (count > 0) add(values.data(), count * sizeof(T));
  }
  std::uint64_t value() const { return value_; }

private:
  std::uint64_t value_ = 14695981039346656037ull;
};

}  // namespace

std::uint64_t fingerprint(const MeshWall& mesh) {
  Hash hash;
  hash.add(mesh.wall.facets);
  const char sided = mesh.wall.oneSided ? 1 : 0;
  hash.add(&sided, 1);
  if (std::holds_alternative<AtRest>(mesh.motion)) hash.add(mesh.wall.x);
  if (const auto* carrier = std::get_if<WallOnBody>(&mesh.motion)) hash.add(carrier->offset);
  if (std::holds_alternative<PrescribedMotion>(mesh.motion) || std::holds_alternative<WallServo>(mesh.motion))
    hash.add(mesh.offset);
  return hash.value();
}

}  // namespace dovetail::dem
