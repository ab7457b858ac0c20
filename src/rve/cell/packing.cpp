#include "dovetail/rve/packing.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/rve/equilibrium.hpp"

namespace dovetail::rve {

namespace {

void check(const CloudOptions& settings) {
  dem::validate(settings.sizes);
  if (settings.count < 1)
    throw InputError("the number of grains is " + std::to_string(settings.count), "cloud of grains", "give 1 or more");
  requireFraction(settings.solidFraction, "the solid fraction", "cloud of grains");
  requirePositive(settings.thickness, "thickness of the discs");
}

/// Centres in the order of strips, two of the largest diameters high, along x.
void sortByPlace(std::vector<Vec3>& centre, double strip) {
  std::sort(centre.begin(), centre.end(), [&](const Vec3& a, const Vec3& b) {
    const double za = std::floor(a.z / strip), zb = std::floor(b.z / strip);
    const double ya = std::floor(a.y / strip), yb = std::floor(b.y / strip);
    return za != zb ? za < zb : (ya != yb ? ya < yb : a.x < b.x);
  });
}

}  // namespace

Rve relaxedCell(const Grains& grains, const geometry::Lattice& lattice, const Springs& springs) {
  Springs loose = springs;
  loose.friction = loose.rolling = 0.0;
  Rve cell = makeRve(grains, lattice, loose);
  relax(cell, {.tolerance = 1e-2, .steps = 2000});
  setSprings(cell, springs);
  cell.state.ledger = {};
  return cell;
}

Rve randomCell(const CloudOptions& settings, const Springs& springs) {
  check(settings);
  const bool disc = settings.shape == Shape::disc;
  dem::RandomStream random(settings.seed);
  Grains grains{.shape = settings.shape, .density = settings.density};
  double filled = 0.0, largest = 0.0;
  for (int i = 0; i < settings.count; ++i) {
    const double r = dem::drawRadius(settings.sizes, random);
    grains.radius.push_back(r);
    largest = std::max(largest, r);
    filled += std::numbers::pi * r * r * (disc ? 1.0 : 4.0 / 3.0 * r);
  }
  const double side = disc ? std::sqrt(filled / settings.solidFraction) : std::cbrt(filled / settings.solidFraction);
  for (int i = 0; i < settings.count; ++i) grains.centre.push_back(random.point({}, {side, side, disc ? 0.0 : side}));
  sortByPlace(grains.centre, 4.0 * largest);
  const geometry::Lattice lattice{{Vec3{side, 0, 0}, Vec3{0, side, 0}, Vec3{0, 0, disc ? settings.thickness : side}},
                                  {true, true, !disc}};
  return relaxedCell(grains, lattice, springs);
}

}  // namespace dovetail::rve
