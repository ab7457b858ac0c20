#include "dovetail/dem/bodies/body_term.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "../model/events.hpp"
#include "carried_walls.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/dem/particles/damping.hpp"

namespace dovetail::dem {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Angular velocity that belongs to an angular momentum.
Vec3 spinOf(const Bodies& bodies, std::size_t b, const Vec3& angularMomentum) {
  const Quaternion& q = bodies.orientation[b];
  const Vec3 l = rotateBack(q, angularMomentum), &inertia = bodies.inertia[b];
  return rotate(q, {l.x / inertia.x, l.y / inertia.y, l.z / inertia.z});
}

/// Counts a body as exchanged; its kinetic energy and m g·x, J.
/// @param lag for so long the forces that it has are yet to act, s
double book(const Bodies& bodies, std::size_t b, const Vec3& gravity, double lag, Exchanged& exchanged) {
  const Vec3 v = bodies.v[b] + (lag / bodies.mass[b]) * bodies.f[b];
  const Vec3 angular = bodies.angularMomentum[b] + lag * bodies.torque[b];
  ++exchanged.count;
  exchanged.mass += bodies.mass[b];
  exchanged.momentum += bodies.mass[b] * v;
  exchanged.angularMomentum += cross(bodies.x[b], bodies.mass[b] * v) + angular;
  return 0.5 * (bodies.mass[b] * squaredNorm(v) + dot(angular, spinOf(bodies, b, angular))) -
         bodies.mass[b] * dot(gravity, bodies.x[b]);
}

}  // namespace

void BodyTerm::check(const Model& m) const {
  validate(bodies);
  dem::check(m.particles, bodies, clumps);
  requireShorter(m.particles, clumps, m.pairs.periodicity());
  for (std::size_t k = 0; k < clumps.size(); ++k)
    if (const double weight = m.particles.weightOf(at(clumps.particle[k])); weight != 1.0)
      throw InputError("its member, particle " + std::to_string(m.particles.id[at(clumps.particle[k])]) +
                           ", has the weight " + formatNumber(weight),
                       "body " + std::to_string(clumps.body[k]), "give members of bodies the weight 1");
}

void BodyTerm::own(Particles& particles) const {
  for (const int i : clumps.particle) setOwner(particles, i, Owner::body);
}

double BodyTerm::move(Model& m, const Step& step) {
  if (step.closing > 0.0) {
    kickBodies(bodies, 0.5 * step.closing);
    moveDriven(m, m.step, Half::second);
  }
  kickBodies(bodies, 0.5 * step.dt);
  moveDriven(m, step, Half::first);
  driftBodies(bodies, step.dt);
  for (const DriveTerm* drive : std::as_const(m.terms).all<DriveTerm>()) drive->turnBodies(m, *this, step);
  clearForces(bodies);
  applyGravity(bodies, m.gravity);  // all that is known of the forces to come
  placeCarriedWalls(m, bodies, step.time);
  const double moved = placeMembers(bodies, clumps, m.pairs.periodicity(), m.particles);
  if (!std::isfinite(moved)) requireFinite(bodies, when(m));
  return moved;
}

void BodyTerm::moveDriven(Model& m, const Step& step, Half half) {
  for (DriveTerm* drive : m.terms.all<DriveTerm>()) drive->prescribeBodies(m, *this, step, half);
}

void BodyTerm::neighbourListUpdated(Model& m) {
  const std::vector<Vec3> before = bodies.x;
  m.booked.lifted -= dot(m.gravity, wrapPositions(bodies, m.pairs.periodicity()));
  shiftCarriedWalls(m, bodies, before);
  muteMemberPairs(clumps, m.pairs);
}

void BodyTerm::leaving(Model& m, std::vector<char>& leaves) {
  std::vector<char> gone(bodies.size(), 0);
  for (std::size_t k = 0; k < clumps.size(); ++k)
    if (leaves[at(clumps.particle[k])] != 0) gone[at(clumps.body[k])] = 1;
  for (std::size_t k = 0; k < clumps.size(); ++k)
    if (gone[at(clumps.body[k])] != 0) leaves[at(clumps.particle[k])] = booked;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (gone[b] != 0) {
      m.booked.left += dem::book(bodies, b, m.gravity, 0.5 * m.open, m.left);
      beside_.add(bodies.x[b], (0.5 * m.open * bodies.mass[b]) * m.gravity);
    }
  known_ -=
      static_cast<int>(std::count(gone.begin(), gone.begin() + std::min<std::ptrdiff_t>(known_, std::ssize(gone)), 1));
  renumberCarriedWalls(m, gone);
}

double BodyTerm::renumber(std::span<const int> newNumber, const Particles&) {
  dem::renumber(bodies, clumps, newNumber);
  return 0.0;
}

void BodyTerm::addForces(Model& m, const Step&) {
  clearForces(bodies);
  gatherForces(m.particles, clumps, bodies, m.gravity);
  gatherCarriedWalls(m, bodies);
  damp(m);
}

void BodyTerm::welcome(const Step& step) {
  if (step.timeless) return;
  for (std::size_t b = at(std::exchange(known_, static_cast<int>(bodies.size()))); b < bodies.size(); ++b) {
    const Vec3 half = 0.5 * step.dt * bodies.f[b], turn = 0.5 * step.dt * bodies.torque[b];
    bodies.v[b] -= (1.0 / bodies.mass[b]) * half;
    bodies.angularMomentum[b] -= turn;
    beside_ += {-half, -(cross(bodies.x[b], half) + turn)};
  }
}

void BodyTerm::damp(Model& m) {
  for (const DampingTerm* damping : m.terms.all<DampingTerm>()) {
    if (damping->viscousRate != 0.0) applyViscousDamping(bodies, damping->viscousRate);
    if (damping->local != 0.0) applyLocalDamping(bodies, damping->local);
  }
}

namespace {
/// What damping has added to the force and the torque on a body, N, N m.
Momenta dampingOn(const Bodies& bodies, std::size_t b, const DampingTerm& damping) {
  const auto added = [&](const Vec3& whole, const Vec3& momentum, const Vec3& velocity) {
    return dampingForce(whole, momentum, velocity, damping.viscousRate, damping.local);
  };
  return {added(bodies.f[b], bodies.mass[b] * bodies.v[b], bodies.v[b]),
          added(bodies.torque[b], bodies.angularMomentum[b], angularVelocity(bodies, static_cast<int>(b)))};
}
}  // namespace

/// Means of the motion of bodies before and after the kick that is due, m/s, rad/s.
struct BodyTerm::Mean {
  std::vector<Vec3> v, spin;
};
BodyTerm::Mean BodyTerm::meanOf(const Model& m, const Step& step) const {
  Mean mean{std::vector<Vec3>(bodies.size()), std::vector<Vec3>(bodies.size())};
  parallelFor(bodies.size(), 512, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      mean.v[b] = bodies.v[b] + (0.5 * step.dt / bodies.mass[b]) * bodies.f[b];
      mean.spin[b] = spinOf(bodies, b, bodies.angularMomentum[b] + 0.5 * step.dt * bodies.torque[b]);
    }
  });
  for (const DriveTerm* drive : m.terms.all<DriveTerm>()) drive->meanMotionOfBodies(m, *this, step, mean.v, mean.spin);
  return mean;
}

/// With the mean of the velocities before and after the kick that the damping forces are part of.
void BodyTerm::book(Model& m, const Step& step) {
  const auto dampings = m.terms.all<DampingTerm>();
  if (dampings.empty()) return;
  const Mean mean = meanOf(m, step);
  for (const DampingTerm* damping : dampings)
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const Momenta force = dampingOn(bodies, b, *damping);
      m.rate.damping -= dot(force.linear, mean.v[b]) + dot(force.angular, mean.spin[b]);
    }
}

void BodyTerm::meanMotion(const Model& m, const Step& step, std::span<Vec3> v, std::span<Vec3> omega) const {
  const Mean mean = meanOf(m, step);
  parallelFor(clumps.size(), 512, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t b = at(clumps.body[k]), i = at(clumps.particle[k]);
      v[i] = mean.v[b] + cross(mean.spin[b], rotate(bodies.orientation[b], clumps.offset[k]));
      if (!omega.empty()) omega[i] = mean.spin[b];
    }
  });
}

void BodyTerm::close(Model& m, double dt) {
  kickBodies(bodies, 0.5 * dt);
  moveDriven(m, m.step, Half::second);
  placeMembers(bodies, clumps, m.pairs.periodicity(), m.particles);
  placeCarriedWalls(m, bodies, m.time);
}

void BodyTerm::addDemand(const Model& m, ContactDemand& demand) const {
  dem::addDemand(demand, m.particles, bodies, clumps);
  addCarriedDemand(m, bodies, demand);
}

void BodyTerm::addEnergies(const Model& m, Energies& e) const {
  e.kinetic += kineticEnergy(bodies);
  for (std::size_t b = 0; b < bodies.size(); ++b) e.gravity -= bodies.mass[b] * dot(m.gravity, bodies.x[b]);
  for (const int member : clumps.particle) {  // which the sums over particles hold
    const std::size_t i = at(member);
    e.gravity += m.particles.mass[i] * dot(m.gravity, m.particles.x[i]);
    e.kinetic -= 0.5 * m.particles.mass[i] * squaredNorm(m.particles.v[i]);
    if (m.particles.rotates())
      e.kinetic -= 0.5 * momentOfInertia(m.particles, member) * squaredNorm(m.particles.omega[i]);
  }
}

void BodyTerm::addMomenta(const Model& m, Momenta& sums) const {
  sums.linear += momentum(bodies);
  sums.angular += angularMomentum(bodies);
  for (const int member : clumps.particle) {
    const std::size_t i = at(member);
    const Vec3 p = m.particles.mass[i] * m.particles.v[i];
    sums.linear -= p;
    sums.angular -= cross(m.particles.x[i], p);
    if (m.particles.rotates()) sums.angular -= momentOfInertia(m.particles, member) * m.particles.omega[i];
  }
}

/// Dampings of bodies; those of single particles are the damping term's.
void BodyTerm::addOutside(const Model& m, Momenta& force, Momenta& impulse) const {
  impulse += beside_;
  for (const DampingTerm* damping : m.terms.all<DampingTerm>())
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const Momenta added = dampingOn(bodies, b, *damping);
      force.add(bodies.x[b], added.linear);
      force.angular += added.angular;
    }
}

namespace {
template <class Archive, class B, class C>
void archive(Archive& a, B& b, C& c) {
  a(b.x, b.v, b.f, b.mass, b.inertia, b.orientation, b.angularMomentum, b.torque, c.particle, c.body, c.offset);
}
}  // namespace

void BodyTerm::save(ByteWriter& writer) const {
  archive(writer, bodies, clumps);
  writer(beside_, known_);
}
void BodyTerm::load(ByteReader& reader) {
  archive(reader, bodies, clumps);
  bodies.turnedFrom = bodies.orientation;
  reader(beside_, known_);
}

void BodyTerm::takeIn(Model& m, bool first) {
  for (std::size_t b = first ? bodies.size() : at(known_); b < bodies.size(); ++b)
    m.booked.entered += dem::book(bodies, b, m.gravity, 0.0, m.entered);
  known_ = static_cast<int>(bodies.size());
  spinMembers(bodies, clumps, m.particles);
}

void BodyTerm::admit(Model& m, int first) {
  for (std::size_t b = at(first); b < bodies.size(); ++b)
    m.booked.entered += dem::book(bodies, b, m.gravity, 0.0, m.entered);
  spinMembers(bodies, clumps, m.particles);
  for (std::size_t k = 0; k < clumps.size(); ++k) {
    if (clumps.body[k] < first) continue;
    const std::size_t i = at(clumps.particle[k]);
    m.particles.f[i] = bodies.mass[at(clumps.body[k])] * m.gravity;
    m.newcomers.push_back(m.particles.id[i]);
  }
  m.newcomersTouch = true;
}

BodyTerm& bodies(Model& m) {
  const auto found = m.terms.all<BodyTerm>();
  return found.empty() ? m.terms.add(BodyTerm{}) : *found.front();
}

int addClump(Model& m, const ClumpShape& shape, const Vec3& x, const Quaternion& turn, const Vec3& v,
             const Vec3& omega) {
  BodyTerm& term = bodies(m);
  requireShorter(shape, m.pairs.periodicity(), "clump of body " + std::to_string(term.bodies.size()));
  return addClump(m.particles, term.bodies, term.clumps, shape, x, turn, v, omega);
}

}  // namespace dovetail::dem
