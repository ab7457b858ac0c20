// Solids and walls that move into each other.
#include <algorithm>

#include "build/extent.hpp"
#include "build/parts.hpp"
#include "build/time_functions.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "warnings.hpp"

namespace dovetail::scene {

namespace {

/// A solid as a whole, and with a hole, in which another may move, its elements.
struct Body {
  Extent whole;
  std::vector<Extent> parts;
};

Body bodyOf(const Solid& solid, const fem::SolidMesh& mesh) {
  Body body;
  body.whole.add(mesh.X);
  const auto* const box = std::get_if<BoxMesh>(&solid.mesh);
  if (!box || !box->hole) {
    body.parts = {body.whole};
    return body;
  }
  for (const fem::ElementGroup& group : mesh.groups)
    for (std::size_t e = 0, n = static_cast<std::size_t>(fem::nodesOf(group.shape)); e < group.size(); ++e) {
      Extent& part = body.parts.emplace_back();
      for (std::size_t a = 0; a < n; ++a) part.add(mesh.X[static_cast<std::size_t>(group.node[n * e + a])]);
    }
  return body;
}

/// Looks only at parts that are near the other body.
bool comesTo(const Body& moving, const Vec3& velocity, const Body& still, double time) {
  if (!comesTo(moving.whole, velocity, still.whole, time)) return false;
  std::vector<Extent> near;
  for (const Extent& part : still.parts)
    if (comesTo(moving.whole, velocity, part, time)) near.push_back(part);
  return std::ranges::any_of(moving.parts, [&](const Extent& part) {
    return comesTo(part, velocity, still.whole, time) &&
           std::ranges::any_of(near, [&](const Extent& other) { return comesTo(part, velocity, other, time); });
  });
}

/// Extents say where they meet, and overlaps at the start are told elsewhere.
void lookAtMeetings(const Built& built, const Scene& scene, Lines& lines) {
  std::vector<Body> bodies;
  for (std::size_t s = 0; s < scene.solids.size(); ++s) bodies.push_back(bodyOf(scene.solids[s], built.meshes[s]));
  for (std::size_t j = 0; j < bodies.size(); ++j)
    for (std::size_t i = 0; i < j; ++i) {
      const Vec3 velocity = scene.solids[j].velocity - scene.solids[i].velocity;
      if (norm(velocity) == 0.0 || comesTo(bodies[j], {}, bodies[i], 0.0) ||
          !comesTo(bodies[j], velocity, bodies[i], durationOf(scene)))
        continue;
      lines.push_back(quoted(scene.solids[i].name) + " and " + quoted(scene.solids[j].name) +
                      " move into each other and will overlap: solids have contact with grains only. Change their "
                      "velocities, or make one of them of bonded grains.");
    }
}

/// The first wall of planes, cylinders and spheres that a body comes through; -1: none.
int wallThrough(const Built& built, const std::vector<Vec3>& body, const Vec3& way) {
  for (std::size_t k = 0; k < built.walls.size(); ++k)
    for (std::size_t w = built.walls[k].firstPrimitive; w < built.walls[k].endPrimitive; ++w) {
      const dem::PrimitiveWall& wall = dem::primitiveWall(std::as_const(built.run->grains), w);
      const auto before = [&](const Vec3& at) { return dem::distanceTo(wall, at).distance >= 0.0; };
      if (std::ranges::all_of(body, before) &&
          std::ranges::any_of(body, [&](const Vec3& at) { return !before(at + way); }))
        return static_cast<int>(k);
    }
  return -1;
}

/// What goes through walls, which touch grains only.
void lookAtFloors(const Built& built, const Scene& scene, Lines& lines) {
  const double time = durationOf(scene);
  for (std::size_t s = 0; s < scene.solids.size(); ++s) {
    const Solid& solid = scene.solids[s];
    if (!solid.supports.empty() || solid.state || isOfPoints(solid)) continue;
    const Vec3 way = time * solid.velocity + (solid.gravity ? 0.5 * time * time : 0.0) * scene.gravity;
    if (const int wall = wallThrough(built, built.meshes[s].X, way); wall >= 0)
      lines.push_back(quoted(solid.name) + " moves into " + item("walls", static_cast<std::size_t>(wall)) +
                      " and will pass through it: walls have contact with grains only. Hold it by supports, or make it "
                      "of bonded grains.");
  }
  const auto meshes = std::as_const(built.run->grains).terms.all<dem::MeshWallTerm>();
  for (std::size_t w = 0; w < built.walls.size(); ++w) {
    const Vec3 way = pathOf(scene.walls[w].velocity, scene.walls[w].displacement, scene).displacement(time);
    if (norm(way) == 0.0 || scene.walls[w].turn) continue;
    for (std::size_t m = built.walls[w].firstMesh; m < built.walls[w].endMesh; ++m)
      if (const int wall = wallThrough(built, meshes[m]->mesh.wall.x, way); wall >= 0)
        lines.push_back(item("walls", w) + " moves into " + item("walls", static_cast<std::size_t>(wall)) +
                        ", and crushes what lies between them: let it stop before.");
  }
}

}  // namespace

void lookForMeetings(const Built& built, const Scene& scene, Lines& lines) {
  lookAtMeetings(built, scene, lines);
  lookAtFloors(built, scene, lines);
}

}  // namespace dovetail::scene
