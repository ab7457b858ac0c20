// Bonds and drives of a scene.
#include "dovetail/dem/bonds/bonds.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <set>

#include "dovetail/dem/model/loads.hpp"
#include "keys/advice.hpp"
#include "parts.hpp"
#include "time_functions.hpp"
#include "warnings/warnings.hpp"

namespace dovetail::scene {

namespace {

const std::vector<std::int64_t>& groupNamed(const Groups& groups, const std::string& name) {
  if (const auto found = groups.find(name); found != groups.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& [known, ids] : groups) names.push_back(known);
  throw InputError("there is no group of particles \"" + name + "\"", "",
                   names.empty() ? "give the group in particles this name" : adviceFor(name, names));
}

/// Marks of the particles of a group, by number.
std::vector<char> membersOf(const dem::Particles& particles, const Groups& groups, const std::string& name) {
  std::vector<char> member(particles.size(), 0);
  for (const std::int64_t id : groupNamed(groups, name)) member[static_cast<std::size_t>(find(particles, id))] = 1;
  return member;
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
  const int count =
      dem::bondTouching(dem::bonds(grains), grains.particles, near, group.gap, materialOf(group), [&](int i, int j) {
        const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
        return (one[a] && other[b]) || (one[b] && other[a]);
      });
  if (count == 0)
    throw InputError("no two unbonded grains are within the gap", "", "give a larger gap, or put them closer");
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

void addBondsAndDrives(dem::Model& grains, const Scene& scene, const Groups& groups, std::vector<std::string>& notes) {
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
      Path path = pathOf(drive.velocity, drive.displacement, scene);
      const auto spin = spinOf(drive, scene);
      if (spin) dem::switchOnRotation(grains.particles);
      grains.terms.add(dem::DriveTerm(groupNamed(groups, drive.group), path.displacement, path.velocity, spin));
    });
}

}  // namespace dovetail::scene
