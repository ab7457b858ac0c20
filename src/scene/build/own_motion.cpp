#include "dovetail/scene/own_motion.hpp"

#include <algorithm>
#include <set>

#include "dovetail/core/finite.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "own_paths.hpp"
#include "parts.hpp"

namespace dovetail::scene {

namespace {

void requireConsistent(const OwnPath& path, const std::string& what) {
  if (path.displacement && path.velocity)
    throw InputError("both a velocity and a displacement are given", what, "leave one of them out");
  if (!path.displacement && !path.velocity && !path.rate)
    throw InputError("no motion is given", what, "give a velocity, a displacement or a rate about an axis");
  if (path.rate && norm(path.axis) == 0.0)
    throw InputError("the axis of the turn has no length", what, "give it a direction, such as [0, 0, 1]");
}

/// Counted from `since`.
std::function<Vec3(double)> from(double since, const std::function<Vec3(double)>& function) {
  return [=](double t) { return function(since + t); };
}
Path pathFrom(const OwnPath& path, double since, const StepOf& step) {
  if (path.velocity) return pathOf(from(since, path.velocity), true, step);
  if (path.displacement) {
    const Vec3 begin = path.displacement(since);
    return pathOf([=, at = path.displacement](double t) { return at(since + t) - begin; }, false, step);
  }
  const auto rest = [](double) { return Vec3{}; };
  return {rest, rest};
}
Travel angleOf(const OwnPath& path, double since, const StepOf& step) {
  const auto rest = [](double) { return 0.0; };
  if (!path.rate) return {rest, rest};
  return travelAt([=, rate = path.rate](double t) { return rate(since + t); }, step, step());
}

dem::PrescribedMotion motionOf(const OwnPath& path, const dem::RigidMotion& base, const Vec3& own, double since,
                               const coupling::CoupledRun& run) {
  const StepOf step = [&run] { return run.dt(); };
  const Vec3 axis = path.rate ? normalized(path.axis) : Vec3{};
  return rigidMotion(pathFrom(path, since, step), angleOf(path, since, step), axis, path.point.value_or(own), base,
                     since);
}

/// What the functions give is asked for before anything changes.
void tryOut(const OwnPath& path, double time) {
  if (path.displacement) path.displacement(time);
  if (path.velocity) path.velocity(time);
  if (path.rate) path.rate(time);
}

void requireFree(const dem::Model& grains, const std::vector<std::int64_t>& ids) {
  if (ids.empty()) throw InputError("there are no grains to drive", "drive", "give ids of grains");
  std::set<std::int64_t> driven;
  for (const auto* drive : grains.terms.all<dem::DriveTerm>()) driven.insert(drive->ids().begin(), drive->ids().end());
  for (const std::int64_t id : ids) {
    const int i = dem::find(grains.particles, id);
    if (i < 0) throw InputError("there is no grain " + std::to_string(id), "drive", "give ids of grains of the run");
    if (grains.particles.isOfSolid(static_cast<std::size_t>(i)))
      throw InputError("grain " + std::to_string(id) + " stands for a part of a solid", "drive",
                       "move a wall or a plane against it");
    if (!driven.insert(id).second)
      throw InputError("grain " + std::to_string(id) + " is driven already", "drive",
                       "leave it out, or put both motions into one");
  }
}

}  // namespace

void moveWall(Built& built, const Scene& scene, const std::string& wall, const OwnPath& path) {
  coupling::CoupledRun& run = *built.run;
  requireConsistent(path, "wall \"" + wall + "\"");
  tryOut(path, run.time());
  WallParts& parts = built.walls[wallNamed(wall, scene)];
  requireRepeatsTurned(run.grains, parts, path.rate ? path.axis : Vec3{});
  run.change([&] {
    setPath({run.grains, run}, parts, path.rate ? path.axis : Vec3{}, [&](const WallParts& now) {
      const Vec3 own = now.base.x + rotate(now.base.turn, now.centre);
      return motionOf(path, now.base, own, now.since, run);
    });
  });
}

void driveGrains(Built& built, const std::vector<std::int64_t>& ids, const OwnPath& path,
                 const std::function<Vec3(double)>& spin) {
  coupling::CoupledRun& run = *built.run;
  dem::Model& grains = run.grains;
  if (!spin || path.rate) requireConsistent(path, "drive");
  if (spin && path.rate) throw InputError("both a spin and a turn are given", "drive", "leave one of them out");
  if (spin && !grains.particles.rotates())
    throw InputError("grains of this run do not spin", "drive", "leave the spin out, or give them laws with torques");
  if (path.rate && !path.point)
    throw InputError("the turn has no point on its axis", "drive", "give it a point, such as [0, 0, 0]");
  const auto& axes = grains.pairs.periodicity().axes;
  if (path.rate && std::ranges::any_of(axes, [](bool one) { return one; }))
    throw InputError("a group would turn in periodic space", "drive", "write the drive into the scene");
  requireFree(grains, ids);
  tryOut(path, run.time());
  if (spin) spin(run.time());
  const double since = run.time();
  const Vec3 own = path.point.value_or(Vec3{});
  const auto drive = [&] {
    if (path.rate) return dem::DriveTerm(ids, motionOf(path, {own, {}, {}, {}}, own, since, run));
    const Path along = pathFrom(path, since, [&run] { return run.dt(); });
    const auto at = [since](const auto& function) { return [=](double t) { return function(t - since); }; };
    return dem::DriveTerm(ids, at(along.displacement), at(along.velocity), spin);
  };
  dem::DriveTerm made = drive();
  made.check(grains);
  run.change([&] { grains.terms.add(std::move(made)); });
}

}  // namespace dovetail::scene
