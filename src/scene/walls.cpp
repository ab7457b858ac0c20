// Rigid walls of a scene.
#include "dovetail/dem/model/walls.hpp"

#include <algorithm>

#include "dovetail/geometry/triangle_mesh.hpp"
#include "parts.hpp"

namespace dovetail::scene {

namespace {

void add(dem::Model& grains, dem::PrimitiveWall made, const Wall& wall) {
  made.velocity = wall.velocity;
  made.angularVelocity = wall.angularVelocity;
  dem::addWall(grains, std::move(made));
}
void add(dem::Model& grains, const Wall& wall, const Plane& plane) {
  add(grains, dem::makePlane(plane.point, plane.normal), wall);
}
void add(dem::Model& grains, const Wall& wall, const BoxWalls& box) {
  if (norm(wall.angularVelocity) > 0.0)
    throw InputError("the walls of a box cannot turn", "", "give planes, or a mesh, or leave angular_velocity out");
  for (const bool upper : {false, true})
    for (int k = 0; k < 3; ++k) {
      const std::string side = std::string(1, "xyz"[k]) + (upper ? "+" : "-");
      if (std::find(box.open.begin(), box.open.end(), side) != box.open.end()) continue;
      Vec3 normal;
      normal[k] = upper ? -1.0 : 1.0;
      add(grains, dem::makePlane(upper ? box.box.upper : box.box.lower, normal), wall);
    }
}
void add(dem::Model& grains, const Wall& wall, const Cylinder& cylinder) {
  add(grains, dem::makeCylinder(cylinder.point, cylinder.axis, cylinder.radius, cylinder.inside), wall);
}
void add(dem::Model& grains, const Wall& wall, const SphereWall& sphere) {
  add(grains, dem::makeSphere(sphere.centre, sphere.radius, sphere.inside), wall);
}
void add(dem::Model& grains, const Wall& wall, const SurfaceFile& from) {
  geometry::TriangleMesh mesh = readTriangles(from.file);
  geometry::repairSurface(mesh);
  Vec3 middle;
  for (Vec3& x : mesh.x) {
    x = from.scale * x + from.shift;
    middle += 1.0 / static_cast<double>(mesh.x.size()) * x;
  }
  dem::MeshWall made;
  made.wall = dem::makeWall(std::move(mesh.x), std::move(mesh.facets), from.closed);
  made.wall.rigid = true;
  if (norm(wall.velocity) > 0.0 || norm(wall.angularVelocity) > 0.0)
    dem::prescribe(made, dem::steadyMotion({middle, {}, wall.velocity, wall.angularVelocity}), middle);
  dem::addWall(grains, std::move(made));
}

}  // namespace

void addWalls(Built& built, const Scene& scene) {
  dem::Model& grains = built.run->grains;
  const auto primitives = [&] { return grains.terms.all<dem::PrimitiveWallTerm>().size(); };
  const auto meshes = [&] { return grains.terms.all<dem::MeshWallTerm>().size(); };
  for (const Wall& wall : scene.walls)
    atPlace(wall.where, [&] {
      WallParts parts{.firstPrimitive = primitives(), .firstMesh = meshes()};
      std::visit([&](const auto& shape) { add(grains, wall, shape); }, wall.shape);
      parts.endPrimitive = primitives();
      parts.endMesh = meshes();
      built.walls.push_back(parts);
    });
}

}  // namespace dovetail::scene
