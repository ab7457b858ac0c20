// Rigid walls of a scene.
#include "dovetail/dem/model/walls.hpp"

#include <algorithm>

#include "dovetail/geometry/triangle_mesh.hpp"
#include "parts.hpp"
#include "time_functions.hpp"

namespace dovetail::scene {

namespace {

/// A wall with what it needs to move.
struct Target {
  coupling::CoupledRun& run;
  const Wall& wall;
  const Scene& scene;
  std::vector<std::string>& notes;
  bool isSteady() const { return !wall.displacement && !wall.turn && isConstant(wall.velocity); }
};

/// Where a wall is at a time, from how it is described; `about` is its point.
dem::PrescribedMotion motionOf(const Target& to, const Vec3& about) {
  const Wall& wall = to.wall;
  if (wall.turn && norm(wall.angularVelocity) > 0.0)
    throw InputError("both an angular velocity and a turn are given", "", "leave one of them out");
  if (wall.turn && norm(wall.turn->axis) == 0.0)
    throw InputError("the axis of the turn has no length", "", "give it a direction, such as [0, 0, 1]");
  const Path path = pathOf(wall.velocity, wall.displacement, to.scene);
  const double speed = norm(wall.angularVelocity);
  const Vec3 axis = wall.turn ? normalized(wall.turn->axis) : speed > 0.0 ? wall.angularVelocity / speed : Vec3{};
  const Travel angle = wall.turn ? travelOf(wall.turn->angle, to.scene) : travelAt({speed, ""}, to.scene);
  return [=](double t) {
    return dem::RigidMotion{about + path.displacement(t), fromRotationVector(angle.displacement(t) * axis),
                            path.velocity(t), angle.velocity(t) * axis};
  };
}

/// The wall as `motion` has it at a time, or so that it drifts there in a step that long.
void place(dem::PrimitiveWall& wall, const dem::RigidMotion& now, const Vec3& axis, double dt) {
  wall.velocity = now.v;
  wall.angularVelocity = now.omega;
  wall.point = now.x - dt * now.v;
  wall.axis = rotate(fromRotationVector(-dt * now.omega) * now.turn, axis);
}

void add(const Target& to, dem::PrimitiveWall made) {
  made.material = contactRow(to.scene, to.wall.contactMaterial);
  dem::requireRepeats(made, to.run.grains.pairs.periodicity(), largestRadius(to.scene, to.run.grains.particles));
  if (to.isSteady()) {
    made.velocity = constantOf(to.wall.velocity);
    made.angularVelocity = to.wall.angularVelocity;
  } else {
    const dem::PrescribedMotion motion = motionOf(to, made.point);
    const coupling::CoupledRun* const run = &to.run;
    place(made, motion(0.0), made.axis, 0.0);
    made.motion = [run, motion, axis = made.axis](double t, dem::PrimitiveWall& wall) {
      place(wall, motion(t), axis, run->dt());
    };
  }
  dem::addWall(to.run.grains, std::move(made));
}
void add(const Target& to, const Plane& plane) { add(to, dem::makePlane(plane.point, plane.normal)); }
void add(const Target& to, const BoxWalls& box) {
  if (norm(to.wall.angularVelocity) > 0.0 || to.wall.turn)
    throw InputError("the walls of a box cannot turn", "",
                     "give planes, or a mesh, or leave angular_velocity and turn out");
  for (const bool upper : {false, true})
    for (int k = 0; k < 3; ++k) {
      const std::string side = std::string(1, "xyz"[k]) + (upper ? "+" : "-");
      if (std::find(box.open.begin(), box.open.end(), side) != box.open.end()) continue;
      Vec3 normal;
      normal[k] = upper ? -1.0 : 1.0;
      add(to, dem::makePlane(upper ? box.box.upper : box.box.lower, normal));
    }
}
void add(const Target& to, const Cylinder& cylinder) {
  add(to, dem::makeCylinder(cylinder.point, cylinder.axis, cylinder.radius, cylinder.inside));
}
void add(const Target& to, const SphereWall& sphere) {
  add(to, dem::makeSphere(sphere.centre, sphere.radius, sphere.inside));
}
/// Of the surface, whatever its triangulation.
Vec3 centroidOf(const geometry::TriangleMesh& mesh) {
  double area = 0.0;
  Vec3 sum;
  for (const geometry::Facet& facet : mesh.facets) {
    const auto at = [&](std::size_t k) { return mesh.x[static_cast<std::size_t>(facet[k])]; };
    const double twice = norm(cross(at(1) - at(0), at(2) - at(0)));
    area += twice;
    sum += twice / 3.0 * (at(0) + at(1) + at(2));
  }
  return 1.0 / area * sum;
}

void add(const Target& to, const SurfaceFile& from) {
  const auto patches = from.closed ? geometry::ClosedPatches::keep : geometry::ClosedPatches::turn;
  geometry::TriangleMesh mesh = repairedSurface(from.file, patches, to.notes);
  for (Vec3& x : mesh.x) x = from.scale * x + from.shift;
  const Vec3 about = from.point.value_or(centroidOf(mesh));
  dem::MeshWall made;
  made.wall = dem::makeWall(std::move(mesh.x), std::move(mesh.facets), from.closed);
  made.wall.rigid = true;
  made.wall.material = contactRow(to.scene, to.wall.contactMaterial);
  const Vec3 velocity = constantOf(to.wall.velocity);
  if (!to.isSteady()) {
    dem::prescribe(made, motionOf(to, about), about);
    dem::moveWall(made, 0.0, 0.0);
  } else if (norm(velocity) > 0.0 || norm(to.wall.angularVelocity) > 0.0) {
    dem::prescribe(made, dem::steadyMotion({about, {}, velocity, to.wall.angularVelocity}), about);
  }
  dem::addWall(to.run.grains, std::move(made));
}

}  // namespace

void addWalls(Built& built, const Scene& scene) {
  dem::Model& grains = built.run->grains;
  const auto primitives = [&] { return grains.terms.all<dem::PrimitiveWallTerm>().size(); };
  const auto meshes = [&] { return grains.terms.all<dem::MeshWallTerm>().size(); };
  for (const Wall& wall : scene.walls)
    atPlace(wall.where, [&] {
      WallParts parts{.firstPrimitive = primitives(), .firstMesh = meshes()};
      std::visit([&](const auto& shape) { add({*built.run, wall, scene, built.notes}, shape); }, wall.shape);
      parts.endPrimitive = primitives();
      parts.endMesh = meshes();
      built.walls.push_back(parts);
    });
}

}  // namespace dovetail::scene
