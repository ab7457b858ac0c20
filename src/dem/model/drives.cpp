// Particles and clumps that are held, or follow a path.
#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/bodies/body_term.hpp"
#include "dovetail/dem/model/loads.hpp"

namespace dovetail::dem {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// The vector about which a unit quaternion turns, by its length in rad; of the shorter of the two ways.
Vec3 rotationVectorOf(const Quaternion& q) {
  const double sign = q.w < 0.0 ? -1.0 : 1.0;
  const Vec3 u = sign * Vec3{q.x, q.y, q.z};
  const double sine = norm(u);
  return sine > 0.0 ? (2.0 * std::atan2(sine, sign * q.w) / sine) * u : Vec3{};
}

}  // namespace

/// The path over a step: its mean motion, by which positions are those of the path, and its own at the end.
struct DriveTerm::Way {
  double dt = 0.0;
  Vec3 mean, v;         // of the point that it turns about, or of all, m/s
  Vec3 meanSpin, spin;  // rad/s
  Vec3 from, to;        // that point before and at the end, m
  Quaternion turn;      // of all in the step
  bool rigid = false;   // about that point; else each about its own centre
  geometry::Periodicity space;

  Vec3 velocityAt(const Vec3& x, Half half) const {
    if (half == Half::second) return rigid ? v + cross(spin, space.minimumImage(x - to)) : v;
    if (!rigid) return mean;
    const Vec3 arm = space.minimumImage(x - from);
    return mean + (1.0 / dt) * (rotate(turn, arm) - arm);
  }
  const Vec3& spinIn(Half half) const { return half == Half::second ? spin : meanSpin; }
};

void DriveTerm::check(const Model& m) const {
  if (!rigid_ && (!displacement_ || !velocity_))
    throw InputError("the path is missing", "drive", "give displacement and velocity as functions of time");
  if (spin_ && !m.particles.rotates())
    throw InputError("a spin is prescribed, but the particles do not spin", "drive", "call switchOnRotation before");
  std::vector<char> driven(m.particles.size(), 0);
  for (const std::int64_t id : ids_) {
    const int i = find(m.particles, id);
    if (i < 0)
      throw InputError("there is no particle " + std::to_string(id), "drive", "give ids of particles of the model");
    driven[at(i)] = 1;
  }
  for (const BodyTerm* term : m.terms.all<BodyTerm>())
    for (std::size_t k = 1; k < term->clumps.size(); ++k)
      if (term->clumps.body[k] == term->clumps.body[k - 1] &&
          driven[at(term->clumps.particle[k])] != driven[at(term->clumps.particle[k - 1])])
        throw InputError("some members of body " + std::to_string(term->clumps.body[k]) + " are driven, others not",
                         "drive", "give the ids of all members of a clump, or of none");
}

Momenta DriveTerm::motionAt(double time) const {
  if (stands) return {};
  if (!rigid_) return {velocity_(time), spin_ ? spin_(time) : Vec3{}};
  const RigidMotion now = rigid_(time);
  return {now.v, now.omega};
}

DriveTerm::Way DriveTerm::wayIn(const Model& m, const Step& step) const {
  Way way;
  way.dt = step.dt;
  if (stands) return way;
  const double before = step.time - step.dt;
  const Momenta now = motionAt(step.time);
  way.v = now.linear;
  way.spin = now.angular;
  if (rigid_) {
    const RigidMotion start = rigid_(before), end = rigid_(step.time);
    way.rigid = true;
    way.space = m.pairs.periodicity();
    way.from = start.x;
    way.to = end.x;
    way.turn = normalized(end.turn * conjugate(start.turn));
    way.meanSpin = (1.0 / step.dt) * rotationVectorOf(way.turn);
    way.mean = (1.0 / step.dt) * (end.x - start.x);
    return way;
  }
  way.mean = (1.0 / step.dt) * (displacement_(step.time) - displacement_(before));
  if (!spin_) return way;
  way.meanSpin = 0.5 * (spin_(before) + spin_(step.time));
  way.turn = fromRotationVector(step.dt * way.meanSpin);
  return way;
}

const std::vector<int>& DriveTerm::numbers(const Particles& particles) const {
  if (located_ == particles.revision) return particle_;
  particle_.clear();
  for (const std::int64_t id : ids_)
    if (const int i = find(particles, id); !particles.isMember(at(i))) particle_.push_back(i);
  located_ = particles.revision;
  return particle_;
}

const std::vector<int>& DriveTerm::bodyNumbers(const Particles& particles, const BodyTerm& term) const {
  if (bodiesLocated_ == particles.revision) return body_;
  std::vector<char> driven(particles.size(), 0);
  for (const std::int64_t id : ids_) driven[at(find(particles, id))] = 1;
  body_.clear();
  for (std::size_t k = 0; k < term.clumps.size(); ++k)
    if (driven[at(term.clumps.particle[k])] != 0 && (body_.empty() || body_.back() != term.clumps.body[k]))
      body_.push_back(term.clumps.body[k]);
  bodiesLocated_ = particles.revision;
  return body_;
}

std::vector<char> drivenBodies(const Model& m, const BodyTerm& term) {
  std::vector<char> driven(term.bodies.size(), 0);
  for (const DriveTerm* drive : m.terms.all<DriveTerm>())
    for (const int b : drive->bodyNumbers(m.particles, term)) driven[at(b)] = 1;
  return driven;
}

namespace {

/// Sets one velocity, or spin, half a kick after it was `now`. @return the support's impulse, kg m/s
/// Forces do their work in the half kick with the mean velocity of the step, which is the one after the first half and
/// before the second; the support does the rest of what changes the kinetic energy, whatever jump it makes.
Vec3 prescribeOne(Vec3& now, const Vec3& wanted, double inertia, const Vec3& halfKick, Half half, double& work) {
  const Vec3 before = now - (1.0 / inertia) * halfKick, &mean = half == Half::first ? wanted : before;
  const Vec3 impulse = inertia * (wanted - now);
  work += 0.5 * inertia * dot(wanted - before, wanted + before) - dot(halfKick, mean);
  now = wanted;
  return impulse;
}

/// I ω, and I⁻¹ L, of a body that is turned by q.
Vec3 times(const Vec3& inertia, const Quaternion& q, const Vec3& omega) {
  const Vec3 w = rotateBack(q, omega);
  return rotate(q, {inertia.x * w.x, inertia.y * w.y, inertia.z * w.z});
}
Vec3 over(const Vec3& inertia, const Quaternion& q, const Vec3& momentum) {
  const Vec3 l = rotateBack(q, momentum);
  return rotate(q, {l.x / inertia.x, l.y / inertia.y, l.z / inertia.z});
}

/// The spin of a body likewise. Between the halves its angular momentum is that of the turn halfway, so that each half
/// gives half of what turns it. @return the support's angular impulse, kg m²/s
Vec3 prescribeSpin(Bodies& bodies, std::size_t b, const Vec3& meanSpin, const Vec3& spin, double dt, Half half,
                   double& work) {
  const Quaternion& q = bodies.orientation[b];
  const Vec3 &inertia = bodies.inertia[b], halfKick = 0.5 * dt * bodies.torque[b];
  const Vec3 now = bodies.angularMomentum[b], before = now - halfKick;
  const bool first = half == Half::first;
  const Vec3 wanted = first ? times(inertia, normalized(fromRotationVector(0.5 * dt * meanSpin) * q), meanSpin)
                            : times(inertia, q, spin);
  work += 0.5 * dot(first ? meanSpin : spin, wanted) - dot(halfKick, meanSpin) -
          0.5 * dot(first ? over(inertia, q, before) : meanSpin, before);
  bodies.angularMomentum[b] = wanted;
  return wanted - now;
}

}  // namespace

/// Mean place of its particles and bodies within one period, m.
Vec3 DriveTerm::meanPlace(const Model& m) const {
  std::vector<Vec3> places;
  for (const int i : numbers(m.particles)) places.push_back(m.particles.x[at(i)]);
  for (const BodyTerm* term : m.terms.all<BodyTerm>())
    for (const int b : bodyNumbers(m.particles, *term)) places.push_back(term->bodies.x[at(b)]);
  if (places.empty()) return {};
  Vec3 sum;
  for (const Vec3& x : places) sum += m.pairs.periodicity().minimumImage(x - places.front());
  return places.front() + (1.0 / static_cast<double>(places.size())) * sum;
}

void DriveTerm::prescribe(Model& m, const Step& step, Half half) {
  Particles& p = m.particles;
  const std::vector<int>& driven = numbers(p);
  const double time = 0.5 * step.dt;
  const geometry::Periodicity& space = m.pairs.periodicity();
  if (half == Half::second) centre_ = meanPlace(m);
  Momenta sum;
  if (!driven.empty()) {
    const Way way = wayIn(m, step);
    for (const int k : driven) {
      const std::size_t i = at(k);
      const double weight = p.weightOf(i);
      const Vec3 impulse =
          prescribeOne(p.v[i], way.velocityAt(p.x[i], half), weight * p.mass[i], time * p.f[i], half, m.booked.walls);
      Vec3 turn;
      if (p.rotates())
        turn = prescribeOne(p.omega[i], way.spinIn(half), weight * momentOfInertia(p, k), time * p.torque[i], half,
                            m.booked.walls);
      supportImpulse += impulse;
      supportMoment += cross(p.x[i], impulse) + turn;
      sum += {impulse, cross(space.minimumImage(p.x[i] - centre_), impulse) + turn};
    }
  }
  if (half == Half::second) support = {(1.0 / time) * sum.linear, (1.0 / time) * sum.angular};
}

void DriveTerm::prescribeBodies(Model& m, BodyTerm& term, const Step& step, Half half) {
  const std::vector<int>& driven = bodyNumbers(m.particles, term);
  if (driven.empty()) return;
  Bodies& bodies = term.bodies;
  const double time = 0.5 * step.dt;
  const Way way = wayIn(m, step);
  Momenta sum;
  for (const int k : driven) {
    const std::size_t b = at(k);
    const Vec3 impulse = prescribeOne(bodies.v[b], way.velocityAt(bodies.x[b], half), bodies.mass[b],
                                      time * bodies.f[b], half, m.booked.walls);
    const Vec3 turn = prescribeSpin(bodies, b, way.meanSpin, way.spin, step.dt, half, m.booked.walls);
    supportImpulse += impulse;
    supportMoment += cross(bodies.x[b], impulse) + turn;
    sum += {impulse, cross(m.pairs.periodicity().minimumImage(bodies.x[b] - centre_), impulse) + turn};
  }
  if (half == Half::second) support += (1.0 / time) * sum;
}

void DriveTerm::turnBodies(const Model& m, BodyTerm& term, const Step& step) const {
  const std::vector<int>& driven = bodyNumbers(m.particles, term);
  if (driven.empty()) return;
  const Quaternion turn = wayIn(m, step).turn;
  for (const int b : driven) term.bodies.orientation[at(b)] = normalized(turn * term.bodies.turnedFrom[at(b)]);
}

/// The path's motion is that mean to second order.
void DriveTerm::meanMotion(const Model& m, const Step& step, std::span<Vec3> v, std::span<Vec3> omega) const {
  const Way way = wayIn(m, step);
  for (const int i : numbers(m.particles)) {
    v[at(i)] = way.velocityAt(m.particles.x[at(i)], Half::second);
    if (!omega.empty()) omega[at(i)] = way.spin;
  }
}

void DriveTerm::meanMotionOfBodies(const Model& m, const BodyTerm& term, const Step& step, std::span<Vec3> v,
                                   std::span<Vec3> omega) const {
  const std::vector<int>& driven = bodyNumbers(m.particles, term);
  if (driven.empty()) return;
  const Way way = wayIn(m, step);
  for (const int b : driven) {
    v[at(b)] = way.velocityAt(term.bodies.x[at(b)], Half::second);
    omega[at(b)] = way.spin;
  }
}

double DriveTerm::renumber(std::span<const int> newNumber, const Particles& before) {
  std::erase_if(ids_, [&](std::int64_t id) {
    const int i = find(before, id);
    return i >= 0 && newNumber[at(i)] < 0;
  });
  return 0.0;
}

void DriveTerm::addOutside(const Model&, Momenta&, Momenta& impulse) const {
  impulse += {supportImpulse, supportMoment};
}

void DriveTerm::save(ByteWriter& writer) const {
  writer(ids_, supportImpulse, supportMoment, support.linear, support.angular);
}
void DriveTerm::load(ByteReader& reader) {
  reader(ids_, supportImpulse, supportMoment, support.linear, support.angular);
}

}  // namespace dovetail::dem
