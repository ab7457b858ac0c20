// Bodies that lie in each other, and walls with faults.
#include <algorithm>
#include <array>
#include <utility>

#include "build/extent.hpp"
#include "build/overlap_audit.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/geometry/surface_checks.hpp"
#include "dovetail/surface/skin.hpp"
#include "warnings.hpp"

namespace dovetail::scene {

namespace {

/// The skin of a solid as it lies now.
geometry::TriangleMesh skinOf(const fem::SolidMesh& mesh, const fem::Nodes& nodes) {
  std::vector<Vec3> x = nodes.X;
  for (std::size_t n = 0; n < x.size(); ++n) x[n] += nodes.u[n];
  const surface::Skin skin = surface::makeSkin(x, fem::boundaryFaces(mesh));
  return {skin.wall.x, skin.wall.facets};
}

/// Bodies that touch do not overlap.
void shrink(geometry::TriangleMesh& mesh) {
  Vec3 middle;
  for (const Vec3& x : mesh.x) middle += 1.0 / static_cast<double>(mesh.x.size()) * x;
  for (Vec3& x : mesh.x) x += 1e-6 * (middle - x);
}

/// Plane strain has none, and neither have material points.
bool hasNoSkin(const fem::SolidMesh& mesh) { return mesh.groups.empty() || fem::dimensionOf(mesh) == 2; }

void lookForGrainsWithin(const dem::Particles& p, const geometry::TriangleMesh& skin, const std::string& whose,
                         const std::string& remedy, Lines& lines) {
  Extent body;
  body.add(skin.x);
  std::vector<std::size_t> near;
  for (std::size_t i = 0; i < p.size(); ++i)
    if (holds({body.lower, body.upper}, p.x[i])) near.push_back(i);
  if (static_cast<double>(near.size()) * static_cast<double>(skin.facets.size()) > 3e8) return;  // half a minute
  const auto within = [&](std::size_t i) { return geometry::windingNumber(skin.x, skin.facets, p.x[i]) > 0.5; };
  const auto count = std::count_if(near.begin(), near.end(), within);
  if (count > 0)
    lines.push_back(std::to_string(count) +
                    (count == 1 ? " grain has its centre in " : " grains have their centres in ") + whose +
                    " at the start: move them out" + remedy + ".");
}

void lookAtWall(const std::string& name, const dem::TriangulatedWall& wall, const dem::Particles& p, Lines& lines) {
  const geometry::SurfaceDefects defects = geometry::checkSurface(wall.x, wall.facets);
  const bool isBody = wall.oneSided && defects.closedAndOriented();
  const bool isCavity = isBody && geometry::signedVolume(wall.x, wall.facets) < 0.0;
  if (wall.oneSided && !defects.closedAndOriented())
    lines.push_back(name + " has \"closed\": true and is not closed (" + geometry::describe(defects) +
                    "): repair it, or write \"closed\": false.");
  if (isCavity)
    lines.push_back(name +
                    " is closed with its normals inwards: contact is on its inside, as in a drum, and grains that "
                    "touch it from outside are pulled in. If grains are outside, reverse the facets in its file.");
  if (!wall.oneSided && defects.closedAndOriented())
    lines.push_back(name +
                    " is closed, but is treated as a sheet with contact on both sides: write \"closed\": true if "
                    "grains are only outside.");
  if (!defects.selfIntersection.empty())
    lines.push_back(name + " intersects itself at " + std::to_string(defects.selfIntersection.size()) +
                    " pairs of facets, the first " + std::to_string(defects.selfIntersection.front()[0]) + " and " +
                    std::to_string(defects.selfIntersection.front()[1]) + ": repair it.");
  if (isBody && !isCavity) lookForGrainsWithin(p, {wall.x, wall.facets}, name, "", lines);
}

}  // namespace

void lookForGrainsWithin(const Built& built, std::size_t solid, Lines& lines) {
  if (hasNoSkin(built.meshes[solid])) return;
  const coupling::SolidSide& side = built.run->solid(solid);
  lookForGrainsWithin(built.run->grains.particles, skinOf(built.meshes[solid], side.nodes()), quoted(side.name),
                      ", or give the two an overlap", lines);
}

void lookForStreamsWithin(const Built& built, const Scene& scene, std::size_t solid, Lines& lines) {
  constexpr int each = 5;
  if (hasNoSkin(built.meshes[solid])) return;
  const coupling::SolidSide& side = built.run->solid(solid);
  const geometry::TriangleMesh skin = skinOf(built.meshes[solid], side.nodes());
  for (std::size_t k = 0; k < scene.insertions.size(); ++k) {
    const geometry::Box& region = scene.insertions[k].region;
    int within = 0;
    for (int n = 0; n < each * each * each; ++n) {
      const std::array<int, 3> cell{n % each, n / each % each, n / (each * each)};
      Vec3 x;
      for (int c = 0; c < 3; ++c)
        x[c] = region.lower[c] + (cell[static_cast<std::size_t>(c)] + 0.5) / each * (region.upper[c] - region.lower[c]);
      within += geometry::windingNumber(skin.x, skin.facets, x) > 0.5 ? 1 : 0;
    }
    if (const double fraction = within / static_cast<double>(each * each * each); fraction > 0.25)
      lines.push_back(percent(fraction) + " of the region of insertions." + std::to_string(k) + " lies in " +
                      quoted(side.name) + ": move it out.");
  }
}

/// Solids see grains only: neither each other nor walls.
void lookForBodiesWithin(const Built& built, const Scene& scene, Lines& lines) {
  std::vector<geometry::TriangleMesh> bodies;
  std::vector<std::string> names;
  for (std::size_t s = 0; s < built.meshes.size(); ++s) {
    if (hasNoSkin(built.meshes[s])) continue;
    names.push_back(quoted(scene.solids[s].name));
    bodies.push_back(skinOf(built.meshes[s], built.run->solid(s).nodes()));
    shrink(bodies.back());
  }
  const std::size_t solids = bodies.size();
  const auto meshes = std::as_const(built.run->grains).terms.all<dem::MeshWallTerm>();
  for (std::size_t w = 0; w < built.walls.size(); ++w)
    for (std::size_t m = built.walls[w].firstMesh; m < built.walls[w].endMesh; ++m) {
      bodies.push_back({meshes[m]->mesh.wall.x, meshes[m]->mesh.wall.facets});
      names.push_back("walls." + std::to_string(w));
    }
  for (const auto& [i, j] : overlapping(bodies))
    if (static_cast<std::size_t>(i) < solids)
      lines.push_back(names[static_cast<std::size_t>(i)] + " and " + names[static_cast<std::size_t>(j)] +
                      " overlap at the start, and solids have contact with grains only: move one of them.");
}

void lookAtWalls(const Built& built, Lines& lines) {
  const auto walls = std::as_const(built.run->grains).terms.all<dem::MeshWallTerm>();
  for (std::size_t w = 0; w < built.walls.size(); ++w)
    for (std::size_t m = built.walls[w].firstMesh; m < built.walls[w].endMesh; ++m)
      lookAtWall("walls." + std::to_string(w), walls[m]->mesh.wall, built.run->grains.particles, lines);
}

}  // namespace dovetail::scene
