// What a scene is likely not to mean.
#include "warnings.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "build/time_functions.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/model/sample.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/fem/mesh/mesh_quality.hpp"
#include "dovetail/geometry/triangle_mesh.hpp"
#include "dovetail/surface/skin.hpp"
#include "impacts.hpp"
#include "keys/values.hpp"
#include "plausible.hpp"
#include "run/output_cost.hpp"

namespace dovetail::scene {

namespace {

// ---- contacts and bodies at the start

void lookAtContacts(const Built& built, Lines& lines) {
  constexpr double deep = 0.05;
  const dem::Particles& p = built.run->grains.particles;
  const dem::ContactSample contacts = dem::sampleContacts(built.run->grains);
  const dem::Model& grains = built.run->grains;
  if (grains.laws && std::isinf(grains.laws->reach()) && p.size() > 1 && 2 * contacts.size() < p.size())
    lines.push_back("Only " + std::to_string(contacts.size()) + " pairs of " + std::to_string(p.size()) +
                    " grains touch at the start and are bonded, and no other contacts form: put the grains on a "
                    "lattice, or leave \"bonded\" out.");
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
  if (most > 1.0 && contacts.second[worst] >= 0 && norm(contacts.from[worst] - contacts.to[worst]) == 0.0)
    lines.push_back("Particles " + std::to_string(p.id[static_cast<std::size_t>(contacts.first[worst])]) + " and " +
                    std::to_string(p.id[static_cast<std::size_t>(contacts.second[worst])]) +
                    " have the same centre, and others may as well: leave one of each two out, or move it.");
  const auto nameOf = [&](int i) { return std::to_string(p.id[static_cast<std::size_t>(i)]); };
  lines.push_back(std::to_string(count) + (count == 1 ? " contact is" : " contacts are") + " deeper than " +
                  percent(deep) + " of a radius at the start, the deepest " + percent(most) + " (particle " +
                  nameOf(contacts.first[worst]) +
                  (contacts.second[worst] < 0 ? " with a wall" : " with particle " + nameOf(contacts.second[worst])) +
                  "): move them apart" + (most < 1.0 ? ", or take a stiffer law." : "."));
}

// ---- surfaces and meshes

void lookAtSurfaceContact(const Built& built, const Scene& scene, std::size_t solid, const SurfaceContact& contact,
                          Lines& lines) {
  if (isOfPoints(scene.solids[solid]) || fem::dimensionOf(built.meshes[solid]) == 2) return;  // without kernels
  const std::optional<ContactLaw>& law = contact.contact ? contact.contact : scene.contact;
  const double advised = surface::advisedKernel(built.meshes[solid]).kernel.width;
  const std::string name = quoted(scene.solids[solid].name);
  if (law && std::holds_alternative<HertzContact>(law->normal) && contact.kernel.width.word == "none")
    lines.push_back("Hertz's law includes the local compliance of a contact, and forces on single nodes of " + name +
                    " add it once more: write \"kernel\": \"advised\" (" + rounded(advised) + " m).");
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
                      rounded(jacobian) + "): refine or repair the mesh there.");
  }
  const fem::MeshTopology topology = fem::analyseTopology(mesh);
  if (topology.firstElement.size() > 1 && solid.ties.empty())
    lines.push_back(name + " is " + std::to_string(topology.firstElement.size()) +
                    " pieces that share no faces: join their nodes, or give it ties.");
  if (!topology.mismatchedFaces.empty() || !topology.crowdedFaces.empty() || !topology.duplicates.empty())
    lines.push_back("Neighbouring elements of " + name + " do not match: mesh it anew, without duplicate elements.");
}

// ---- names

void lookForUnused(const std::set<std::string>& names, const std::set<std::string>& used, const std::string& what,
                   Lines& lines) {
  for (const std::string& name : names)
    if (!name.empty() && !used.contains(name)) lines.push_back(what + " " + quoted(name) + " is not used.");
}

void lookAtNames(const Scene& scene, Lines& lines) {
  std::set<std::string> groups, usedGroups, materials, usedMaterials;
  for (const Particles& one : scene.particles) groups.insert(one.name), usedMaterials.insert(one.contactMaterial);
  for (const Clump& one : scene.clumps) groups.insert(one.name);
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
    else if (const auto* const points = std::get_if<PointSpheres>(&one.kind))
      usedMaterials.insert(points->contactMaterial);
  const bool states = std::ranges::any_of(
      scene.particles, [](const Particles& one) { return std::holds_alternative<GrainsOfState>(one.from); });
  if (!states) lookForUnused(materials, usedMaterials, "The contact material", lines);  // grains of a state have theirs
  for (const std::string& name : scene.unusedParameters)
    lines.push_back("The parameter " + quoted(name) + " is not used: leave it out, or use it where it is meant.");
}

void lookAtSets(const Scene& scene, const Solid& solid, Lines& lines) {
  std::set<std::string> sets, used;
  for (const NamedSet& one : solid.sets) sets.insert(one.name);
  for (const Support& one : solid.supports) used.insert(one.on);
  for (const Load& one : solid.loads) used.insert(one.on);
  for (const MeshTie& one : solid.ties) used.insert({one.nodes, one.faces});
  for (const MaterialRegion& one : solid.regions) used.insert(one.elements);
  for (const SolidPlane& one : solid.planes) used.insert(one.on);
  for (const NamedSet& one : solid.sets)
    if (const auto* const common = std::get_if<CommonPart>(&one.place)) used.insert({common->of, common->with});
  for (const Probe& probe : scene.output.probes)
    if (const auto* const support = std::get_if<SupportProbe>(&probe.of); support && support->solid == solid.name)
      used.insert(support->on);
  for (const Coupling& one : scene.couplings)
    if (const auto* const contact = std::get_if<SurfaceContact>(&one.kind); contact && one.solid == solid.name)
      used.insert(contact->on);
  lookForUnused(sets, used, "Of " + quoted(solid.name) + " the set", lines);
}

/// Whether no node of the solid is held along an axis.
bool isFreeAlong(const fem::DofMap& dofs, std::size_t nodes, std::size_t axis) {
  for (std::size_t n = 0; n < nodes; ++n)
    if (const fem::Role role = dofs.role(3 * n + axis); role != fem::Role::free && role != fem::Role::tied)
      return false;
  return true;
}

/// Loads at the end of the run: pulses on free bodies are waves.
Vec3 netLoad(const Built& built, const Scene& scene, std::size_t number) {
  if (scene.solids[number].loads.empty()) return {};
  const coupling::SolidSide& side = built.run->solid(number);
  std::vector<Vec3> forces(side.nodes().X.size());
  for (const auto& term : side.model->terms) term->addForces(side.nodes(), {durationOf(scene), 0.0, side.mass}, forces);
  Vec3 net;
  double all = 0.0;
  for (const Vec3& f : forces) net += f, all += norm(f);  // what elements add is in balance
  for (int k = 0; k < 3; ++k)
    if (std::abs(net[k]) < 1e-6 * all) net[k] = 0.0;
  return net;
}

/// What pulls at a solid where no supports hold it.
void lookForFreeSolids(const Built& built, const Scene& scene, std::size_t number, Lines& lines) {
  const Solid& solid = scene.solids[number];
  bool touches = false;
  for (const Coupling& one : scene.couplings) {
    if (one.solid != solid.name) continue;
    if (std::holds_alternative<Overlap>(one.kind)) return;
    touches = true;
  }
  const double g = norm(scene.gravity);
  if (!solid.planes.empty()) return;
  if (isOfPoints(solid)) {
    const auto& borders = std::get<PointMesh>(solid.mesh).grid.borders;
    if (borders.empty() && g > 0.0 && solid.gravity && !touches)
      lines.push_back(quoted(solid.name) +
                      " has neither borders nor a coupling and falls: give its grid a border below, or leave gravity "
                      "out.");
    return;
  }
  if (solid.supports.empty() && g > 0.0 && solid.gravity)
    return lines.push_back(quoted(solid.name) +
                           " has no supports and falls: hold some of its nodes, or leave gravity out.");
  if (solid.supports.empty() && g > 0.0 && touches && norm(solid.velocity) == 0.0)
    return lines.push_back(quoted(solid.name) +
                           " has no supports and no gravity, so that grains that lie on it push it away: hold some of "
                           "its nodes.");
  if (!built.run->solid(number).mass || fem::dimensionOf(built.meshes[number]) == 2) return;  // not started, or a plane
  if (touches) return;                                                                        // grains may hold it
  const std::size_t nodes = built.meshes[number].X.size();
  for (int k = 0; k < 3; ++k) {
    if (!isFreeAlong(built.run->solid(number).mass->dofs(), nodes, static_cast<std::size_t>(k))) continue;
    const bool falls = solid.gravity && scene.gravity[k] != 0.0;
    const Vec3 pull = netLoad(built, scene, number);
    if (falls || pull[k] != 0.0)
      lines.push_back("Nothing holds " + quoted(solid.name) + " along " + "xyz"[k] + ", where " +
                      (falls ? "gravity pulls" : "its loads add up to " + rounded(pull[k]) + " N at the end") +
                      ", so that it accelerates without end: hold that component of some of its nodes, or let loads "
                      "balance or end.");
  }
}

const TimeValue& loadOf(const KeptForce& kept) { return kept.force; }
const TimeValue& loadOf(const KeptPressure& kept) { return kept.pressure; }
const TimeValue& loadOf(const KeptTorque& kept) { return kept.torque; }

/// Walls that fly until they hit.
void lookAtServos(const Built& built, const Scene& scene, Lines& lines) {
  constexpr double fast = 1.0;  // m/s
  const dem::Model& grains = built.run->grains;
  for (std::size_t w = 0; w < scene.walls.size(); ++w) {
    if (!scene.walls[w].servo || built.walls[w].arms.empty()) continue;
    const dem::PrimitiveWall& wall = dem::primitiveWall(grains, built.walls[w].firstPrimitive);
    if (!wall.servo || wall.servo->turns) continue;
    double gap = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < grains.particles.size(); ++i)
      gap = std::min(gap, dem::distanceTo(wall, grains.particles.x[i]).distance - grains.particles.radius[i]);
    const double push = (1.0 - wall.servo->localDamping) * std::abs(wall.servo->load) / wall.servo->mass;
    const double speed = std::min(wall.servo->fastest, std::sqrt(2.0 * push * std::max(0.0, gap)));
    if (speed > fast)
      lines.push_back("walls." + std::to_string(w) +
                      " touches no grain at the start, and its load drives it into the " + "first one with " +
                      (std::isfinite(speed) ? rounded(speed) + " m/s" : "any speed") +
                      ": give its servo a speed_limit.");
  }
}

/// What moves has no rest; steady velocities are refused.
void lookAtStages(const Scene& scene, Lines& lines) {
  const auto relaxes = [](const Stage& stage) { return std::holds_alternative<Relax>(stage.kind); };
  if (std::none_of(scene.stages.begin(), scene.stages.end(), relaxes)) return;
  const auto moves = [](const auto& one) {
    if constexpr (requires { one.turn; })
      if (one.turn && !isConstant(one.turn->angle)) return true;
    if constexpr (requires { one.servo; })
      if (one.servo && !std::visit([](const auto& kept) { return isConstant(loadOf(kept)); }, one.servo->keeps))
        return true;
    if constexpr (requires { one.spin; })
      if (!isConstant(one.spin)) return true;
    return !isConstant(one.displacement.value_or(one.velocity));
  };
  bool any = std::any_of(scene.walls.begin(), scene.walls.end(), moves) ||
             std::any_of(scene.drives.begin(), scene.drives.end(), moves);
  for (const Solid& solid : scene.solids)
    any = any || std::any_of(solid.supports.begin(), solid.supports.end(), moves) ||
          std::any_of(solid.planes.begin(), solid.planes.end(), moves);
  if (!scene.insertions.empty())
    lines.push_back(
        "A stage relaxes while grains are inserted, and may never come to rest: run for a time instead, and relax in "
        "another scene that starts from its state.");
  if (any)
    lines.push_back(
        "A stage relaxes while walls, drives or supports move, and may never come to rest: run for a time instead, or "
        "let them start later in a run.");
}

/// Loads that wait for a time which does not pass.
void lookAtLoadSteps(const Scene& scene, Lines& lines) {
  const auto stands = [](const Stage& stage) {
    const auto* const statics = std::get_if<Statics>(&stage.kind);
    return statics && !statics->time;
  };
  const auto stage = std::ranges::find_if(scene.stages, stands);
  if (stage == scene.stages.end()) return;
  const auto grows = [](const TimeValue& value) { return wordsIn(value.expression).contains("t"); };
  const auto changes = [&](const Load& load) {
    if (const auto* const pressure = std::get_if<PressureLoad>(&load.kind)) return grows(pressure->pressure);
    const auto* const force = std::get_if<NodalLoad>(&load.kind);
    return std::ranges::any_of(force ? force->force : std::get<TractionLoad>(load.kind).traction, grows);
  };
  for (std::size_t s = 0; s < scene.solids.size(); ++s)
    for (std::size_t k = 0; k < scene.solids[s].loads.size(); ++k)
      if (changes(scene.solids[s].loads[k]))
        lines.push_back("solids." + std::to_string(s) + ".loads." + std::to_string(k) +
                        " changes with time, and in stages." + std::to_string(stage - scene.stages.begin()) +
                        " no time passes, so that it acts as at that instant: give the stage a \"time\" if it is to "
                        "grow.");
}

}  // namespace

std::string percent(double fraction) { return formatNumber(std::round(1e3 * fraction) / 10.0) + " %"; }

std::vector<std::string> warnings(const Built& built, const Scene& scene, bool starts) {
  Lines lines;
  lookAtNumbers(scene, lines);
  lookAtRelations(built, scene, lines);
  lookForContradictions(built, scene, lines);
  lookAtCompany(built, scene, lines);
  lookForIdleParts(built, scene, lines);
  lookForMeetings(built, scene, lines);
  lookForFalling(built, scene, lines);
  if (starts) lookAtOutput(built, scene, lines);
  lookAtContacts(built, lines);
  if (starts) lookAtSoftness(built, scene, lines);
  lookAtWalls(built, lines);
  for (std::size_t s = 0; s < scene.solids.size(); ++s) {
    const Solid& solid = scene.solids[s];
    lookAtMesh(built.meshes[s], solid, lines);
    lookAtThickness(built, scene, s, lines);
    lookAtBands(built, scene, s, lines);
    lookAtSets(scene, solid, lines);
    bool overlaps = false;
    for (const Coupling& coupling : scene.couplings) {
      if (coupling.solid != solid.name) continue;
      const auto* const overlap = std::get_if<Overlap>(&coupling.kind);
      overlaps = overlaps || overlap;
      if (overlap)
        lookAtOverlap(built, scene, s, *overlap, lines);
      else if (const auto* const contact = std::get_if<SurfaceContact>(&coupling.kind))
        lookAtSurfaceContact(built, scene, s, *contact, lines);
    }
    if (!overlaps) lookForGrainsWithin(built, s, lines);
    lookForStreamsWithin(built, scene, s, lines);
    lookForFreeSolids(built, scene, s, lines);
  }
  lookForBodiesWithin(built, scene, lines);
  lookAtNames(scene, lines);
  lookAtStages(scene, lines);
  lookAtLoadSteps(scene, lines);
  lookAtServos(built, scene, lines);
  return onePerKind(lines);
}

}  // namespace dovetail::scene
