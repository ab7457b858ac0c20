// What a scene is likely not to mean.
#include "warnings.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "dovetail/core/finite.hpp"
#include "dovetail/dem/model/sample.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/fem/mesh/mesh_quality.hpp"
#include "dovetail/geometry/surface_checks.hpp"
#include "dovetail/geometry/triangle_mesh.hpp"
#include "dovetail/surface/skin.hpp"
#include "impacts.hpp"
#include "overlap_audit.hpp"
#include "time_functions.hpp"

namespace dovetail::scene {

namespace {

std::string percent(double share) { return formatNumber(std::round(1e3 * share) / 10.0) + " %"; }

// ---- contacts and bodies at the start

void lookAtContacts(const Built& built, Lines& lines) {
  constexpr double deep = 0.05;
  const dem::Particles& p = built.run->grains.particles;
  const dem::ContactSample contacts = dem::sampleContacts(built.run->grains);
  std::size_t count = 0, worst = 0;
  double most = deep;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const auto i = static_cast<std::size_t>(contacts.first[c]);
    const bool pair = contacts.second[c] >= 0;
    const double other = pair ? p.radius[static_cast<std::size_t>(contacts.second[c])] : p.radius[i];
    const double reach = pair ? p.radius[i] + other : p.radius[i];
    const double overlap = (reach - norm(contacts.from[c] - contacts.to[c])) / std::min(p.radius[i], other);
    count += overlap > deep ? 1 : 0;
    if (overlap > most) most = overlap, worst = c;
  }
  if (count == 0) return;
  const auto nameOf = [&](int i) { return std::to_string(p.id[static_cast<std::size_t>(i)]); };
  lines.push_back(std::to_string(count) + " contacts are deeper than " + percent(deep) +
                  " of a radius at the start, the deepest " + percent(most) + " (particle " +
                  nameOf(contacts.first[worst]) +
                  (contacts.second[worst] < 0 ? " with a wall" : " with particle " + nameOf(contacts.second[worst])) +
                  "): move them apart, or take a stiffer law.");
}

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

bool isPlane(const fem::SolidMesh& mesh) { return fem::dimensionOf(mesh) == 2; }

void lookForGrainsWithin(const Built& built, std::size_t solid, Lines& lines) {
  if (isPlane(built.meshes[solid])) return;
  const coupling::SolidSide& side = built.run->solid(solid);
  const geometry::TriangleMesh skin = skinOf(built.meshes[solid], side.nodes());
  Vec3 lower = skin.x.front(), upper = lower;
  for (const Vec3& x : skin.x)
    for (int k = 0; k < 3; ++k) lower[k] = std::min(lower[k], x[k]), upper[k] = std::max(upper[k], x[k]);
  const dem::Particles& p = built.run->grains.particles;
  std::vector<std::size_t> near;
  for (std::size_t i = 0; i < p.size(); ++i) {
    bool in = true;
    for (int k = 0; k < 3; ++k) in = in && p.x[i][k] > lower[k] && p.x[i][k] < upper[k];
    if (in) near.push_back(i);
  }
  if (static_cast<double>(near.size()) * static_cast<double>(skin.facets.size()) > 3e8) return;  // half a minute
  const auto within = [&](std::size_t i) { return geometry::windingNumber(skin.x, skin.facets, p.x[i]) > 0.5; };
  const auto count = std::count_if(near.begin(), near.end(), within);
  if (count > 0)
    lines.push_back(std::to_string(count) + " grains have their centres in " + quoted(side.name) +
                    " at the start: move them out, or give the two an overlap.");
}

/// Solids see grains only: neither each other nor walls.
void lookForBodiesWithin(const Built& built, const Scene& scene, Lines& lines) {
  std::vector<geometry::TriangleMesh> bodies;
  std::vector<std::string> names;
  for (std::size_t s = 0; s < built.meshes.size(); ++s) {
    if (isPlane(built.meshes[s])) continue;
    names.push_back(quoted(scene.solids[s].name));
    bodies.push_back(skinOf(built.meshes[s], built.run->solid(s).nodes()));
    shrink(bodies.back());
  }
  const std::size_t solids = bodies.size();
  const auto meshes = std::as_const(built.run->grains).terms.all<dem::MeshWallTerm>();
  for (std::size_t w = 0; w < built.walls.size(); ++w)
    for (std::size_t m = built.walls[w].firstMesh; m < built.walls[w].endMesh; ++m) {
      bodies.push_back({meshes[m]->mesh.wall.x, meshes[m]->mesh.wall.facets});
      names.push_back("wall " + std::to_string(w));
    }
  for (const auto& [i, j] : overlapping(bodies))
    if (static_cast<std::size_t>(i) < solids)
      lines.push_back(names[static_cast<std::size_t>(i)] + " and " + names[static_cast<std::size_t>(j)] +
                      " overlap at the start, and nothing keeps them apart: move one of them.");
}

// ---- surfaces and meshes

void lookAtSurfaceContact(const Built& built, const Scene& scene, std::size_t solid, const SurfaceContact& contact,
                          Lines& lines) {
  const std::optional<ContactLaw>& law = contact.contact ? contact.contact : scene.contact;
  const double advised = surface::advisedKernel(built.meshes[solid]).kernel.width;
  const std::string name = quoted(scene.solids[solid].name);
  if (law && std::holds_alternative<HertzContact>(law->normal) && contact.kernel.word == "none")
    lines.push_back("Hertz's law counts the compliance near a contact, and single nodes of " + name +
                    " give way once more: write \"kernel\": \"advised\" (" + rounded(advised) + " m).");
  if (contact.kernel.word.empty() && contact.kernel.number > 4.0 * advised)
    lines.push_back("The kernel on " + name + " is " + rounded(contact.kernel.number / advised) +
                    " times as wide as advised for the body: take about " + rounded(advised) + " m.");
}

void lookAtMesh(const fem::SolidMesh& mesh, const Solid& solid, Lines& lines) {
  const fem::MeshQuality quality = fem::measureQuality(mesh, 1);
  const std::string name = quoted(solid.name);
  if (!quality.worst.empty()) {
    const int worst = quality.worst.front();
    const double jacobian = quality.element[static_cast<std::size_t>(worst)].scaledJacobian;
    if (jacobian < 0.1)
      lines.push_back("Element " + std::to_string(worst) + " of " + name + " is nearly flat (scaled Jacobian " +
                      rounded(jacobian) + "): mesh anew there.");
  }
  const fem::MeshTopology topology = fem::analyseTopology(mesh);
  if (topology.firstElement.size() > 1 && solid.ties.empty())
    lines.push_back(name + " is " + std::to_string(topology.firstElement.size()) +
                    " pieces that share no faces: join their nodes, or give it ties.");
  if (!topology.mismatchedFaces.empty() || !topology.crowdedFaces.empty() || !topology.duplicates.empty())
    lines.push_back("Neighbours in " + name + " do not fit each other: mesh anew, without elements twice.");
}

void lookAtWalls(const Built& built, Lines& lines) {
  const auto walls = std::as_const(built.run->grains).terms.all<dem::MeshWallTerm>();
  for (std::size_t k = 0; k < walls.size(); ++k) {
    const dem::TriangulatedWall& wall = walls[k]->mesh.wall;
    const geometry::SurfaceDefects defects = geometry::checkSurface(wall.x, wall.facets);
    const std::string name = "Mesh wall " + std::to_string(k);
    if (wall.oneSided && !defects.closedAndOriented())
      lines.push_back(name + " is told to be closed and is not (" + geometry::describe(defects) +
                      "): mend it, or write \"closed\": false.");
    if (wall.oneSided && defects.closedAndOriented() && geometry::signedVolume(wall.x, wall.facets) < 0.0)
      lines.push_back(name +
                      " is closed with its normals inwards: it holds grains in, like a drum, and pulls in those that "
                      "touch it from outside. If grains are outside, turn the facets in its file.");
    if (!wall.oneSided && defects.closedAndOriented())
      lines.push_back(name +
                      " is closed, but counts as a sheet that pushes to both sides: write \"closed\": true if "
                      "grains are only outside.");
    if (!defects.selfIntersection.empty())
      lines.push_back(name + " cuts itself at " + std::to_string(defects.selfIntersection.size()) +
                      " pairs of facets, the first " + std::to_string(defects.selfIntersection.front()[0]) + " and " +
                      std::to_string(defects.selfIntersection.front()[1]) + ": mend it.");
  }
}

// ---- names

void lookForUnused(const std::set<std::string>& names, const std::set<std::string>& used, const std::string& what,
                   Lines& lines) {
  for (const std::string& name : names)
    if (!name.empty() && !used.contains(name)) lines.push_back(what + " " + quoted(name) + " is used by nobody.");
}

void lookAtNames(const Scene& scene, Lines& lines) {
  std::set<std::string> groups, usedGroups, materials, usedMaterials;
  for (const Particles& one : scene.particles) groups.insert(one.name), usedMaterials.insert(one.contactMaterial);
  for (const BondGroup& one : scene.bonds) usedGroups.insert({one.group, one.with});
  for (const Drive& one : scene.drives) usedGroups.insert(one.group);
  lookForUnused(groups, usedGroups, "The group of particles", lines);
  for (const PairLaw& one : scene.contacts) materials.insert({one.first, one.second});
  for (const Wall& one : scene.walls) usedMaterials.insert(one.contactMaterial);
  for (const Clump& one : scene.clumps) usedMaterials.insert(one.contactMaterial);
  for (const Insertion& one : scene.insertions) usedMaterials.insert(one.contactMaterial);
  for (const Coupling& one : scene.couplings)
    if (const auto* const contact = std::get_if<SurfaceContact>(&one.kind))
      usedMaterials.insert(contact->contactMaterial);
  lookForUnused(materials, usedMaterials, "The contact material", lines);
}

void lookAtSets(const Scene& scene, const Solid& solid, Lines& lines) {
  std::set<std::string> sets, used;
  for (const NamedSet& one : solid.sets) sets.insert(one.name);
  for (const Support& one : solid.supports) used.insert(one.on);
  for (const Load& one : solid.loads) used.insert(one.on);
  for (const MeshTie& one : solid.ties) used.insert({one.nodes, one.faces});
  for (const Coupling& one : scene.couplings)
    if (const auto* const contact = std::get_if<SurfaceContact>(&one.kind); contact && one.solid == solid.name)
      used.insert(contact->on);
  lookForUnused(sets, used, "Of " + quoted(solid.name) + " the set", lines);
}

/// What moves has no rest; steady velocities are refused.
void lookAtStages(const Scene& scene, Lines& lines) {
  const auto settles = [](const Stage& stage) { return std::holds_alternative<Settle>(stage.kind); };
  if (std::none_of(scene.stages.begin(), scene.stages.end(), settles)) return;
  const auto moves = [](const auto& one) {
    if constexpr (requires { one.turn; })
      if (one.turn && !isConstant(one.turn->angle)) return true;
    if constexpr (requires { one.spin; })
      if (!isConstant(one.spin)) return true;
    return !isConstant(one.displacement.value_or(one.velocity));
  };
  bool any = std::any_of(scene.walls.begin(), scene.walls.end(), moves) ||
             std::any_of(scene.drives.begin(), scene.drives.end(), moves);
  for (const Solid& solid : scene.solids) any = any || std::any_of(solid.supports.begin(), solid.supports.end(), moves);
  if (any)
    lines.push_back(
        "A stage settles while walls, drives or supports move, and may never come to rest: run for a time in "
        "its place, or let them start later in a run.");
}

}  // namespace

std::vector<std::string> warnings(const Built& built, const Scene& scene) {
  Lines lines;
  lookAtContacts(built, lines);
  lookAtSoftness(built, scene, lines);
  lookAtWalls(built, lines);
  for (std::size_t s = 0; s < scene.solids.size(); ++s) {
    const Solid& solid = scene.solids[s];
    lookAtMesh(built.meshes[s], solid, lines);
    lookAtThickness(built, solid, s, lines);
    lookAtSets(scene, solid, lines);
    bool overlaps = false;
    for (const Coupling& coupling : scene.couplings) {
      if (coupling.solid != solid.name) continue;
      const auto* const overlap = std::get_if<Overlap>(&coupling.kind);
      overlaps = overlaps || overlap;
      if (overlap)
        lookAtOverlap(built, scene, s, *overlap, lines);
      else
        lookAtSurfaceContact(built, scene, s, std::get<SurfaceContact>(coupling.kind), lines);
    }
    if (!overlaps) lookForGrainsWithin(built, s, lines);
    if (solid.supports.empty() && solid.gravity && norm(scene.gravity) > 0.0)
      lines.push_back(quoted(solid.name) + " has no supports and falls: hold some of its nodes, or leave gravity out.");
  }
  lookForBodiesWithin(built, scene, lines);
  lookAtNames(scene, lines);
  lookAtStages(scene, lines);
  return lines;
}

}  // namespace dovetail::scene
