// What a model holds, what it can bear.
#include <algorithm>

#include "../particles/four_moves.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/core/vector_code.hpp"
#include "dovetail/dem/bodies/body_term.hpp"
#include "dovetail/dem/model/impact.hpp"
#include "dovetail/dem/model/model.hpp"
#include "events.hpp"

namespace dovetail::dem {

namespace {

constexpr std::size_t chunkSize = 4096;

void requireClosed(const Model& m, const char* what) {
  if (m.open > 0.0)
    throw InputError("velocities lag behind positions by half a step", what, "call close(model) first, as run does");
}

}  // namespace

void requireFiniteGravity(const Model& m) {
  if (!isFinite(m.gravity)) throw InputError("not a finite vector", "gravity", "give three finite numbers");
}

void requireLaws(const Model& m) {
  if (!m.laws)
    throw InputError("the model has no contact laws", "Model::laws", "set model.laws = makeContactLaws(law)");
}

void check(const Model& m) {
  validate(m.particles);
  requireFiniteGravity(m);
  if (m.particles.size() > 0) requireLaws(m);
  if (m.laws && m.laws->materials() > 1)
    for (std::size_t i = 0; i < m.particles.material.size(); ++i)
      if (m.particles.material[i] >= m.laws->materials())
        throw InputError("there is no law for material " + std::to_string(m.particles.material[i]),
                         "particle " + std::to_string(m.particles.id[i]) + ", material",
                         "make the table of laws as large as the materials require");
  if (m.sortEvery < 0)
    throw InputError("sortEvery is " + std::to_string(m.sortEvery), "Model::sortEvery", "give 0 (never) or more");
  for (const auto& term : m.terms) term->check(m);
}

ContactStep criticalStep(const Model& m, double leastOverlap) {
  if (leastOverlap > 0.0 && !m.pairs.fits(m.particles) && m.particles.size() > 0) {
    Model now = m;
    findForces(now);  // for its list of pairs
    return criticalStep(now, leastOverlap);
  }
  return criticalStep(demandOf(m, leastOverlap), m.particles);
}

ContactDemand demandOf(const Model& m, double leastOverlap) {
  ContactDemand demand;
  if (m.laws) m.laws->addDemand(demand, m.particles, m.pairs, leastOverlap);
  for (const auto& term : m.terms) term->addDemand(m, demand);
  return demand;
}

void requireStableStep(const Model& m, double dt, double leastOverlap) {
  const ContactDemand demand = demandOf(m, leastOverlap);
  StepLimit limit = criticalStep(demand, m.particles);
  limit.lower(impactLimit(m, demand));
  if (dt <= limit.dt) return;
  throw InputError("dt = " + formatNumber(dt) + " s exceeds the critical step of " + formatNumber(limit.dt) +
                       " s, set by " + limit.owner,
                   "time step",
                   "take a fifth of the limit or less, softer contacts, or scaleMasses for quasi-static scenes");
}

bool looksAtLimit(std::int64_t step) { return step == 32 || step == 128 || step == 512 || step % 2048 == 0; }

void lookAtLimit(Model& m) {
  if (m.passed) return;
  const StepLimit limit = criticalStep(m);
  if (m.step.dt > limit.dt) m.passed = {m.step.dt, limit, m.time};
}

void reportOfLimit(const Model& m, const NumericalError& error) {
  if (!m.passed) return;
  const auto& [dt, limit, time] = *m.passed;
  throw NumericalError(std::string(error.what()) + "; its step, " + formatNumber(dt) +
                           " s, exceeds the critical step of " + formatNumber(limit.dt) + " s, set by " + limit.owner +
                           ", at t = " + formatNumber(time) + " s",
                       "", "");
}

Energies energies(const Model& m) {
  requireClosed(m, "energies");
  if (!hasForces(m) && m.particles.size() > 0) {  // nobody has asked for forces yet
    Model now = m;
    findForces(now);
    return energies(now);
  }
  Energies e = m.booked;
  e.kinetic = kineticEnergy(m.particles);
  e.gravity = parallelSum(m.particles.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    double sum = 0.0;
    for (std::size_t i = begin; i < end; ++i) sum += gravityOf(m.particles, i, m.gravity);
    return sum;
  });
  e.contacts = m.work.storedEnergy();
  for (const auto& term : m.terms) term->addEnergies(m, e);
  return e;
}

Momenta momenta(const Model& m) {
  requireClosed(m, "momenta");
  Momenta sums{momentum(m.particles), angularMomentum(m.particles)};
  for (const auto& term : m.terms) term->addMomenta(m, sums);
  return sums;
}

Momenta weight(const Model& m) {
  if (m.gravity == Vec3{}) return {};
  const Particles& p = m.particles;
  Momenta sum = parallelSum(p.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    detail::MassMoments sums;
    std::size_t i = begin;
    if (p.owner.empty())
      withVectors([&, end] {
        detail::MassMoments fours;
        for (; i + 4 <= end; i += 4) fours.addFour(p, i);
        sums = fours;
      });
    for (; i < end; ++i)
      if (!p.isMember(i)) sums.add(p.weightOf(i) * p.mass[i], p.x[i]);
    return Momenta{sums.mass() * m.gravity, cross(sums.moment(), m.gravity)};
  });
  for (const BodyTerm* term : m.terms.all<BodyTerm>())
    for (std::size_t b = 0; b < term->bodies.size(); ++b) sum.add(term->bodies.x[b], term->bodies.mass[b] * m.gravity);
  return sum;
}

void Terms::insert(std::unique_ptr<Term> term) {
  auto place = terms_.begin();
  while (place != terms_.end() && (*place)->order() <= term->order()) ++place;
  terms_.insert(place, std::move(term));
  ++revision_;
}

void Terms::remove(const Term& term) {
  if (std::erase_if(terms_, [&](const auto& owned) { return owned.get() == &term; }) > 0) ++revision_;
}

}  // namespace dovetail::dem
