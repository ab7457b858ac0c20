// What a scene is likely not to mean.
#include "warnings.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "dovetail/core/finite.hpp"
#include "dovetail/dem/model/sample.hpp"
#include "dovetail/fem/mesh/mesh_quality.hpp"
#include "dovetail/geometry/triangle_mesh.hpp"
#include "dovetail/surface/skin.hpp"
#include "impacts.hpp"
#include "output_cost.hpp"
#include "plausible.hpp"
#include "time_functions.hpp"

namespace dovetail::scene {

namespace {

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

// ---- surfaces and meshes

void lookAtSurfaceContact(const Built& built, const Scene& scene, std::size_t solid, const SurfaceContact& contact,
                          Lines& lines) {
  const std::optional<ContactLaw>& law = contact.contact ? contact.contact : scene.contact;
  const double advised = surface::advisedKernel(built.meshes[solid]).kernel.width;
  const std::string name = quoted(scene.solids[solid].name);
  if (law && std::holds_alternative<HertzContact>(law->normal) && contact.kernel.width.word == "none")
    lines.push_back("Hertz's law counts the compliance near a contact, and single nodes of " + name +
                    " give way once more: write \"kernel\": \"advised\" (" + rounded(advised) + " m).");
  const NumberOrWord& width = contact.kernel.width;
  if (width.word.empty() && width.number > 4.0 * advised)
    lines.push_back("The kernel on " + name + " is " + rounded(width.number / advised) +
                    " times as wide as advised for the body: take about " + rounded(advised) + " m.");
  if (width.word.empty() && width.number < 0.01 * advised)
    lines.push_back("The kernel on " + name + " is " + rounded(width.number) +
                    " m wide, far below an element, and spreads no force: take about " + rounded(advised) +
                    " m, or \"none\".");
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
  if (!scene.insertions.empty())
    lines.push_back(
        "A stage settles while grains enter, and may never come to rest: run for a time in its place, and settle in "
        "another scene that begins with its state.");
  if (any)
    lines.push_back(
        "A stage settles while walls, drives or supports move, and may never come to rest: run for a time in "
        "its place, or let them start later in a run.");
}

}  // namespace

std::string percent(double share) { return formatNumber(std::round(1e3 * share) / 10.0) + " %"; }

std::vector<std::string> warnings(const Built& built, const Scene& scene) {
  Lines lines;
  lookAtNumbers(scene, lines);
  lookAtRelations(built, scene, lines);
  lookForContradictions(built, scene, lines);
  lookAtCompany(built, scene, lines);
  lookForIdleParts(built, scene, lines);
  lookForFalling(built, scene, lines);
  lookAtOutput(built, scene, lines);
  lookAtContacts(built, lines);
  lookAtSoftness(built, scene, lines);
  lookAtWalls(built, lines);
  for (std::size_t s = 0; s < scene.solids.size(); ++s) {
    const Solid& solid = scene.solids[s];
    lookAtMesh(built.meshes[s], solid, lines);
    lookAtThickness(built, scene, s, lines);
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
    if (!overlaps) lookForGrainsWithin(built, s, lines), lookForStreamsWithin(built, scene, s, lines);
    if (solid.supports.empty() && solid.gravity && norm(scene.gravity) > 0.0)
      lines.push_back(quoted(solid.name) + " has no supports and falls: hold some of its nodes, or leave gravity out.");
  }
  lookForBodiesWithin(built, scene, lines);
  lookAtNames(scene, lines);
  lookAtStages(scene, lines);
  return onePerKind(lines);
}

}  // namespace dovetail::scene
