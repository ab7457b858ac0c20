// Which particles a primitive wall may touch, and which it touches.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/walls/primitive_wall.hpp"
#include "dovetail/dem/walls/wall_candidates.hpp"

namespace dovetail::dem {

namespace {

using Shape = PrimitiveWall::Shape;

constexpr std::size_t chunkSize = 4096;

/// How many periods x is to be moved by to be next to the wall.
Image imageNear(const PrimitiveWall& wall, const Vec3& x, const Vec3& period) {
  const Image image = periodsIn(wall.point - x, period);
  return image;
}

/// Bound on how much the distance of any particle from the wall has changed by the wall's own motion, m.
double wallMove(const PrimitiveWall& wall, const Vec3& point, const Vec3& axis, double extent) {
  const Vec3 d = wall.point - point;
  if (wall.shape == Shape::sphere) return norm(d);
  const double along = dot(d, wall.axis), turn = norm(wall.axis - axis) * extent;
  return (wall.shape == Shape::plane ? std::abs(along) : norm(d - along * wall.axis)) + turn;
}

/// What a search has found in some of the particles.
struct Part {
  std::vector<int> near;
  double extent = 0.0, smallest = std::numeric_limits<double>::infinity(), largest = 0.0;
  Part& operator+=(const Part& other) {
    near.insert(near.end(), other.near.begin(), other.near.end());
    extent = std::max(extent, other.extent);
    smallest = std::min(smallest, other.smallest);
    largest = std::max(largest, other.largest);
    return *this;
  }
};

Part lookThrough(const Particles& particles, const PrimitiveWall& wall, double margin, const Vec3& period,
                 std::size_t begin, std::size_t end) {
  Part part;
  for (std::size_t i = begin; i < end; ++i) {
    const Vec3 x = particles.x[i] + shiftOf(imageNear(wall, particles.x[i], period), period);
    const double radius = particles.radius[i];
    if (!(distanceTo(wall, x).distance > radius + margin)) part.near.push_back(static_cast<int>(i));
    part.extent = std::max(part.extent, squaredNorm(x - wall.point));
    part.smallest = std::min(part.smallest, radius);
    part.largest = std::max(part.largest, radius);
  }
  return part;
}

void search(const Particles& particles, PrimitiveWall& wall, const Moves& moves,
            const geometry::Periodicity& periodicity) {
  PrimitiveSearch& s = wall.search;
  s.margin = requireNonNegative(wall.skin ? *wall.skin : defaultSkin(particles), "skin of a wall");
  const Vec3 period = periodsOf(periodicity);
  Part found = parallelSum(particles.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    return lookThrough(particles, wall, s.margin + wall.reach, period, begin, end);
  });
  requireRepeats(wall, periodicity, found.largest + s.margin);
  s.near = std::move(found.near);
  s.extent = std::sqrt(found.extent);
  s.smallestRadius = found.smallest;
  s.particleRevision = particles.revision;
  s.point = wall.point;
  s.axis = wall.axis;
  s.radius = wall.radius;
  s.travel.reset(moves);
  wall.contacts.period = period;
  ++s.builds;
}

/// Looks at every particle, if the wall has moved so far that it may have passed one since the last call.
void requireShortStep(const Particles& particles, const PrimitiveWall& wall) {
  const PrimitiveSearch& s = wall.search;
  if (s.particleRevision != particles.revision ||
      wallMove(wall, s.lastPoint, s.lastAxis, s.extent + s.margin) <= s.smallestRadius)
    return;
  PrimitiveWall before;
  before.shape = wall.shape;
  before.point = s.lastPoint;
  before.axis = s.lastAxis;
  before.radius = wall.radius;
  before.inside = wall.inside;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const Vec3 &x = particles.x[i], period = wall.contacts.period;
    const double radius = particles.radius[i];
    const double now = distanceTo(wall, x + shiftOf(imageNear(wall, x, period), period)).distance;
    const double then = distanceTo(before, x + shiftOf(imageNear(before, x, period), period)).distance;
    const double step = wallMove(wall, s.lastPoint, s.lastAxis, norm(x - wall.point));
    if (step > radius && std::min(now, then) < radius + (wall.shape == Shape::plane || wall.inside ? 0.0 : step))
      throw NumericalError("a wall has moved past it by more than its radius in one step",
                           "particle " + std::to_string(i), "take a smaller time step, or a slower wall");
  }
}

/// Contacts of near[begin … end − 1].
void touch(const Particles& particles, const PrimitiveWall& wall, std::size_t begin, std::size_t end,
           PrimitiveContacts& contacts) {
  const Vec3& period = wall.contacts.period;
  const bool repeats = squaredNorm(period) > 0.0;
  for (std::size_t k = begin; k < end; ++k) {
    const auto i = static_cast<std::size_t>(wall.search.near[k]);
    const Image image = repeats ? imageNear(wall, particles.x[i], period) : Image{};
    const auto [distance, normal] =
        distanceTo(wall, repeats ? particles.x[i] + shiftOf(image, period) : particles.x[i]);
    const double overlap = particles.radius[i] - distance;
    if (!(overlap > -wall.reach)) continue;
    contacts.particle.push_back(wall.search.near[k]);
    contacts.normal.push_back(normal);
    contacts.overlap.push_back(overlap);
    if (repeats) contacts.image.push_back(image);
  }
}

/// Puts the parts' contacts one part after the other.
void join(const std::vector<PrimitiveContacts>& parts, PrimitiveContacts& contacts) {
  std::vector<std::size_t> begin(parts.size() + 1, 0);
  for (std::size_t p = 0; p < parts.size(); ++p) begin[p + 1] = begin[p] + parts[p].size();
  contacts.particle.resize(begin.back());
  contacts.normal.resize(begin.back());
  contacts.overlap.resize(begin.back());
  contacts.image.resize(squaredNorm(contacts.period) > 0.0 ? begin.back() : 0);
  parallelFor(parts.size(), 1, [&](std::size_t p, std::size_t) {
    const auto at = static_cast<std::ptrdiff_t>(begin[p]);
    const auto copy = [&](const auto& from, auto& to) { std::copy(from.begin(), from.end(), to.begin() + at); };
    copy(parts[p].particle, contacts.particle);
    copy(parts[p].normal, contacts.normal);
    copy(parts[p].overlap, contacts.overlap);
    copy(parts[p].image, contacts.image);
  });
}

void touchAll(const Particles& particles, PrimitiveWall& wall) {
  constexpr std::size_t few = 512;
  const std::size_t count = wall.search.near.size();
  if (count <= few) {
    wall.contacts.particle.clear();
    wall.contacts.normal.clear();
    wall.contacts.overlap.clear();
    wall.contacts.image.clear();
    return touch(particles, wall, 0, count, wall.contacts);
  }
  std::vector<PrimitiveContacts> parts((count + few - 1) / few);
  parallelFor(count, few,
              [&](std::size_t begin, std::size_t end) { touch(particles, wall, begin, end, parts[begin / few]); });
  join(parts, wall.contacts);
}

}  // namespace

void requireRepeats(const PrimitiveWall& wall, const geometry::Periodicity& periodicity, double reach) {
  constexpr double square = 1e-9;
  for (int k = 0; k < 3; ++k) {
    if (!periodicity.axes[static_cast<std::size_t>(k)]) continue;
    const std::string along = std::string("period along ") + "xyz"[k];
    const double slope = wall.shape == Shape::sphere ? 0.0 : std::abs(wall.axis[k]);
    if (wall.shape == Shape::plane) {
      if (slope > square)
        throw InputError("its normal is not perpendicular to the " + along, "plane wall",
                         "a plane cannot lie across a period");
      continue;
    }
    if (slope > square && slope < 1.0 - square)
      throw InputError("its axis is oblique to the " + along, "cylinder wall",
                       "turn it along or perpendicular to the period");
    const double across = 2.0 * (wall.inside ? wall.radius : wall.radius + reach);
    if (slope <= square && across > periodicity.length(k) * (1.0 + square))
      throw InputError("it does not fit into the " + along, "cylinder or sphere wall",
                       "give a period of " + formatNumber(across) + " m or more");
  }
}

// Comparisons are written so that a NaN asks for a search.
void findContacts(const Particles& particles, PrimitiveWall& wall, const Moves& moves,
                  const geometry::Periodicity& periodicity) {
  if (!isFinite(wall.point) || !isFinite(wall.axis))
    throw NumericalError("its position is not finite", "primitive wall", "check its velocity and its motion");
  PrimitiveSearch& s = wall.search;
  if (s.builds > 0) requireShortStep(particles, wall);
  s.travel.add(moves);
  const double used =
      s.travel.bound + wallMove(wall, s.point, s.axis, s.extent + s.margin) + std::abs(wall.radius - s.radius);
  if (s.particleRevision != particles.revision || !(used <= s.margin) || s.margin == 0.0 ||
      wall.contacts.period != periodsOf(periodicity))
    search(particles, wall, moves, periodicity);
  s.lastPoint = wall.point;
  s.lastAxis = wall.axis;
  wall.contacts.oldParticle.swap(wall.contacts.particle);
  wall.contacts.oldMemory.swap(wall.contacts.memory);
  touchAll(particles, wall);
}

}  // namespace dovetail::dem
