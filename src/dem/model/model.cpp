#include "dovetail/dem/model/model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "dovetail/core/finite.hpp"
#include "dovetail/dem/bodies/body_term.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/dem/walls/wall_seams.hpp"
#include "events.hpp"

namespace dovetail::dem {

namespace {

/// Times a stage, if anybody asks.
template <class Work>
void timed(const Model& m, const char* stage, Work&& work) {
  if (!m.profile) return work();
  const Profile::Stage timer(*m.profile, stage);
  work();
}
template <class Work>
void timed(const Model& m, const Term& term, Work&& work) {
  if (!m.profile) return work();
  timed(m, term.name().c_str(), work);
}

bool prescribed(const Model& m) {
  return std::any_of(m.terms.begin(), m.terms.end(), [](const auto& term) { return term->prescribes(); });
}

void prescribe(Model& m, const Step& step, Half half) {
  for (const auto& term : m.terms)
    if (term->prescribes()) term->prescribe(m, step, half);
}

/// A step that begins now.
Step begin(Model& m, double dt) {
  requirePositive(dt, "time step");
  if (dt != m.step.dt || m.steps == 0) {
    m.timeBase = m.time;
    m.stepsBase = m.steps;
  }
  ++m.steps;
  m.time = m.timeBase + static_cast<double>(m.steps - m.stepsBase) * dt;
  return {.time = m.time, .dt = dt, .number = m.steps, .closing = m.open};
}

/// Kicks and drift of the particles; the largest displacement, m.
double sweep(Model& m, const Step& step) {
  if (prescribed(m)) {
    if (step.closing > 0.0) {
      kick(m.particles, 0.5 * step.closing);
      prescribe(m, m.step, Half::second);
    }
    kick(m.particles, 0.5 * step.dt);
    prescribe(m, step, Half::first);
    const double moved = step.dt * largestSpeed(m.particles);
    if (!std::isfinite(moved)) return moved;
    drift(m.particles, step.dt);
    startForces(m.particles, m.gravity);
    return moved;
  }
  if (step.closing == step.dt) return turnStep(m.particles, step.dt, m.gravity);
  if (step.closing > 0.0) kick(m.particles, 0.5 * step.closing);
  return startStep(m.particles, step.dt, m.gravity);
}

void moveTerms(Model& m, Step& step) {
  for (const auto& term : m.terms) step.moved += term->move(m, step);
}

/// Half a kick's worth of the powers, J.
void bookHalf(Model& m, double dt) {
  m.booked.lost.dissipatedPower += 0.5 * dt * m.rate.lost.dissipatedPower;
  m.booked.damping += 0.5 * dt * m.rate.damping;
  m.booked.walls += 0.5 * dt * m.rate.walls;
  m.booked.external += 0.5 * dt * m.rate.external;
}

void setOwners(Model& m) {
  m.particles.owner.clear();
  for (const auto& term : m.terms) term->own(m.particles);
  for (DriveTerm* term : m.terms.all<DriveTerm>())
    for (const int i : term->numbers(m.particles)) setOwner(m.particles, i, Owner::drive);
}

/// What somebody has changed between steps: the step before ends, and who has come in counts as entered.
void takeIn(Model& m, bool first) {
  if (m.open > 0.0) {
    validate(m.particles);
    close(m);
  }
  if (m.rotation == Rotation::automatic && m.laws && m.laws->rotates()) switchOnRotation(m.particles);
  check(m);
  m.smallestRadius = smallestRadius(m.particles);
  setOwners(m);
  for (BodyTerm* term : m.terms.all<BodyTerm>()) term->takeIn(m, first);
  if (first || m.knownIds == m.particles.nextId) return;
  for (std::size_t i = 0; i < m.particles.size(); ++i)
    if (m.particles.id[i] >= m.knownIds && !m.particles.isMember(i) &&
        !std::ranges::binary_search(m.newcomers, m.particles.id[i]))  // admitParticles has booked them
      m.booked.entered += bookParticle(m, i, m.entered);
}

/// J that contacts of some particles store.
double storedBy(const Model& m, std::span<const int> particles) {
  Model without = m;
  removeParticles(without, particles);
  return m.work.elasticEnergy - without.work.elasticEnergy;
}

/// The step's last half kick is not for those who came in at its end: it will be taken back from what they have.
void welcome(Model& m) {
  for (BodyTerm* term : m.terms.all<BodyTerm>()) term->welcome(m.step);
  std::vector<int> newcomers;
  for (const std::int64_t id : m.newcomers) {
    const int number = find(m.particles, id);
    if (number < 0) continue;  // gone again
    newcomers.push_back(number);
    if (m.particles.isMember(static_cast<std::size_t>(number))) continue;  // its body's affair
    const auto i = static_cast<std::size_t>(number);
    const double half = 0.5 * m.step.dt / m.particles.weightOf(i);
    m.particles.v[i] -= (half / m.particles.mass[i]) * m.particles.f[i];
    if (m.particles.rotates())
      m.particles.omega[i] -= (half / momentOfInertia(m.particles, static_cast<int>(i))) * m.particles.torque[i];
  }
  m.newcomers.clear();
  if (std::exchange(m.newcomersTouch, false) && m.booking == Booking::on) m.booked.entered += storedBy(m, newcomers);
}

/// Everything that must be right before particles move: once at the start, and when somebody has added or taken out
/// particles or terms, or exchanged laws, between steps. The step before ends with the forces that it had.
void prepare(Model& m, double dt) {
  const bool changed = !hasForces(m);
  if (!changed && dt == m.checkedStep) return;
  const bool anew = dt != m.checkedStep || m.laws != m.forcesOfLaws;
  if (changed) findForces(m);
  if (anew) m.passed.reset();
  if (m.refusesUnstableSteps) anew ? requireStableStep(m, dt) : lookAtLimit(m);
  m.checkedStep = dt;
}

}  // namespace

void move(Model& m, double dt) {
  prepare(m, dt);
  timed(m, "move", [&] {
    requireFiniteGravity(m);
    Step step = begin(m, dt);
    bookHalf(m, dt);
    step.moved = sweep(m, step);
    moveTerms(m, step);
    m.step = step;
    m.open = dt;
  });
  if (!(m.step.moved <= m.smallestRadius)) requireShortMoves(m.particles, dt, when(m));
}

void bookLosses(Model& m, const ContactWork& work, double dt) {
  ContactWork& lost = m.booked.lost;
  lost.frictionPower += dt * work.frictionPower;
  lost.rollingPower += dt * work.rollingPower;
  lost.plasticPower += dt * work.plasticPower;
  lost.fracturePower += dt * work.fracturePower;
}

void updateNeighbourList(Model& m) {
  timed(m, "find pairs", [&] {
    for (std::size_t k = 0; k < m.terms.size(); ++k)
      m.terms.begin()[static_cast<std::ptrdiff_t>(k)]->exchange(m, m.step);
    updatePairs(m);
  });
}

namespace {
/// Of all terms. Those that meet at seams act as one.
void findFacetContacts(Model& m) {
  std::vector<WallAtSeam> seams;
  for (const auto& term : m.terms) timed(m, *term, [&] { term->findFacetContacts(m, m.step, seams); });
  joinAtSeams(m.particles, seams);
  std::vector<AnsweredContacts> walls;
  for (const auto& term : m.terms) timed(m, *term, [&] { term->takeFacetContacts(m, m.step, walls); });
  passMemories(walls);
}
}  // namespace

void addForcesOfTerms(Model& m) {
  bool found = false;
  for (const auto& term : m.terms) {
    if (!found && term->order() != Term::Order::partners) findFacetContacts(m), found = true;
    timed(m, *term, [&] { term->addForces(m, m.step); });
  }
}

void addForces(Model& m) {
  const double dt = m.step.dt;
  m.work = {};
  m.rate = {};
  if (m.laws) timed(m, "pairs", [&] { m.work += m.laws->pairs(m.particles, m.pairs, dt, m.booking); });
  addForcesOfTerms(m);
  for (const auto& term : m.terms) term->book(m, m.step);
  welcome(m);
  m.rate.lost.dissipatedPower += m.work.dissipatedPower;
  if (!m.step.timeless) bookHalf(m, dt);
  if (m.booking == Booking::on)
    bookLosses(m, m.work, dt);  // those of springs that end or slide where no time passes, too
  m.knownIds = m.particles.nextId;
  m.forcesOf = m.particles.revision;
  m.forcesOfTerms = m.terms.revision();
  m.forcesOfLaws = m.laws;
}

void findForces(Model& m) {
  constexpr double noTime = 1e-100;  // s: so short that no memory advances
  const bool otherTerms = m.forcesOfTerms != m.terms.revision(), first = m.forcesOf == Model::never;
  const bool changed = !hasForces(m), books = changed && !first && m.booking == Booking::on;
  if (changed) takeIn(m, first);
  const Step last = m.step;
  m.step.dt = noTime;
  m.step.timeless = true;
  m.step.moved = std::numeric_limits<double>::infinity();
  updatePairs(m);
  if (otherTerms)
    for (const auto& term : m.terms) term->neighbourListUpdated(m);
  const double before = m.work.storedEnergy() + m.booked.lost.lostPower();
  if (first) m.pairs.takeEnded();  // those of pairs taken from a state are in no book
  startForces(m.particles, m.gravity);
  addForces(m);
  if (books) m.booked.entered += m.work.storedEnergy() + m.booked.lost.lostPower() - before;
  m.work.frictionPower = m.work.rollingPower = m.work.plasticPower = m.work.fracturePower = 0.0;
  m.step = last;
}

void close(Model& m) {
  if (m.open == 0.0) return;
  kick(m.particles, 0.5 * m.open);
  prescribe(m, m.step, Half::second);
  for (const auto& term : m.terms) term->close(m, m.open);
  m.open = 0.0;
}

void advance(Model& m, double dt) {
  try {
    move(m, dt);
    updateNeighbourList(m);
    addForces(m);
  } catch (const NumericalError& error) {
    if (m.refusesUnstableSteps) lookAtLimit(m);
    reportOfLimit(m, error);
    throw;
  }
  if (m.refusesUnstableSteps && looksAtLimit(m.steps)) lookAtLimit(m);
}

void run(Model& m, double dt, std::int64_t n) {
  for (std::int64_t i = 0; i < n; ++i) advance(m, dt);
  close(m);
}

}  // namespace dovetail::dem
