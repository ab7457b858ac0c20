// What stages cannot change.
#include <algorithm>
#include <map>
#include <set>

#include "changed_parts.hpp"
#include "changes.hpp"
#include "dovetail/core/error.hpp"
#include "law_kinds.hpp"
#include "parts.hpp"
#include "supports.hpp"
#include "time_functions.hpp"
#include "wall_motion.hpp"
#include "warnings/warnings.hpp"

namespace dovetail::scene {

namespace {

bool isBonded(const ContactLaw& law) {
  const auto* const linear = std::get_if<LinearContact>(&law.normal);
  return linear && linear->bonded;
}
void requireLaw(const Scene& scene, const ContactLaw& law) {
  if (!scene.contact && scene.contacts.empty())
    throw InputError("the scene has no contact law that could change", law.where, "give it one from the start");
  const ContactLaw& first = scene.contact ? *scene.contact : scene.contacts.front().law;
  if (isBonded(law) || isBonded(first))
    throw InputError("bonded springs cannot change", law.where, "leave contact out of the changes");
  requireSameNormal(law, first);
}

void requireLoad(const Scene& scene, const LoadChange& change) {
  const auto solid = std::ranges::find(scene.solids, change.solid, &Solid::name);
  if (solid == scene.solids.end())
    throw InputError("there is no solid \"" + change.solid + "\"", "", "give the name of one");
  const auto load = std::ranges::find_if(solid->loads, [&](const Load& one) {
    return one.on == change.load.on && one.kind.index() == change.load.kind.index();
  });
  if (load == solid->loads.end())
    throw InputError("\"" + change.solid + "\" has no such load on \"" + change.load.on + "\" before", "",
                     "give it one of 0 from the start");
  const auto* const traction = std::get_if<TractionLoad>(&change.load.kind);
  const auto* const pressure = std::get_if<PressureLoad>(&change.load.kind);
  if ((traction && usesPlace(traction->traction)) || (pressure && usesPlace(pressure->pressure)))
    throw InputError("a load of the place cannot change", "", "leave x, y and z out of it");
  const auto* const before = std::get_if<PressureLoad>(&load->kind);
  const auto* const now = std::get_if<PressureLoad>(&change.load.kind);
  if (before && now && before->follows != now->follows)
    throw InputError("the pressure on \"" + change.load.on + "\" follows the faces before or then, not both", "",
                     "give both the same \"follows\"");
}

void requirePlane(const Built& built, const Scene& scene, const PlaneChange& change) {
  const Solid& solid = scene.solids[solidNamed(change.solid, *built.run)];
  if (change.plane >= static_cast<std::int64_t>(solid.planes.size()))
    throw InputError("\"" + change.solid + "\" has " + std::to_string(solid.planes.size()) + " planes", "",
                     "take one of them, counted from 0");
  if (norm(pathOf(change.velocity, change.displacement, scene, stepOf(*built.run)).displacement(0.0)) > 0.0)
    throw InputError("the plane moves at once as the stage begins", "",
                     "let its displacement start at 0: t counts from there");
}

void requirePlanes(const Built& built, const Scene& scene, const Changes& changes) {
  std::set<std::string> known;
  for (const PlaneChange& one : changes.planes)
    atPlace(one.where, [&] {
      requirePlane(built, scene, one);
      if (!known.insert(keyOfPlane(one.solid, static_cast<std::size_t>(one.plane))).second)
        throw InputError("the plane changes twice in one stage", "", "leave one of the changes out");
    });
}

bool isPut(const SupportNow& one, const SupportChange& change) {
  const Support &a = one.support, &b = change.support;
  return a.on == b.on && ((a.x && b.x) || (a.y && b.y) || (a.z && b.z));
}
/// Tries the supports of a stage on a solid that nothing has moved. @param since  of this stage
void requireSupports(const Built& built, const Scene& scene, const SupportChange& one,
                     std::vector<std::vector<SupportNow>>& supports, double since) {
  const std::size_t s = atPlace(one.where, [&] { return solidNamed(one.solid, *built.run); });
  const fem::SolidMesh& mesh = built.meshes[s];
  atPlace(one.where, [&] { fem::nodeSet(mesh, one.support.on); });
  const Support& own = one.support;
  if (!one.present && (own.displacement || own.turn || !isConstant(own.velocity) || norm(constantOf(own.velocity)) > 0))
    throw InputError("the support on \"" + own.on + "\" lets nodes go and moves them", one.where,
                     "leave its motion out, or \"present\"");
  if (!one.present && std::ranges::none_of(supports[s], [&](const SupportNow& now) { return isPut(now, one); }))
    throw InputError("no support on \"" + own.on + "\" holds these components before", one.where,
                     "leave the change out, or name a set that a support is on");
  change(supports[s], one, since, nullptr);
  fem::Model model = fem::makeModel(mesh);
  const auto jumps = putHolders(model, mesh, scene.solids[s], scene, stepOf(*built.run), supports[s]);
  if (one.present && !jumps.empty() && jumps.back().find(supports[s].back().name) != std::string::npos)
    throw InputError("the support on \"" + own.on + "\" moves nodes at once as the stage begins", one.where,
                     "let its displacement start at 0, such as \"0.1*min(t/T, 1)\": t counts from there");
}

constexpr const char* beginLater =
    "run for a time in place of relaxing, or let a later stage begin it by its \"changes\"";
bool isSteady(const TimeVector& velocity) { return isConstant(velocity) && norm(constantOf(velocity)) > 0.0; }

/// While a stage relaxes.
void requireStandstill(const std::vector<std::vector<SupportNow>>& supports) {
  for (const std::vector<SupportNow>& all : supports)
    for (const SupportNow& one : all)
      if (isSteady(one.support.velocity))
        throw InputError("a stage relaxes, but a support has a steady velocity", one.support.where, beginLater);
}

/// Planes while a stage relaxes.
void requireStandstillOfPlanes(const Scene& scene) {
  std::map<std::string, std::string> moving;  // by key, where its motion is
  for (const Solid& solid : scene.solids)
    for (std::size_t k = 0; k < solid.planes.size(); ++k)
      if (isSteady(solid.planes[k].velocity)) moving[keyOfPlane(solid.name, k)] = solid.planes[k].where;
  for (const Stage& stage : scene.stages) {
    for (const PlaneChange& one : stage.changes ? stage.changes->planes : std::vector<PlaneChange>{}) {
      const std::string key = keyOfPlane(one.solid, static_cast<std::size_t>(one.plane));
      moving.erase(key);
      if (isSteady(one.velocity)) moving[key] = one.where;
    }
    if (std::holds_alternative<Relax>(stage.kind) && !moving.empty())
      throw InputError("a stage relaxes, but a plane has a steady velocity", moving.begin()->second, beginLater);
  }
}

/// What moves steadily as a stage begins.
struct Steady {
  bool path = false, belt = false, present = true;
  std::string where;
};
bool isSteadyPath(const WallMotion& motion) { return norm(motion.angularVelocity) > 0.0 || isSteady(motion.velocity); }
void requireStandstill(const Scene& scene) {
  std::vector<Steady> walls;
  for (const Wall& wall : scene.walls)
    walls.push_back({isSteadyPath(wall), norm(wall.surfaceVelocity) > 0.0, wall.present, wall.where});
  for (const Stage& stage : scene.stages) {
    for (const WallChange& one : stage.changes ? stage.changes->walls : std::vector<WallChange>{}) {
      Steady& wall = walls[atPlace(one.where, [&] { return wallNamed(one.wall, scene); })];
      if (movesAnew(one)) wall.path = isSteadyPath(motionIn(one)), wall.where = one.where;
      if (one.surfaceVelocity) wall.belt = norm(*one.surfaceVelocity) > 0.0, wall.where = one.where;
      wall.present = one.present.value_or(wall.present);
    }
    if (!std::holds_alternative<Relax>(stage.kind)) continue;
    for (const Steady& wall : walls)
      if (wall.present && (wall.path || wall.belt))
        throw InputError(
            std::string("a stage relaxes, but a wall has a steady ") + (wall.path ? "velocity" : "surface_velocity"),
            wall.where, beginLater);
  }
}

}  // namespace

void requireChanges(const Built& built, const Scene& scene) {
  requireStandstill(scene);
  for (const Stage& stage : scene.stages)
    if (stage.changes) requirePlanes(built, scene, *stage.changes);
  requireStandstillOfPlanes(scene);
  std::vector<std::vector<SupportNow>> supports = built.supports;
  for (std::size_t k = 0; k < scene.stages.size(); ++k) {
    if (!scene.stages[k].changes) {
      if (std::holds_alternative<Relax>(scene.stages[k].kind)) requireStandstill(supports);
      continue;
    }
    const Changes& changes = *scene.stages[k].changes;
    if (!std::holds_alternative<Relax>(scene.stages[k].kind) && !std::holds_alternative<RunFor>(scene.stages[k].kind))
      throw InputError("only stages that relax or run have changes", changes.where,
                       "give them to the stage that follows");
    if (changes.contact) requireLaw(scene, *changes.contact);
    for (const PairLaw& pair : changes.contacts) {
      requireLaw(scene, pair.law);
      atPlace(pair.law.where, [&] { contactRow(scene, pair.first), contactRow(scene, pair.second); });
    }
    for (const LoadChange& one : changes.loads) atPlace(one.where, [&] { requireLoad(scene, one); });
    for (const SupportChange& one : changes.supports)
      requireSupports(built, scene, one, supports, static_cast<double>(k + 1));
    if (std::holds_alternative<Relax>(scene.stages[k].kind)) requireStandstill(supports);
    grainsAt(built, scene, k);
  }
}

}  // namespace dovetail::scene
