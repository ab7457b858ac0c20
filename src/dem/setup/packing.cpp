#include "dovetail/dem/setup/packing.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/setup/pressure_secant.hpp"
#include "relaxation.hpp"
#include "room_surface.hpp"

namespace dovetail::dem {

namespace {

double sphereVolume(double radius) { return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius; }

void checkSpace(const geometry::Periodicity& space) {
  for (int k = 0; k < 3; ++k) {
    if (!std::isfinite(space.box.lower[k])) throw InputError("the box is not finite", "packing", "give finite corners");
    requirePositive(space.length(k), "length of the box");
  }
}

/// Whether the box, shrunk by the factor, still is wide enough. Along a periodic axis two spheres must not meet through
/// two images.
bool fits(double factor, double diameter, const geometry::Periodicity& space) {
  for (int k = 0; k < 3; ++k)
    if ((space.axes[static_cast<std::size_t>(k)] ? 2.0 : 1.0) * diameter > factor * space.length(k)) return false;
  return true;
}

void checkFit(double diameter, const geometry::Periodicity& space) {
  if (fits(1.0, diameter, space)) return;
  throw InputError("a sphere of diameter " + formatNumber(diameter) + " m does not fit into the box", "packing",
                   "make the box larger (along a periodic axis, two diameters), or the spheres smaller");
}

std::vector<double> drawRadii(const Sizes& sizes, std::int64_t number, RandomStream& random) {
  std::vector<double> radius;
  for (std::int64_t k = 0; k < number; ++k) radius.push_back(drawRadius(sizes, random));
  return radius;
}
std::vector<double> drawRadii(const Sizes& sizes, double volume, RandomStream& random) {
  std::vector<double> radius;
  double filled = 0.0;
  while (filled < volume) {
    radius.push_back(drawRadius(sizes, random));
    filled += sphereVolume(radius.back());
  }
  if (filled - volume > 0.5 * sphereVolume(radius.back()) && radius.size() > 1) radius.pop_back();
  return radius;
}

void fillReport(Packing& packing, PackingReport& report) {
  const Relaxation state(packing);
  const Overlaps overlaps = state.measure(1e-6);
  report.solidFraction = solidFraction(packing);
  report.largestOverlap = overlaps.largest;
  report.unbalanced = state.unbalanced(overlaps);
  report.coordination = static_cast<double>(overlaps.held) / static_cast<double>(packing.centre.size());
}

void wrap(Packing& packing) {
  for (Vec3& x : packing.centre)
    for (int k = 0; k < 3; ++k)
      if (packing.space.axes[static_cast<std::size_t>(k)])
        x[k] -= packing.space.length(k) * std::floor((x[k] - packing.space.box.lower[k]) / packing.space.length(k));
}

void check(const GrowthOptions& settings) {
  if (!(settings.solidFraction > 0.0 && settings.solidFraction < 0.74))
    throw InputError("the solid fraction is " + formatNumber(settings.solidFraction), "packing",
                     "give one above 0 and below 0.74");
  if (settings.number < 0)
    throw InputError("the number of spheres is " + std::to_string(settings.number), "packing", "give 0 or more");
  if (!(settings.overlap > 0.0 && settings.overlap <= 0.1))
    throw InputError("the overlap is " + formatNumber(settings.overlap), "packing", "give one in (0, 0.1]");
}

/// Grows the radii towards those wanted; a state that balances with overlaps left is jammed, and growth goes on from
/// the last good state by a smaller bit. Returns the fraction of the radii reached.
double grow(Packing& packing, const std::vector<double>& wanted, const GrowthOptions& settings,
            std::int64_t& iterations) {
  const double solidFraction = settings.number > 0 ? volumeOf(wanted) / packing.volume() : settings.solidFraction;
  constexpr std::int64_t patience = 4000;
  const auto setScale = [&](double scale) {
    packing.radius = wanted;
    for (double& r : packing.radius) r *= scale;
  };
  double scale = std::cbrt(std::min(1.0, 0.2 / solidFraction)), goodScale = 0.0;
  std::vector<Vec3> good = packing.centre;
  setScale(scale);
  Relaxation relaxation(packing);
  for (double growth = 0.03; growth > 1e-4 && iterations < settings.iterations;) {
    iterations += relaxation.run(settings.overlap, 1e-4, std::min(patience, settings.iterations - iterations));
    if (relaxation.measure().largest <= settings.overlap) {
      good = packing.centre;
      goodScale = scale;
      if (scale == 1.0) break;
    } else {
      growth *= 0.5;
      if (goodScale > 0.0) packing.centre = good;
    }
    scale = goodScale > 0.0 ? std::min(1.0, goodScale * (1.0 + growth)) : 0.9 * scale;
    setScale(scale);
    relaxation.take();
  }
  packing.centre = good;
  if (goodScale > 0.0) scale = goodScale;
  setScale(scale);
  return scale;
}

}  // namespace

namespace {

bool isInside(const PackingRoom& room, const RoomSurface& surface, const Vec3& x) {
  return std::ranges::all_of(room.walls, [&](const PrimitiveWall& one) { return distanceTo(one, x).distance > 0.0; }) &&
         (surface.isEmpty() || surface.isInside(x));
}

/// Points at random.
void placeIn(Packing& packing, std::size_t count, RandomStream& random) {
  const RoomSurface surface(packing.room.surface);
  const double box = packing.space.length(0) * packing.space.length(1) * packing.space.length(2);
  const double most = 100.0 * (1.0 + static_cast<double>(count)) * box / packing.volume();
  for (double tries = 0.0; packing.centre.size() < count; ++tries) {
    if (tries > most)
      throw InputError("no place is found inside the surface", "packing", "check that its normals point outwards");
    const Vec3 x = random.point(packing.space.box.lower, packing.space.box.upper);
    if (isInside(packing.room, surface, x)) packing.centre.push_back(x);
  }
}

bool areInside(const Packing& packing) {
  const RoomSurface surface(packing.room.surface);
  return std::ranges::all_of(packing.centre, [&](const Vec3& x) { return isInside(packing.room, surface, x); });
}

}  // namespace

double volumeOf(std::span<const double> radius) {
  double sum = 0.0;
  for (const double r : radius) sum += sphereVolume(r);
  return sum;
}

double solidFraction(const Packing& packing) { return volumeOf(packing.radius) / packing.volume(); }

int addPacking(Particles& particles, const Packing& packing, Density density, const Vec3& velocity) {
  const int first = static_cast<int>(particles.size());
  for (std::size_t i = 0; i < packing.centre.size(); ++i)
    addParticle(particles, packing.centre[i], velocity, packing.radius[i], density);
  return first;
}

Packing growPacking(const Sizes& sizes, const geometry::Periodicity& space, const GrowthOptions& settings,
                    PackingReport& report) {
  validate(sizes);
  checkSpace(space);
  check(settings);
  RandomStream random(settings.seed);
  Packing packing{{}, {}, space, settings.room};
  const std::vector<double> wanted = settings.number > 0
                                         ? drawRadii(sizes, settings.number, random)
                                         : drawRadii(sizes, settings.solidFraction * packing.volume(), random);
  checkFit(2.0 * *std::max_element(wanted.begin(), wanted.end()), space);
  placeIn(packing, wanted.size(), random);
  report = {};
  report.scale = grow(packing, wanted, settings, report.iterations);
  wrap(packing);
  fillReport(packing, report);
  report.reached = report.scale == 1.0 && report.largestOverlap <= settings.overlap && areInside(packing);
  return packing;
}

PackingReport compressToPressure(Packing& packing, const CompressionOptions& settings) {
  checkSpace(packing.space);
  requirePositive(settings.stiffness, "stiffness of the contacts");
  requirePositive(settings.pressure, "pressure");
  requirePositive(settings.tolerance, "tolerance of the pressure");
  if (packing.centre.empty() || packing.centre.size() != packing.radius.size())
    throw InputError("the packing has " + std::to_string(packing.centre.size()) + " centres and " +
                         std::to_string(packing.radius.size()) + " radii",
                     "packing", "give one of each per sphere, and at least one");
  const double widest = 2.0 * *std::max_element(packing.radius.begin(), packing.radius.end());
  checkFit(widest, packing.space);
  PackingReport report;
  Relaxation relaxation(packing);
  // The guess for a packing that does not press yet is that it is as stiff as it will be when it does.
  PressureSecant secant(settings.pressure, 0.02, 0.2 * settings.stiffness / meanRadius(packing));
  const double negligible = 1e-3 * settings.pressure * meanRadius(packing) / settings.stiffness;
  const auto relaxed = [&](double balance) {
    report.iterations +=
        relaxation.run(negligible, balance, std::min<std::int64_t>(5000, settings.iterations - report.iterations));
    return settings.stiffness * relaxation.measure().virial / (3.0 * packing.volume());
  };
  while (report.iterations < settings.iterations) {
    report.pressure = relaxed(1e-2);
    // Far from the pressure wanted, rest is not waited for.
    if (std::abs(settings.pressure - report.pressure) < 0.5 * settings.pressure) report.pressure = relaxed(1e-4);
    report.reached = std::abs(settings.pressure - report.pressure) <= settings.tolerance * settings.pressure;
    if (report.reached) break;
    const double factor = std::cbrt(1.0 - secant.next(report.pressure));
    if (!fits(factor, widest, packing.space)) break;
    const Vec3 corner = packing.space.box.lower;
    packing.space.box.upper = corner + factor * (packing.space.box.upper - corner);
    for (Vec3& x : packing.centre) x = corner + factor * (x - corner);
    relaxation.take();
  }
  const double reachedPressure = report.pressure;
  wrap(packing);
  fillReport(packing, report);
  report.pressure = reachedPressure;
  return report;
}

}  // namespace dovetail::dem
