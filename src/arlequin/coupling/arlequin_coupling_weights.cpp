// Weights that change: mass, momentum and energy change hands, gaps and contacts go on.
#include <algorithm>
#include <limits>
#include <utility>

#include "arlequin_coupling_impl.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/dem/pairs/contact_sample.hpp"

namespace dovetail::arlequin {

namespace {

double ownKinetic(const dem::Particles& p, std::size_t i) {
  double energy = p.mass[i] * squaredNorm(p.v[i]);
  if (p.rotates()) energy += dem::momentOfInertia(p, static_cast<int>(i)) * squaredNorm(p.omega[i]);
  return 0.5 * energy;
}

}  // namespace

ContactsOf::ContactsOf(const dem::Model& m, std::span<const char> isMoved, const fem::Model* solid) {
  if (!m.laws || m.pairs.particles() != m.particles.size()) return;
  for (std::size_t p = 0; p < m.pairs.size(); ++p)
    if (const auto& [i, j] = m.pairs.pairs()[p];
        isMoved[static_cast<std::size_t>(i)] || isMoved[static_cast<std::size_t>(j)])
      pairs_.push_back(p);
  const auto touches = [&](const dem::Term& term) {
    dem::ContactSample contacts;
    term.addContacts(m, contacts);
    return std::ranges::any_of(contacts.first, [&](int i) { return isMoved[static_cast<std::size_t>(i)] != 0; });
  };
  bool meetsSolids = false;
  std::vector<const dem::Term*> surfaces;
  for (const auto& term : m.terms)
    if (const auto* const connector = dynamic_cast<const coupling::Connector*>(term.get())) {
      // Overlaps are large, and are not asked; the solid's own surface meets no members.
      if (connector->side().model == solid || dynamic_cast<const ArlequinCoupling*>(connector)) continue;
      surfaces.push_back(connector);
      meetsSolids = meetsSolids || touches(*connector);
    } else if (dynamic_cast<const dem::BondTerm*>(term.get()) || touches(*term)) {
      terms_.push_back(term.get());
    }
  if (meetsSolids) terms_.insert(terms_.end(), surfaces.begin(), surfaces.end());  // those of one solid act together
}

double ContactsOf::energy(const dem::Model& m) const {
  constexpr double noTime = 1e-100;  // s: memories stay
  // Springs that friction no longer holds are cut in the step to come, which books what they lose.
  const auto held = [](const dem::ContactWork& work) {
    return work.storedEnergy() + noTime * (work.lostPower() - work.dissipatedPower);
  };
  double sum = 0.0;
  if (!pairs_.empty()) {
    const int memory = static_cast<int>(m.pairs.memory().size() / m.pairs.size());
    dem::detail::PairsApart one(1);
    for (const std::size_t p : pairs_) {
      one.take(m.particles, m.pairs, p, memory);
      sum += held(m.laws->pairs(one.particles, one.list, noTime, dem::Booking::on));
    }
  }
  if (terms_.empty()) return sum;
  dem::Model copy;
  copy.particles = m.particles;
  copy.laws = m.laws;
  copy.pairs.setPeriodicity(m.pairs.periodicity());
  copy.step = {.time = m.time, .dt = noTime, .moved = std::numeric_limits<double>::infinity(), .timeless = true};
  for (const dem::Term* term : terms_) copy.terms.add(term->clone());
  dem::addForcesOfTerms(copy);
  return sum + held(copy.work);
}

/// Mass that a weight gains or loses comes and goes with the solid's velocity; the rest of its momentum is the nodes'.
/// Its spin goes too, and the moment of that momentum about where the nodes take it.
void ArlequinCoupling::Impl::handOver(dem::Model& m, const OverlapUpdate::Change& change, std::vector<Vec3>& impulse) {
  const auto i = static_cast<std::size_t>(change.particle);
  const double weight = change.before - change.after, mass = weight * m.particles.mass[i];
  if (mass == 0.0) return;
  const fem::CellPlace& place = change.place;
  const Cell cell = cellOf(setting.mesh, place.element);
  const Vec3 u = atPlace(place, nodes().v);
  Vec3 angular = cross(m.particles.x[i], mass * m.particles.v[i]);
  if (m.particles.rotates())
    angular += (weight * dem::momentOfInertia(m.particles, static_cast<int>(i))) * m.particles.omega[i];
  for (std::size_t a = 0; a < cell.node.size(); ++a) {
    const auto n = static_cast<std::size_t>(cell.node[a]);
    const Vec3 taken = (place.shape[a] * mass) * (m.particles.v[i] - u);
    impulse[n] += taken;
    angular -= cross(nodes().X[n] + nodes().u[n], taken);
  }
  const double energy = weight * ownKinetic(m.particles, i) - mass * dot(m.gravity, m.particles.x[i]);
  const bool leaves = mass > 0.0;
  dem::Exchanged& exchanged = leaves ? m.left : m.entered;
  const double sign = leaves ? 1.0 : -1.0;
  exchanged.mass += sign * mass;
  exchanged.momentum += (sign * mass) * u;
  exchanged.angularMomentum += sign * angular;
  (leaves ? m.booked.left : m.booked.entered) += sign * energy;
  m.particles.f[i] -= mass * m.gravity;  // all that it holds before forces are asked for
  m.particles.weight[i] = change.after;
}

void ArlequinCoupling::Impl::kickNodes(std::span<const Vec3> impulse) {
  if (loadsNobody) return;
  const std::vector<Vec3> change = side.kick(impulse);
  for (std::size_t n = 0; n < change.size(); ++n) lost -= dot(impulse[n], nodes().v[n] - 0.5 * change[n]);
}

/// Whatever the ties are now, λ is what it was: those who come in are tied where they are, without a gap of their own,
/// and make that of their rows shorter as they make these stiffer.
void ArlequinCoupling::Impl::keepForces(const dem::Model& m) {
  now = gapUnder(lambda);
  keepGap(m);
}

/// Whatever the ties are now, the gap of the rows is what it was: those who are gone take their part of λ along.
void ArlequinCoupling::Impl::keepGap(const dem::Model& m) {
  const std::vector<Vec3> fresh = freshGap(m);
  for (std::size_t r = 0; r < fresh.size(); ++r) kept[r] = now[r] - fresh[r];
}

/// Where all particles have been located anew, none has moved from its material point: there is no gap, whose part from
/// old ties would not turn with the solid. Increments go on from what they were.
void ArlequinCoupling::Impl::startGapAnew(const dem::Model& m) {
  const std::vector<Vec3> before = std::exchange(now, freshGap(m));
  for (std::size_t r = 0; r < now.size(); ++r) {
    kept[r] = {};
    atMacroStep[r] += now[r] - before[r];
  }
}

void ArlequinCoupling::Impl::weighPairs(dem::Model& m, std::span<const char> isMoved) {
  weights.forget(isMoved);
  const std::span<double> factors = m.pairs.writeFactors();
  for (std::size_t p = 0; p < m.pairs.size(); ++p) {
    const auto i = static_cast<std::size_t>(m.pairs.pairs()[p][0]), j = static_cast<std::size_t>(m.pairs.pairs()[p][1]);
    if ((isMoved[i] || isMoved[j]) && factors[p] != 0.0)
      factors[p] = 0.5 * (m.particles.weightOf(i) + m.particles.weightOf(j));
  }
  weights.update(m.particles, m.pairs, setting.mesh, overlap, positions(), memberOf);
}

}  // namespace dovetail::arlequin
