#include "changes.hpp"

#include <algorithm>

#include "changed_parts.hpp"
#include "dovetail/core/error.hpp"
#include "parts.hpp"
#include "supports.hpp"
#include "time_functions.hpp"
#include "wall_motion.hpp"

namespace dovetail::scene {

namespace {

void change(const MovedModel& model, std::vector<WallParts>& walls, const WallChange& change, const Scene& scene) {
  const std::size_t item = wallNamed(change.wall, scene);
  WallParts& parts = walls[item];
  if (movesAnew(change)) setMotion(model, parts, motionIn(change), scene);
  if (change.surfaceVelocity) setSurfaceVelocity(model.grains, parts, *change.surfaceVelocity);
  if (change.present) setPresence(model.grains, parts, *change.present);
}

/// Of gravity, laws and walls.
void changeGrains(const MovedModel& model, std::vector<WallParts>& walls, const Scene& scene, std::size_t stage) {
  const Changes& changes = *scene.stages[stage].changes;
  if (changes.gravity) model.grains.gravity = *changes.gravity;
  if (changesLaws(scene.stages[stage])) model.grains.laws = makeLaws(lawsAt(scene, stage));
  for (const WallChange& one : changes.walls) atPlace(one.where, [&] { change(model, walls, one, scene); });
  if (changes.gravity)
    for (const WallParts& parts : walls) setServoLoad(model.grains, parts, scene);
}

void changeLoads(Built& built, const Scene& scene, const Changes& changes, double since) {
  const auto put = [&](const LoadChange& one, const TimeValue& value, int component) {
    TimeFunction function = functionOf(value, scene);
    *built.changing.loads.at(keyOfLoad(one.solid, one.load, component)) = [function, since](double t) {
      return function(std::max(0.0, t - since));
    };
  };
  for (const LoadChange& one : changes.loads) {
    if (const auto* const pressure = std::get_if<PressureLoad>(&one.load.kind)) {
      put(one, pressure->pressure, 0);
      continue;
    }
    const auto* const traction = std::get_if<TractionLoad>(&one.load.kind);
    const TimeVector& parts = traction ? traction->traction : std::get<NodalLoad>(one.load.kind).force;
    for (std::size_t c = 0; c < 3; ++c) put(one, parts[c], static_cast<int>(c));
  }
}

/// From where it is then.
void changePlanes(Built& built, const Scene& scene, const Changes& changes, double since) {
  for (const PlaneChange& one : changes.planes) {
    std::function<Vec3(double)>& motion =
        *built.changing.planes.at(keyOfPlane(one.solid, static_cast<std::size_t>(one.plane)));
    const Vec3 from = motion(since);
    const auto further = pathOf(one.velocity, one.displacement, scene, stepOf(*built.run)).displacement;
    motion = [=](double t) { return from + further(std::max(0.0, t - since)); };
  }
}

void changeSupports(Built& built, const Scene& scene, const Changes& changes, const StageStart& start) {
  for (std::size_t s = 0; s < scene.solids.size() && s < start.displacements.size(); ++s) {
    if (start.displacements[s].u.empty()) continue;
    const auto from = std::make_shared<const std::vector<Vec3>>(start.displacements[s].u);
    for (const SupportChange& one : changes.supports)
      if (one.solid == scene.solids[s].name) change(built.supports[s], one, start.time, from);
    putHolders(*built.run->solid(s).model, built.meshes[s], scene.solids[s], scene, stepOf(*built.run),
               built.supports[s]);
  }
}

/// Walls that appear push what lies behind them to their other side.
void requireNoneBehind(const Built& built, const Scene& scene, const Changes& changes) {
  for (const WallChange& one : changes.walls)
    if (one.present.value_or(false)) {
      const std::size_t item = wallNamed(one.wall, scene);
      atPlace(one.where, [&] { requireBefore(built.run->grains, scene, item, built.walls[item]); });
    }
}

}  // namespace

bool movesAnew(const WallChange& change) {
  return change.velocity || change.displacement || change.angularVelocity || change.turn || change.servo;
}
WallMotion motionIn(const WallChange& change) {
  WallMotion motion;
  if (change.velocity) motion.velocity = *change.velocity;
  motion.displacement = change.displacement;
  motion.angularVelocity = change.angularVelocity.value_or(Vec3{});
  motion.turn = change.turn;
  motion.servo = change.servo;
  return motion;
}

void change(std::vector<SupportNow>& supports, const SupportChange& change, double since,
            const std::shared_ptr<const std::vector<Vec3>>& from) {
  for (SupportNow& one : supports)
    if (one.support.on == change.support.on) {
      one.support.x = one.support.x && !change.support.x;
      one.support.y = one.support.y && !change.support.y;
      one.support.z = one.support.z && !change.support.z;
    }
  std::erase_if(supports, [](const SupportNow& one) { return !one.support.x && !one.support.y && !one.support.z; });
  if (!change.present) return;
  supports.push_back({change.support, "the changed support on \"" + change.support.on + "\"", since, from});
  supports.back().support.where = change.where;
}

StageStart startOf(const Built& built, const Scene& scene, std::size_t stage) {
  StageStart start{built.run->time(), {}, {}};
  for (std::size_t s = 0; s < scene.solids.size(); ++s) {
    const bool moves = scene.stages[stage].changes &&
                       std::ranges::any_of(scene.stages[stage].changes->supports,
                                           [&](const SupportChange& one) { return one.solid == scene.solids[s].name; });
    start.displacements.emplace_back();
    if (moves) start.displacements.back().u = std::as_const(*built.run).solid(s).nodes().u;
  }
  for (const WallParts& parts : built.walls) {
    const dem::WallServo* const servo = servoIn(built.run->grains, parts);
    start.travels.push_back(servo ? servo->travel : 0.0);
  }
  return start;
}

void beginStage(Built& built, const Scene& scene, std::size_t stage, const StageStart& start, Grains grains) {
  if (!scene.stages[stage].changes) return;
  const Changes& changes = *scene.stages[stage].changes;
  coupling::CoupledRun& run = *built.run;
  const auto act = [&] {
    run.grains.time = start.time;
    for (std::size_t w = 0; w < built.walls.size() && w < start.travels.size(); ++w)
      if (dem::WallServo* const servo = servoIn(run.grains, built.walls[w])) servo->travel = start.travels[w];
    changeGrains({run.grains, run}, built.walls, scene, stage);
    if (grains == Grains::areThere) requireNoneBehind(built, scene, changes);
    if (changes.gravity) *built.changing.gravity = *changes.gravity;
    changeLoads(built, scene, changes, start.time);
    changePlanes(built, scene, changes, start.time);
    changeSupports(built, scene, changes, start);
  };
  // Walls that jump to where a state has them may pass grains that still lie as at the start. Solids begin anew where
  // others hold them.
  grains == Grains::areThere || !changes.supports.empty() ? run.change(act) : act();
}

dem::Model grainsAt(const Built& built, const Scene& scene, std::size_t stage) {
  dem::Model grains = built.run->grains;
  std::vector<WallParts> walls = built.walls;
  for (std::size_t k = 0; k <= stage; ++k)
    if (scene.stages[k].changes) changeGrains({grains, *built.run}, walls, scene, k);
  return grains;
}

bool changesLaws(const Stage& stage) {
  return stage.changes && (stage.changes->contact || !stage.changes->contacts.empty());
}

Scene lawsAt(const Scene& scene, std::size_t stage) {
  Scene now = scene;
  for (std::size_t k = 0; k <= stage; ++k) {
    if (!scene.stages[k].changes) continue;
    if (scene.stages[k].changes->contact) now.contact = scene.stages[k].changes->contact;
    for (const PairLaw& pair : scene.stages[k].changes->contacts) {
      const auto same = std::ranges::find_if(now.contacts, [&](const PairLaw& one) {
        return (one.first == pair.first && one.second == pair.second) ||
               (one.first == pair.second && one.second == pair.first);
      });
      same == now.contacts.end() ? now.contacts.push_back(pair) : static_cast<void>(*same = pair);
    }
  }
  return now;
}

bool changesGravity(const Scene& scene) {
  return std::ranges::any_of(scene.stages, [](const Stage& one) { return one.changes && one.changes->gravity; });
}

bool changesSupports(const Solid& solid, const Scene& scene) {
  return std::ranges::any_of(scene.stages, [&](const Stage& stage) {
    return stage.changes && std::ranges::any_of(stage.changes->supports,
                                                [&](const SupportChange& one) { return one.solid == solid.name; });
  });
}

bool isChanged(const Load& load, const Solid& solid, const Scene& scene) {
  return std::ranges::any_of(scene.stages, [&](const Stage& stage) {
    return stage.changes && std::ranges::any_of(stage.changes->loads, [&](const LoadChange& one) {
             return one.solid == solid.name && one.load.on == load.on && one.load.kind.index() == load.kind.index();
           });
  });
}

bool isPlaneChanged(const std::string& solid, std::size_t plane, const Scene& scene) {
  return std::ranges::any_of(scene.stages, [&](const Stage& stage) {
    return stage.changes && std::ranges::any_of(stage.changes->planes, [&](const PlaneChange& one) {
             return one.solid == solid && one.plane == static_cast<std::int64_t>(plane);
           });
  });
}

std::string keyOfPlane(const std::string& solid, std::size_t plane) { return solid + " " + std::to_string(plane); }

std::string keyOfLoad(const std::string& solid, const Load& load, int component) {
  return solid + " " + load.on + " " + std::to_string(load.kind.index()) + " " + std::to_string(component);
}

}  // namespace dovetail::scene
