// Bonds and drives of a scene.
#include "dovetail/dem/bonds/bonds.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "dovetail/core/finite.hpp"
#include "dovetail/dem/bodies/body_term.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "keys/advice.hpp"
#include "parts.hpp"
#include "time_functions.hpp"
#include "wall_motion.hpp"
#include "warnings/warnings.hpp"

namespace dovetail::scene {

namespace {

const std::vector<std::int64_t>& groupNamed(const Groups& groups, const std::string& name) {
  if (const auto found = groups.find(name); found != groups.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& [known, ids] : groups) names.push_back(known);
  throw InputError("there is no group of particles or clumps \"" + name + "\"", "",
                   names.empty() ? "give the group in particles, or the clumps, this name" : adviceFor(name, names));
}

/// Marks of the particles of a group, by number.
std::vector<char> membersOf(const dem::Particles& particles, const Groups& groups, const std::string& name) {
  std::vector<char> member(particles.size(), 0);
  for (const std::int64_t id : groupNamed(groups, name)) member[static_cast<std::size_t>(find(particles, id))] = 1;
  return member;
}

/// Body of every particle, −1 of those that are no members.
std::vector<int> bodiesIn(const dem::Model& grains) {
  const auto terms = grains.terms.all<dem::BodyTerm>();
  return dem::bodyOfParticles(grains.particles.size(), terms.empty() ? dem::Clumps{} : terms.front()->clumps);
}

dem::BondMaterial materialOf(const BondGroup& group) {
  constexpr double unbreakable = std::numeric_limits<double>::infinity();
  return {.youngsModulus = group.youngsModulus,
          .poissonRatio = group.poissonRatio,
          .radiusRatio = group.radiusRatio,
          .tensileStrength = group.tensileStrength.value_or(unbreakable),
          .shearStrength = group.shearStrength.value_or(unbreakable),
          .momentContribution = group.momentContribution,
          .dampingTime = group.dampingTime};
}

void add(dem::Model& grains, const BondGroup& group, const Groups& groups, std::vector<std::string>& notes) {
  const std::vector<char> one = membersOf(grains.particles, groups, group.group);
  const std::vector<char> other = group.with.empty() ? one : membersOf(grains.particles, groups, group.with);
  dem::PairList near;
  near.setPeriodicity(grains.pairs.periodicity());
  double largest = 0.0;  // m
  for (const double radius : grains.particles.radius) largest = std::max(largest, radius);
  near.setSkin(group.gap + 1e-9 * largest);
  dem::findPairs(grains.particles, near);
  const std::vector<int> body = bodiesIn(grains);
  const int count =
      dem::bondTouching(dem::bonds(grains), grains.particles, near, group.gap, materialOf(group), [&](int i, int j) {
        const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
        if (body[a] >= 0 && body[a] == body[b]) return false;
        return (one[a] && other[b]) || (one[b] && other[a]);
      });
  if (count == 0)
    throw InputError("no two unbonded grains of different clumps are within the gap", "",
                     "give a larger gap, or put them closer");
  notes.push_back(std::to_string(count) + " bonds in \"" + group.group + "\"" +
                  (group.with.empty() ? "." : " with \"" + group.with + "\"."));
}

/// Empty if there is none.
std::function<Vec3(double)> spinOf(const Drive& drive, const Scene& scene) {
  if (isConstant(drive.spin) && norm(constantOf(drive.spin)) == 0.0) return {};
  std::array<TimeFunction, 3> parts;
  for (std::size_t c = 0; c < 3; ++c) parts[c] = functionOf(drive.spin[c], scene);
  return [parts](double t) {
    const double from = std::max(0.0, t);
    return Vec3{parts[0](from), parts[1](from), parts[2](from)};
  };
}

bool turns(const Drive& drive) { return drive.turn || norm(drive.angularVelocity) > 0.0; }

/// Mean place of grains and clumps, m.
Vec3 centreOf(const dem::Model& grains, const std::vector<std::int64_t>& ids) {
  const std::vector<int> body = bodiesIn(grains);
  std::vector<Vec3> places;
  std::set<int> counted;
  for (const std::int64_t id : ids) {
    const auto i = static_cast<std::size_t>(find(grains.particles, id));
    if (body[i] < 0)
      places.push_back(grains.particles.x[i]);
    else if (counted.insert(body[i]).second)
      places.push_back(grains.terms.all<dem::BodyTerm>().front()->bodies.x[static_cast<std::size_t>(body[i])]);
  }
  Vec3 sum;
  for (const Vec3& x : places) sum += grains.pairs.periodicity().minimumImage(x - places.front());
  return places.front() + (1.0 / static_cast<double>(places.size())) * sum;
}

/// In periodic space nobody may pass the image of the axis.
void requireNearAxis(const dem::Model& grains, const std::vector<std::int64_t>& ids, const Vec3& axis,
                     const Vec3& point) {
  const geometry::Periodicity& space = grains.pairs.periodicity();
  for (int k = 0; k < 3; ++k) {
    const double along = std::abs(axis[k]);
    if (!space.axes[static_cast<std::size_t>(k)] || along > 1.0 - 1e-12) continue;
    for (const std::int64_t id : ids) {
      const Vec3 arm =
          space.minimumImage(grains.particles.x[static_cast<std::size_t>(find(grains.particles, id))] - point);
      const double height = dot(arm, axis), reach = std::sqrt(std::max(0.0, squaredNorm(arm) - height * height));
      if (std::abs(height) * along + reach * std::sqrt(1.0 - along * along) < 0.5 * space.length(k)) continue;
      throw InputError("a grain turns about an axis " + formatNumber(reach) +
                           " m away, in a space that repeats every " + formatNumber(space.length(k)) + " m along " +
                           "xyz"[k],
                       "", "keep the group nearer than half a period to the axis, or let the axis be along the period");
    }
  }
}

dem::DriveTerm rigidDrive(const dem::Model& grains, const Drive& drive, const std::vector<std::int64_t>& ids,
                          const Scene& scene, const StepOf& step) {
  if (!isConstant(drive.spin) || norm(constantOf(drive.spin)) > 0.0)
    throw InputError("both a spin and a turn are given", "",
                     "leave one out: with a turn, grains spin with the group; with a spin, each about its own centre");
  const Vec3 own = centreOf(grains, ids), point = drive.turn ? drive.turn->point.value_or(own) : own;
  dem::PrescribedMotion motion = motionOf(drive, {point, {}, {}, {}}, own, 0.0, scene, step);
  requireNearAxis(grains, ids, normalized(drive.turn ? drive.turn->axis : drive.angularVelocity), point);
  return {ids, std::move(motion)};
}

dem::DriveTerm driveOf(dem::Model& grains, const Drive& drive, const std::vector<std::int64_t>& ids, const Scene& scene,
                       const StepOf& step) {
  if (turns(drive)) return rigidDrive(grains, drive, ids, scene, step);
  Path path = pathOf(drive.velocity, drive.displacement, scene, step);
  const auto spin = spinOf(drive, scene);
  if (spin) dem::switchOnRotation(grains.particles);
  return {ids, path.displacement, path.velocity, spin};
}

void requireAlike(const std::vector<BondGroup>& all) {
  for (const BondGroup& group : all)
    if (group.contacts != all.front().contacts)
      throw InputError("\"contacts\" differs from that of the other bonds", group.where, "give all bonds the same");
}

/// Both items would claim the same grains.
void requireOnce(const Scene& scene) {
  std::set<std::set<std::string>> bonded;
  for (const BondGroup& one : scene.bonds)
    if (!bonded.insert({one.group, one.with.empty() ? one.group : one.with}).second)
      throw InputError("the grains of " + quoted(one.group) +
                           (one.with.empty() || one.with == one.group ? "" : " and " + quoted(one.with)) +
                           " are bonded by another item of \"bonds\" already",
                       one.where, "leave one of the two out");
  std::set<std::string> driven;
  for (const Drive& one : scene.drives)
    if (!driven.insert(one.group).second)
      throw InputError("the grains of " + quoted(one.group) + " are driven by another item of \"drives\" already",
                       one.where, "leave one of the two out, or put both motions into one");
}

}  // namespace

void addBondsAndDrives(Built& built, const Scene& scene, const Groups& groups) {
  dem::Model& grains = built.run->grains;
  std::vector<std::string>& notes = built.notes;
  requireAlike(scene.bonds);
  requireOnce(scene);
  if (!scene.bonds.empty()) {
    dem::switchOnRotation(grains.particles);
    dem::bonds(grains);
    grains.terms.all<dem::BondTerm>().front()->mutesContacts = !scene.bonds.front().contacts;
  }
  for (const BondGroup& group : scene.bonds) atPlace(group.where, [&] { add(grains, group, groups, notes); });
  for (const Drive& drive : scene.drives)
    atPlace(drive.where, [&] {
      grains.terms.add(driveOf(grains, drive, groupNamed(groups, drive.group), scene, stepOf(*built.run)));
    });
}

}  // namespace dovetail::scene
