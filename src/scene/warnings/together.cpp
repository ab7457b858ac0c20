// Parts of a scene that cannot be together as they lie at the start.
#include <algorithm>

#include "build/parts.hpp"
#include "build/sizes.hpp"
#include "build/time_functions.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "warnings.hpp"

namespace dovetail::scene {

namespace {

/// Grains at fault, and the worst of them.
struct AtFault {
  std::size_t count = 0;
  std::size_t worst = 0;
  double by = 0.0;  ///< m
  void add(std::size_t i, double excess) {
    ++count;
    if (excess > by) by = excess, worst = i;
  }
  std::string who(const dem::Particles& p) const {
    if (count == 1) return "1 grain lies ";
    return (count == p.size() ? "all " : "") + std::to_string(count) + " grains lie ";
  }
  std::string worstOf(const dem::Model& grains) const {
    const dem::Particles& p = grains.particles;
    return (grains.time > 0.0 ? "at t = " + formatNumber(grains.time) + " s" : std::string("at the start")) +
           ", the farthest by " + rounded(by) + " m (particle " + std::to_string(p.id[worst]) + " at " +
           placeText(p.x[worst]) + ")";
  }
};

// ---- domain

AtFault outsideOf(const dem::Domain& domain, const dem::Model& grains) {
  AtFault found;
  for (std::size_t i = 0; i < grains.particles.size(); ++i) {
    const Vec3 &x = grains.particles.x[i], below = domain.box.lower - x, above = x - domain.box.upper;
    double excess = 0.0;
    for (int k = 0; k < 3; ++k)
      if (!grains.pairs.periodicity().axes[static_cast<std::size_t>(k)])
        excess = std::max({excess, below[k], above[k]});
    if (excess > 0.0) found.add(i, excess);
  }
  return found;
}

void lookAtDomain(Built& built, const Scene& scene) {
  const dem::Model& grains = built.run->grains;
  if (!grains.domain) return;
  const AtFault found = outsideOf(*grains.domain, grains);
  if (found.count == 0) return;
  const std::string text = found.who(grains.particles) + "outside of the domain " + found.worstOf(grains);
  if (grains.domain->policy != dem::EscapePolicy::remove)
    throw InputError(text, scene.domain->where, "make domain.box larger, or let \"escape\" be \"remove\"");
  built.notes.push_back("WARNING: " + text + ", and are removed at once: make domain.box larger.");
}

// ---- walls

/// Their paths are given, whatever pushes them.
std::vector<char> drivenIn(const dem::Model& grains) {
  std::vector<char> driven(grains.particles.size(), 0);
  for (const auto* drive : grains.terms.all<dem::DriveTerm>())
    for (const std::int64_t id : drive->ids())
      if (const int i = dem::find(grains.particles, id); i >= 0) driven[static_cast<std::size_t>(i)] = 1;
  return driven;
}

std::string sideOf(const dem::PrimitiveWall& wall) {
  if (wall.shape == dem::PrimitiveWall::Shape::plane) return "behind the plane ";
  const std::string what = wall.shape == dem::PrimitiveWall::Shape::cylinder ? "the cylinder " : "the sphere ";
  return (wall.inside ? "outside of " : "within ") + what;
}
std::string sideOf(const Wall& wall, const dem::PrimitiveWall& part) {
  return std::holds_alternative<BoxWalls>(wall.shape) ? "outside of the box " : sideOf(part);
}
std::string remedyFor(const Wall& wall, const Scene& scene) {
  const Vec3 jump = pathOf(wall.velocity, wall.displacement, scene).displacement(0.0);
  if (norm(jump) > 0.0)
    return "the wall starts displaced by " + placeText(jump) +
           ", as its displacement is not 0 at t = 0: let it start at 0";
  if (std::holds_alternative<Plane>(wall.shape))
    return "reverse the normal, which has to point to the grains, or move one of the two";
  if (std::holds_alternative<BoxWalls>(wall.shape)) return "make the box larger, or move one of the two";
  return "change \"inside\" or the radius, or move one of the two";
}

// ---- periods

/// Grains must not touch two images of one grain.
void requirePeriods(const dem::Model& grains, const Scene& scene) {
  const double least = 4.0 * largestRadius(scene, grains.particles);
  for (int k = 0; k < 3; ++k)
    if (const geometry::Periodicity& space = grains.pairs.periodicity();
        space.axes[static_cast<std::size_t>(k)] && space.length(k) < least)
      throw InputError(std::string("the period along ") + "xyz"[k] + " is " + rounded(space.length(k)) +
                           " m, below twice the largest diameter",
                       scene.periodic->where, "give it more than " + rounded(least) + " m, or take smaller grains");
}

}  // namespace

void requireBefore(const dem::Model& grains, const Scene& scene, std::size_t item, const WallParts& parts) {
  const dem::Particles& p = grains.particles;
  const std::vector<char> driven = drivenIn(grains);
  for (std::size_t k = parts.firstPrimitive; k < parts.endPrimitive; ++k) {
    const dem::PrimitiveWall& wall = dem::primitiveWall(grains, k);
    AtFault found;
    for (std::size_t i = 0; i < p.size(); ++i) {
      const Vec3 x = wall.point + grains.pairs.periodicity().minimumImage(p.x[i] - wall.point);
      const double distance = dem::distanceTo(wall, x).distance;
      if (distance < 0.0 && !driven[i]) found.add(i, -distance);
    }
    if (found.count > 0)
      throw InputError(found.who(p) + sideOf(scene.walls[item], wall) + found.worstOf(grains), scene.walls[item].where,
                       remedyFor(scene.walls[item], scene));
  }
}

double largestRadius(const Scene& scene, const dem::Particles& particles) {
  double largest = 0.0;
  for (const double radius : particles.radius) largest = std::max(largest, radius);
  for (const Insertion& one : scene.insertions) largest = std::max(largest, enteringOf(one).largest);
  return largest;
}

std::string placeText(const Vec3& x) {
  std::string text = "(";
  return text.append(rounded(x.x)).append(", ").append(rounded(x.y)).append(", ").append(rounded(x.z)).append(") m");
}

void requireTogether(Built& built, const Scene& scene) {
  const dem::Model& grains = built.run->grains;
  requirePeriods(grains, scene);
  lookAtDomain(built, scene);
  for (std::size_t w = 0; w < scene.walls.size(); ++w)
    if (scene.walls[w].present) requireBefore(grains, scene, w, built.walls[w]);
}

}  // namespace dovetail::scene
