// Rigid walls of a scene.
#include "dovetail/dem/model/walls.hpp"

#include <algorithm>
#include <array>
#include <set>

#include "dovetail/geometry/triangle_mesh.hpp"
#include "dovetail/io/names.hpp"
#include "from_state.hpp"
#include "keys/advice.hpp"
#include "parts.hpp"
#include "time_functions.hpp"
#include "wall_motion.hpp"

namespace dovetail::scene {

namespace {

/// A wall that is being made.
struct Target {
  coupling::CoupledRun& run;
  const Wall& wall;
  const Scene& scene;
  std::vector<std::string>& notes;
  WallParts& parts;
  std::vector<dem::PrimitiveWall> ofState;  ///< its primitives there; empty: they are where the shape says
};

/// Where the next primitive is.
dem::PrimitiveWall placed(const Target& to, dem::PrimitiveWall made) {
  if (to.ofState.empty()) return made;
  const dem::PrimitiveWall& there = to.ofState[to.parts.arms.size()];
  made.point = there.point;
  made.axis = there.axis;
  made.radius = there.radius;
  return made;
}

void add(const Target& to, dem::PrimitiveWall made) {
  made.material = contactRow(to.scene, to.wall.contactMaterial);
  dem::requireRepeats(made, to.run.grains.pairs.periodicity(), largestRadius(to.scene, to.run.grains.particles));
  to.parts.arms.push_back(made.point - to.parts.point);
  to.parts.axes.push_back(made.axis);
  dem::addWall(to.run.grains, std::move(made));
}
/// One primitive, whose point is that of the wall.
void addAlone(const Target& to, dem::PrimitiveWall made) {
  made = placed(to, std::move(made));
  to.parts.point = made.point;
  add(to, std::move(made));
}
void add(const Target& to, const Plane& plane) { addAlone(to, dem::makePlane(plane.point, plane.normal)); }
void add(const Target& to, const BoxWalls& box) {
  const std::array<Vec3, 2> shape{box.box.lower, box.box.upper};
  std::array<Vec3, 2> corner = shape;  // where they are
  std::array<bool, 2> known{};
  for (const std::size_t upper : {std::size_t{0}, std::size_t{1}})
    for (int k = 0; k < 3; ++k) {
      const std::string side = std::string(1, "xyz"[k]) + (upper == 1 ? "+" : "-");
      if (std::find(box.open.begin(), box.open.end(), side) != box.open.end()) continue;
      Vec3 normal;
      normal[k] = upper == 1 ? -1.0 : 1.0;
      dem::PrimitiveWall plane = placed(to, dem::makePlane(shape[upper], normal));
      corner[upper] = plane.point;
      known[upper] = true;
      add(to, std::move(plane));
    }
  if (known[0] != known[1]) {
    const std::size_t one = known[0] ? 0 : 1;
    corner[1 - one] += corner[one] - shape[one];
  }
  to.parts.centre = 0.5 * (corner[0] + corner[1]);
}
void add(const Target& to, const Cylinder& cylinder) {
  addAlone(to, dem::makeCylinder(cylinder.point, cylinder.axis, cylinder.radius, cylinder.inside));
}
void add(const Target& to, const SphereWall& sphere) {
  addAlone(to, dem::makeSphere(sphere.centre, sphere.radius, sphere.inside));
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
  geometry::TriangleMesh mesh = surfaceOf(from, patches, to.notes);
  to.parts.point = from.point.value_or(centroidOf(mesh));
  dem::MeshWall made;
  made.wall = dem::makeWall(std::move(mesh.x), std::move(mesh.facets), from.closed);
  made.wall.rigid = true;
  made.wall.material = contactRow(to.scene, to.wall.contactMaterial);
  to.parts.offsets = dem::vertexOffsets(made.wall, to.parts.point);
  dem::addWall(to.run.grains, std::move(made));
}

bool isAtRest(const Wall& wall) {
  return !wall.displacement && !wall.turn && !wall.servo && isConstant(wall.velocity) &&
         norm(constantOf(wall.velocity)) + norm(wall.angularVelocity) == 0.0;
}
/// With a velocity that the primitives keep: they need no path.
bool isSteady(const Wall& wall, const WallParts& parts) {
  return !wall.displacement && !wall.turn && !wall.servo && isConstant(wall.velocity) &&
         parts.endMesh == parts.firstMesh && (norm(wall.angularVelocity) == 0.0 || parts.arms.size() == 1);
}

void move(const Target& to) {
  if (isAtRest(to.wall)) return;
  dem::Model& grains = to.run.grains;
  if (!isSteady(to.wall, to.parts)) return setMotion({grains, to.run}, to.parts, to.wall, to.scene);
  to.parts.motion = motionOf(to.wall, to.parts, to.scene, stepOf(to.run));
  for (std::size_t i = to.parts.firstPrimitive; i < to.parts.endPrimitive; ++i) {
    dem::primitiveWall(grains, i).velocity = constantOf(to.wall.velocity);
    dem::primitiveWall(grains, i).angularVelocity = to.wall.angularVelocity;
  }
}

void requireOwnName(const Scene& scene, const Wall& wall) {
  if (wall.name.empty()) return;
  io::requirePlainName(wall.name, "name");
  for (const Wall& other : scene.walls)
    if (&other != &wall && other.name == wall.name)
      throw InputError("two walls are named \"" + wall.name + "\"", "", "give each a name of its own");
}

}  // namespace

std::size_t wallNamed(const std::string& name, const Scene& scene) {
  constexpr std::size_t longest = 9;  // digits that surely fit
  const bool isNumber = !name.empty() && name.find_first_not_of("0123456789") == std::string::npos;
  if (isNumber && name.size() <= longest && std::stoul(name) < scene.walls.size()) return std::stoul(name);
  std::vector<std::string> names;
  for (std::size_t w = 0; w < scene.walls.size(); ++w) {
    if (!isNumber && scene.walls[w].name == name) return w;
    if (!scene.walls[w].name.empty()) names.push_back(scene.walls[w].name);
  }
  const std::string count = "the scene has " + std::to_string(scene.walls.size()) + ", counted from 0";
  if (isNumber) throw InputError("there is no wall " + name, "", count);
  throw InputError("there is no wall \"" + name + "\"", "",
                   names.empty() ? "give it a \"name\", or write its number: " + count : adviceFor(name, names));
}

void addWalls(Built& built, const Scene& scene) {
  dem::Model& grains = built.run->grains;
  const auto primitives = [&] { return grains.terms.all<dem::PrimitiveWallTerm>().size(); };
  const auto meshes = [&] { return grains.terms.all<dem::MeshWallTerm>().size(); };
  for (const Wall& wall : scene.walls)
    atPlace(wall.where, [&] {
      requireOwnName(scene, wall);
      WallParts parts{.firstPrimitive = primitives(), .firstMesh = meshes()};
      const Target to{*built.run,  wall,  scene,
                      built.notes, parts, wall.state ? wallOfState(wall, grains) : std::vector<dem::PrimitiveWall>{}};
      std::visit([&](const auto& shape) { add(to, shape); }, wall.shape);
      parts.endPrimitive = primitives();
      parts.endMesh = meshes();
      parts.base.x = parts.point;
      move(to);
      if (norm(wall.surfaceVelocity) > 0.0) setSurfaceVelocity(grains, parts, wall.surfaceVelocity);
      if (!wall.present) setPresence(grains, parts, false);
      built.walls.push_back(std::move(parts));
    });
}

}  // namespace dovetail::scene
