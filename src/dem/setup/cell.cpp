#include "dovetail/dem/setup/cell.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "../model/events.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/pairs/contact_sample.hpp"
#include "dovetail/dem/setup/relax.hpp"

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

/// Lets each contact make the motion in one step of its own, alone with its two particles, so slowly that dashpots have
/// no say. Books the boundary's work, with the mean of the forces before and after, and what slides.
void strainContacts(Model& m, const Vec3& strain) {
  if (m.pairs.size() == 0) return;
  constexpr double noTime = 1e-100, dt = 0x1p40;  // s
  const int memory = m.laws->memory();
  forgetVelocities(m);
  detail::PairsApart apart(m.pairs.size());
  apart.take(m.particles, m.pairs, 0, memory);
  Particles& p = apart.particles;
  std::ranges::fill(p.v, Vec3{});
  std::ranges::fill(p.omega, Vec3{});
  m.laws->pairs(p, apart.list, noTime, Booking::off);
  const Vec3 middle{strain.x / (1.0 + 0.5 * strain.x), strain.y / (1.0 + 0.5 * strain.y),
                    strain.z / (1.0 + 0.5 * strain.z)};  // the rate halfway, as rve::deform has it
  std::vector<Vec3> change(m.pairs.size()), before(m.pairs.size());
  for (std::size_t k = 0; k < change.size(); ++k) {
    before[k] = p.f[2 * k];
    change[k] = scaled(strain, p.x[2 * k] - p.x[2 * k + 1]);
    p.x[2 * k] += change[k];
    p.v[2 * k] = (1.0 / dt) * scaled(middle, p.x[2 * k] - p.x[2 * k + 1]);
  }
  clearForces(p);
  const ContactWork work = m.laws->pairs(p, apart.list, dt, m.booking);
  if (memory > 0) {
    std::vector<std::size_t> places(m.pairs.size());
    std::iota(places.begin(), places.end(), std::size_t{0});
    m.pairs.takeMemory(places, apart.list);
    forgetVelocities(m);
  }
  if (m.booking == Booking::off) return;
  bookLosses(m, work, dt);
  m.work = {.elasticEnergy = work.elasticEnergy,
            .tangentialEnergy = work.tangentialEnergy,
            .rollingEnergy = work.rollingEnergy};
  for (std::size_t k = 0; k < change.size(); ++k) m.booked.external -= 0.5 * dot(before[k] + p.f[2 * k], change[k]);
}

}  // namespace

void strainCell(Model& m, const Vec3& strain) {
  check(m, strain);
  strainContacts(m, strain);
  geometry::Periodicity space = m.pairs.periodicity();
  const Vec3 corner = space.box.lower, stretch{1.0 + strain.x, 1.0 + strain.y, 1.0 + strain.z};
  for (Vec3& x : m.particles.x) x = corner + scaled(stretch, x - corner);
  space.box.upper = corner + scaled(stretch, space.box.upper - corner);
  m.pairs.setPeriodicity(space);
}

}  // namespace dovetail::dem
