#include "dovetail/dem/model/loads.hpp"

#include <algorithm>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/bodies/body_term.hpp"
#include "dovetail/dem/particles/damping.hpp"
#include "events.hpp"

namespace dovetail::dem {

namespace {
constexpr std::size_t chunkSize = 4096;
std::size_t at(int i) { return static_cast<std::size_t>(i); }
}  // namespace

// ---- bonds

void BondTerm::check(const Model& m) const {
  if (bonds.size() > 0) dem::check(bonds, m.particles);
}

namespace {
/// Members of bodies spin at the mean of the step while this lives, so that ends of bonds turn exactly as the bodies
/// did: by Cayley's rotation of the mean spin ω over dt, tan(θ/2) = ω dt/2.
class MembersTurn {
public:
  MembersTurn(Model& m, double dt) : m_(m) {
    if (!(dt > 0.0) || !m.particles.rotates()) return;
    for (const BodyTerm* term : m.terms.all<BodyTerm>())
      for (std::size_t k = 0; k < term->clumps.size(); ++k) {
        const std::size_t b = at(term->clumps.body[k]), i = at(term->clumps.particle[k]);
        if (kept_.empty()) kept_ = m.particles.omega;
        const Quaternion turn = term->bodies.orientation[b] * conjugate(term->bodies.turnedFrom[b]);
        m.particles.omega[i] = (2.0 / (dt * turn.w)) * Vec3{turn.x, turn.y, turn.z};
      }
  }
  ~MembersTurn() {
    if (!kept_.empty()) m_.particles.omega.swap(kept_);
  }
  MembersTurn(const MembersTurn&) = delete;
  MembersTurn& operator=(const MembersTurn&) = delete;

private:
  Model& m_;
  std::vector<Vec3> kept_;
};
}  // namespace

void BondTerm::neighbourListUpdated(Model& m) {
  if (mutesContacts) muteBonded(bonds, m.pairs);
}

double BondTerm::renumber(std::span<const int> newNumber, const Particles&) { return dem::renumber(bonds, newNumber); }

void BondTerm::addForces(Model& m, const Step& step) {
  lost_ = 0.0;
  if (bonds.size() == 0) return;
  const double dt = step.timeless ? 0.0 : step.dt;
  ContactWork work = [&] {
    const MembersTurn turned(m, dt);
    return exchangeBonds(m.particles, bonds, m.pairs.periodicity(), dt);
  }();
  // The last force of a bond that breaks is that of the step before, which acted half of the way: there it broke.
  work.fracturePower += 0.5 * bonds.powerOfBroken;
  lost_ = work.dissipatedPower;
  m.work += work;
  if (mutesContacts && !bonds.broken.empty()) wake(m, step);
}

namespace {
/// Power of the forces on the particles of a list, W.
double powerOn(const Particles& p, const PairList& list) {
  std::vector<int> members;
  for (const auto& pair : list.pairs()) members.insert(members.end(), pair.begin(), pair.end());
  std::sort(members.begin(), members.end());
  members.erase(std::unique(members.begin(), members.end()), members.end());
  double power = 0.0;
  for (const int i : members) {
    power += dot(p.f[at(i)], p.v[at(i)]);
    if (p.rotates()) power += dot(p.torque[at(i)], p.omega[at(i)]);
  }
  return power;
}
}  // namespace

/// The contacts under bonds that have just broken, in a list of their own. They start without memory, as if half a
/// step ago; what they stored then, and their dents, were not there before, so that the break loses so much less.
void BondTerm::wake(Model& m, const Step& step) {
  PairList& list = m.pairs;
  std::vector<std::size_t> places;
  for (const auto& pair : bonds.broken) {
    const auto place = list.find(pair);
    if (!place || list.factors().empty()) continue;
    places.push_back(*place);
    list.writeFactors()[*place] = 0.5 * (m.particles.weightOf(at(pair[0])) + m.particles.weightOf(at(pair[1])));
  }
  if (places.empty()) return;
  std::sort(places.begin(), places.end());
  for (const auto& term : m.terms) term->neighbourListUpdated(m);  // whoever else mutes them
  PairList awake = selectPairs(m.particles, list, places);
  const double before = powerOn(m.particles, awake);
  ContactWork work = m.laws->pairs(m.particles, awake, step.dt, m.booking);
  if (m.booking == Booking::on)
    work.fracturePower -= work.storedEnergy() / step.dt + work.plasticPower +
                          0.5 * (powerOn(m.particles, awake) - before + work.dissipatedPower);
  m.work += work;
  list.takeMemory(places, awake);
}

/// Dashpots take what their forces do to the particles over the whole kick.
void BondTerm::book(Model& m, const Step& step) {
  if (lost_ == 0.0 || m.booking == Booking::off) return;
  const MeanMotion mean = dem::meanMotion(m, step);
  const MembersTurn turned(m, step.timeless ? 0.0 : step.dt);
  m.rate.lost.dissipatedPower += dashpotPower(m.particles, bonds, m.pairs.periodicity(), mean.v, mean.omega) - lost_;
}

void BondTerm::addDemand(const Model& m, ContactDemand& demand) const { dem::addDemand(demand, m.particles, bonds); }

void BondTerm::save(ByteWriter& writer) const { writer(bonds.bonds, bonds.energy, bonds.brokenSoFar, mutesContacts); }
void BondTerm::load(ByteReader& reader) { reader(bonds.bonds, bonds.energy, bonds.brokenSoFar, mutesContacts); }

Bonds& bonds(Model& m) {
  const auto found = m.terms.all<BondTerm>();
  return found.empty() ? m.terms.add(BondTerm{}).bonds : found.front()->bonds;
}

// ---- damping

void DampingTerm::check(const Model&) const {
  if (!(viscousRate >= 0.0 && std::isfinite(viscousRate)))
    throw InputError("the damping rate is " + formatNumber(viscousRate), "viscous damping",
                     "give a finite rate ≥ 0, 1/s");
  if (!(local >= 0.0 && local < 1.0))
    throw InputError("the local damping is " + formatNumber(local), "local damping", "give 0 ≤ α < 1, such as 0.7");
}

/// Bodies damp themselves (BodyTerm), once for all their members.
void DampingTerm::addForces(Model& m, const Step&) {
  if (viscousRate != 0.0) applyViscousDamping(m.particles, viscousRate);
  if (local != 0.0) applyLocalDamping(m.particles, local);
}

/// Against the means of the velocities before and after the kick.
void DampingTerm::book(Model& m, const Step& step) {
  const Particles& p = m.particles;
  const MeanMotion mean = dem::meanMotion(m, step);
  m.rate.damping -= parallelSum(p.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    double power = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
      if (p.isMember(i)) continue;
      const Momenta force = forceOn(p, i);
      power += dot(force.linear, mean.v[i]);
      if (p.rotates()) power += dot(force.angular, mean.omega[i]);
    }
    return power;
  });
}

/// What it has added to the force and torque on a particle, N, N m.
Momenta DampingTerm::forceOn(const Particles& p, std::size_t i) const {
  const double weight = p.weightOf(i);
  Momenta force{dampingForce(p.f[i], weight * p.mass[i] * p.v[i], p.v[i], viscousRate, local), {}};
  if (p.rotates()) {
    const double inertia = weight * momentOfInertia(p, static_cast<int>(i));
    force.angular = dampingForce(p.torque[i], inertia * p.omega[i], p.omega[i], viscousRate, local);
  }
  return force;
}

void DampingTerm::addOutside(const Model& m, Momenta& force, Momenta&) const {
  const Particles& p = m.particles;
  force += parallelSum(p.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    Momenta sum;
    for (std::size_t i = begin; i < end; ++i) {
      if (p.isMember(i)) continue;
      const Momenta own = forceOn(p, i);
      sum.add(p.x[i], own.linear);
      sum.angular += own.angular;
    }
    return sum;
  });
}

DampingTerm& damping(Model& m) {
  const auto found = m.terms.all<DampingTerm>();
  return found.empty() ? m.terms.add(DampingTerm{}) : *found.front();
}

// ---- external forces

void ExternalForceTerm::check(const Model&) const {
  if (!function_) throw InputError("there is no function", "external force " + name_, "give one that adds the forces");
}

void ExternalForceTerm::addForces(Model& m, const Step& step) {
  force_.assign(m.particles.size(), Vec3{});
  function_(m.particles, step.time, force_);
  parallelFor(m.particles.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!isFinite(force_[i]))
        throw NumericalError("the external force '" + name_ + "' on it is not finite, " + when(m),
                             "particle " + std::to_string(m.particles.id[i]), "check its function");
      m.particles.f[i] += force_[i];
    }
  });
}

/// Over the kick that these forces are part of, with the mean of the velocities before and after it.
void ExternalForceTerm::book(Model& m, const Step& step) {
  const MeanMotion mean = dem::meanMotion(m, step, false);
  m.rate.external += parallelSum(force_.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    double power = 0.0;
    for (std::size_t i = begin; i < end; ++i) power += dot(force_[i], mean.v[i]);
    return power;
  });
}

void ExternalForceTerm::addOutside(const Model& m, Momenta& force, Momenta&) const {
  force += parallelSum(force_.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    Momenta sum;
    for (std::size_t i = begin; i < end; ++i) sum.add(m.particles.x[i], force_[i]);
    return sum;
  });
}

}  // namespace dovetail::dem
