#include "dovetail/dem/walls/wall_checks.hpp"

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
                     "make the table as large as Particles::material and the walls' materials ask for");
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
  if (wall.servo) makeServo(wall.servo->direction, wall.servo->load, wall.servo->mass, wall.servo->damping);
  requireRepeats(wall, periodicity, 0.0);
}

void validate(const MeshWall& mesh, int materials) {
  const TriangulatedWall& wall = mesh.wall;
  const std::string what = "a triangulated wall";
  if (wall.v.size() != wall.x.size() || wall.f.size() != wall.x.size() ||
      wall.topology.neighbours.size() != wall.facets.size())
    throw InputError("its arrays have unlike lengths", what, "take makeWall");
  makeWall(wall.x, wall.facets, wall.oneSided);
  requireCommon(mesh.candidates.skin, wall.material, materials, what);
  requireVector(mesh.surfaceVelocity, "surface velocity of " + what);
  if (const auto* motion = std::get_if<PrescribedMotion>(&mesh.motion)) {
    if (!*motion) throw InputError("its motion is empty", what, "give a function, or leave it at rest");
    if (mesh.offset.size() != wall.x.size())
      throw InputError("its motion has no offsets", what, "set it by prescribe(mesh, motion, reference)");
  }
  if (const auto* servo = std::get_if<WallServo>(&mesh.motion))
    makeServo(servo->direction, servo->load, servo->mass, servo->damping);
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
