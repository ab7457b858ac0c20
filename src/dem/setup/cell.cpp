#include "dovetail/dem/setup/cell.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/pairs/contact_sample.hpp"

namespace dovetail::dem {

namespace {

Vec3 scaled(const Vec3& a, const Vec3& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

void check(const Model& m, const Vec3& strain) {
  const geometry::Periodicity& space = m.pairs.periodicity();
  for (int k = 0; k < 3; ++k) {
    if (!(strain[k] > -1.0) || !std::isfinite(strain[k]))
      throw InputError("a strain is " + formatNumber(strain[k]), "periodic cell", "give a finite one above -1");
    if (strain[k] != 0.0 && !space.axes[static_cast<std::size_t>(k)])
      throw InputError(std::string("the cell is not periodic along ") + "xyz"[k], "periodic cell",
                       "strain it along periodic axes alone");
  }
  if (m.terms.begin() != m.terms.end())
    throw InputError("the model has more than particles and contacts", "periodic cell",
                     "leave out walls, bonds, clumps and other terms");
  if (!m.pairs.fits(m.particles) || m.forcesOf != m.particles.revision)
    throw InputError("forces have not been found yet", "periodic cell", "call findForces or relax first");
}

/// Lets each contact make the motion in one step of its own, alone with its two particles.
void strainMemories(Model& m, const Vec3& strain) {
  const int memory = m.laws->memory();
  if (memory == 0 || m.pairs.size() == 0) return;
  constexpr double dt = 1.0;  // s: rates are strains
  detail::PairsApart apart(m.pairs.size());
  apart.take(m.particles, m.pairs, 0, memory);
  Particles& p = apart.particles;
  for (std::size_t k = 0; k < p.size(); k += 2) {
    const Vec3 change = scaled(strain, p.x[k] - p.x[k + 1]);
    p.x[k] += change;
    p.v[k] = (1.0 / dt) * change;
    p.v[k + 1] = {};
  }
  std::fill(p.omega.begin(), p.omega.end(), Vec3{});
  m.laws->pairs(p, apart.list, dt, Booking::off);
  std::vector<std::size_t> places(m.pairs.size());
  std::iota(places.begin(), places.end(), std::size_t{0});
  m.pairs.takeMemory(places, apart.list);
}

}  // namespace

void strainCell(Model& m, const Vec3& strain) {
  check(m, strain);
  strainMemories(m, strain);
  geometry::Periodicity space = m.pairs.periodicity();
  const Vec3 corner = space.box.lower, stretch{1.0 + strain.x, 1.0 + strain.y, 1.0 + strain.z};
  for (Vec3& x : m.particles.x) x = corner + scaled(stretch, x - corner);
  space.box.upper = corner + scaled(stretch, space.box.upper - corner);
  m.pairs.setPeriodicity(space);
}

}  // namespace dovetail::dem
