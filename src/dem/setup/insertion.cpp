#include "dovetail/dem/setup/insertion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "free_room.hpp"

namespace dovetail::dem {

namespace {

/// Spheres that enter together: one, or those of a clump.
struct Newcomer {
  std::vector<Vec3> offset;  // from its centre, m
  std::vector<double> radius;
  double mass;
};

/// Radius of the sphere about its centre of mass that holds a clump, m.
double reachOf(const ClumpShape& shape) {
  double reach = 0.0;
  for (std::size_t k = 0; k < shape.offset.size(); ++k)
    reach = std::max(reach, norm(shape.offset[k]) + shape.radius[k]);
  return reach;
}

Newcomer nextOf(const Insertion& insertion) {
  const InsertionOptions& s = insertion.settings;
  if (!s.shapes.empty()) {
    const ClumpShape& shape = s.shapes[static_cast<std::size_t>(insertion.nextShape)];
    return {shape.offset, shape.radius, shape.properties.mass};
  }
  const double r = insertion.nextRadius;
  return {{Vec3{}}, {r}, s.density.value * (4.0 / 3.0) * std::numbers::pi * r * r * r};
}

void drawNext(Insertion& insertion) {
  const std::size_t shapes = insertion.settings.shapes.size();
  if (shapes == 0)
    insertion.nextRadius = drawRadius(insertion.settings.sizes, insertion.random);
  else if (shapes > 1)
    insertion.nextShape = static_cast<int>(insertion.random.uniform() * static_cast<double>(shapes));
}

/// Every turn as likely as any other (Shoemake, Graphics Gems III, 1992).
Quaternion drawTurn(RandomStream& random) {
  constexpr double circle = 2.0 * std::numbers::pi;
  const double fraction = random.uniform(), a = circle * random.uniform(), b = circle * random.uniform();
  const double s = std::sqrt(1.0 - fraction), c = std::sqrt(fraction);
  return {c * std::cos(b), s * std::sin(a), s * std::cos(a), c * std::sin(b)};
}

bool spans(const geometry::Periodicity& space, const geometry::Box& region, int axis) {
  return space.axes[static_cast<std::size_t>(axis)] &&
         region.upper[axis] - region.lower[axis] >= (1.0 - 1e-12) * space.length(axis);
}

/// A place for the centre, such that the spheres lie in the region.
Vec3 drawPlace(Insertion& insertion, const Newcomer& newcomer, const geometry::Periodicity& space) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Vec3 lower{-infinity, -infinity, -infinity}, upper{infinity, infinity, infinity};
  const geometry::Box& region = insertion.settings.region;
  for (int k = 0; k < 3; ++k) {
    const bool anywhere = spans(space, region, k);
    for (std::size_t s = 0; s < newcomer.radius.size(); ++s) {
      const double reach = anywhere ? 0.0 : newcomer.radius[s], offset = anywhere ? 0.0 : newcomer.offset[s][k];
      lower[k] = std::max(lower[k], region.lower[k] + reach - offset);
      upper[k] = std::min(upper[k], region.upper[k] - reach - offset);
    }
  }
  return insertion.random.point(lower, upper);
}

void checkSettings(const InsertionOptions& s) {
  if (s.shapes.empty()) {
    validate(s.sizes);
    requirePositive(s.density.value, "density of inserted particles");
  }
  for (const auto& [vector, field] : {std::pair{s.velocity, "velocity"}, std::pair{s.spin, "spin"}})
    if (!isFinite(vector))
      throw InputError("not a finite vector", std::string(field) + " of inserted particles",
                       "give three finite numbers");
  requireNonNegative(s.numberPerSecond, "number per second");
  requireNonNegative(s.massPerSecond, "mass per second");
  requireNonNegative(s.interval, "interval of an insertion");
  requireNonNegative(s.from, "begin of an insertion");
  if (!(s.until > s.from))
    throw InputError("it ends at " + formatNumber(s.until) + " s, and begins at " + formatNumber(s.from) + " s",
                     "insertion", "let it end after its begin");
  if (s.totalNumber < 1 || !(s.totalMass > 0.0))
    throw InputError("nothing is to enter", "insertion", "give a total number of 1 or more, and a total mass above 0");
  if ((s.numberPerSecond > 0.0) + (s.massPerSecond > 0.0) + s.replacesLeavers != 1)
    throw InputError("there are two rates, or none", "insertion",
                     "give numberPerSecond, massPerSecond or replacesLeavers");
  if (s.material < 0 || s.material > 255)
    throw InputError("the material is " + std::to_string(s.material), "insertion", "give one from 0 to 255");
  if (s.tries < 1) throw InputError("there are " + std::to_string(s.tries) + " tries", "insertion", "give 1 or more");
}

void checkRegion(const InsertionOptions& s) {
  double radius = s.shapes.empty() ? boundsOf(s.sizes).largest : 0.0;
  for (const ClumpShape& shape : s.shapes) radius = std::max(radius, reachOf(shape));
  for (int k = 0; k < 3; ++k) {
    const double length = s.region.upper[k] - s.region.lower[k];
    if (!(std::isfinite(s.region.lower[k]) && std::isfinite(length) && length >= 2.0 * radius))
      throw InputError("a " + std::string(s.shapes.empty() ? "sphere" : "clump") + " of diameter " +
                           formatNumber(2.0 * radius) + " m does not fit along axis " + "xyz"[k],
                       "region of insertion", "make the region larger, or the inserted grains smaller");
  }
}

/// Appends the newcomer at x; bodies are given for clumps.
void append(const Insertion& insertion, const Newcomer& newcomer, const Vec3& x, const Quaternion& turn,
            Particles& particles, Bodies* bodies, Clumps* clumps) {
  const InsertionOptions& s = insertion.settings;
  const std::size_t first = particles.size();
  if (s.shapes.empty()) {
    addParticle(particles, x, s.velocity, newcomer.radius[0], s.density);
    if (squaredNorm(s.spin) > 0.0) switchOnRotation(particles);
    if (particles.rotates()) particles.omega.back() = s.spin;
  } else {
    addClump(particles, *bodies, *clumps, s.shapes[static_cast<std::size_t>(insertion.nextShape)], x, turn, s.velocity,
             s.spin);
  }
  if (s.material == 0) return;
  particles.material.resize(particles.size(), 0);
  for (std::size_t i = first; i < particles.size(); ++i) particles.material[i] = static_cast<std::uint8_t>(s.material);
}

bool tryInsert(Insertion& insertion, Particles& particles, Bodies* bodies, Clumps* clumps,
               const geometry::Periodicity& space, FreeRoom& room) {
  const Newcomer described = nextOf(insertion);
  for (int attempt = 0; attempt < insertion.settings.tries; ++attempt) {
    Newcomer newcomer = described;
    const Quaternion turn = insertion.settings.shapes.empty() ? Quaternion{} : drawTurn(insertion.random);
    for (Vec3& offset : newcomer.offset) offset = rotate(turn, offset);
    const Vec3 x = drawPlace(insertion, newcomer, space);
    bool free = true;
    for (std::size_t s = 0; free && s < newcomer.radius.size(); ++s)
      free = room.isFree(x + newcomer.offset[s], newcomer.radius[s]);
    if (!free) continue;
    append(insertion, newcomer, x, turn, particles, bodies, clumps);
    for (std::size_t s = 0; s < newcomer.radius.size(); ++s) room.add(x + newcomer.offset[s], newcomer.radius[s]);
    return true;
  }
  return false;
}

int insert(Insertion& insertion, Particles& particles, Bodies* bodies, Clumps* clumps, const Surroundings& surroundings,
           double dt) {
  const InsertionOptions& s = insertion.settings;
  requireNonNegative(dt, "step of an insertion");
  const bool byMass = s.massPerSecond > 0.0;
  if (isComplete(insertion)) {
    insertion.due = 0.0;
    return 0;
  }
  insertion.due += dt * (byMass ? s.massPerSecond : s.numberPerSecond);
  insertion.waited += dt;
  const auto price = [&] { return byMass ? nextOf(insertion).mass : 1.0; };
  if (insertion.due < price() || insertion.waited < s.interval) return 0;
  if (squaredNorm(s.spin) > 0.0 && particles.size() > 0 && !particles.rotates())
    throw InputError("the particles do not spin", "spin of inserted particles", "call switchOnRotation before");
  if (!s.shapes.empty() && !bodies)
    throw InputError("clumps are due, and there are no bodies", "insertion", "call insertParticles with bodies");
  if (!(insertion.due <= 1e6 * price()))
    throw InputError("more than a million are due in one step", "insertion",
                     "lower its rate, or take an older checkpoint");
  insertion.waited = 0.0;
  FreeRoom room(particles, surroundings, s.region);
  int entered = 0;
  while (insertion.due >= price() && !isComplete(insertion)) {
    const double mass = nextOf(insertion).mass;
    insertion.due -= price();
    if (tryInsert(insertion, particles, bodies, clumps, surroundings.space, room)) {
      ++entered;
      ++insertion.inserted;
      insertion.insertedMass += mass;
    } else {
      ++insertion.refused;
      insertion.refusedMass += mass;
    }
    drawNext(insertion);
  }
  return entered;
}

}  // namespace

bool isComplete(const Insertion& insertion) {
  const InsertionOptions& s = insertion.settings;
  if (insertion.inserted >= s.totalNumber) return true;
  return std::isfinite(s.totalMass) && insertion.insertedMass + 0.5 * nextOf(insertion).mass > s.totalMass;
}

Insertion makeInsertion(const InsertionOptions& settings) {
  checkSettings(settings);
  checkRegion(settings);
  Insertion insertion{settings, RandomStream(settings.seed)};
  drawNext(insertion);
  return insertion;
}

int insertParticles(Insertion& insertion, Particles& particles, const Surroundings& surroundings, double dt) {
  return insert(insertion, particles, nullptr, nullptr, surroundings, dt);
}

int insertParticles(Insertion& insertion, Particles& particles, Bodies& bodies, Clumps& clumps,
                    const Surroundings& surroundings, double dt) {
  return insert(insertion, particles, &bodies, &clumps, surroundings, dt);
}

}  // namespace dovetail::dem
