// Particles that are held, or follow a path.
#include "dovetail/core/error.hpp"
#include "dovetail/dem/model/loads.hpp"

namespace dovetail::dem {

namespace {
std::size_t at(int i) { return static_cast<std::size_t>(i); }
}  // namespace

void DriveTerm::check(const Model& m) const {
  if (!displacement_ || !velocity_)
    throw InputError("the path is missing", "drive", "give displacement and velocity as functions of time");
  if (spin_ && !m.particles.rotates())
    throw InputError("a spin is prescribed, but the particles do not spin", "drive", "call switchOnRotation before");
  for (const std::int64_t id : ids_) {
    const int i = find(m.particles, id);
    if (i < 0)
      throw InputError("there is no particle " + std::to_string(id), "drive", "give ids of particles of the model");
    if (m.particles.isMember(at(i)))
      throw InputError("particle " + std::to_string(id) + " is a member of a clump, which moves it", "drive",
                       "give ids of single particles");
  }
}

Momenta DriveTerm::motionAt(double time) const {
  if (stands) return {};
  return {velocity_(time), spin_ ? spin_(time) : Vec3{}};
}

/// The mean motion of the step that begins, so that positions are those of the path; then the path's own.
Momenta DriveTerm::motionIn(const Step& step, Half half) const {
  if (stands || half == Half::second) return motionAt(step.time);
  const Vec3 way = displacement_(step.time) - displacement_(step.time - step.dt);
  return {(1.0 / step.dt) * way, spin_ ? 0.5 * (spin_(step.time - step.dt) + spin_(step.time)) : Vec3{}};
}

const std::vector<int>& DriveTerm::numbers(const Particles& particles) {
  if (located_ == particles.revision) return particle_;
  particle_.clear();
  for (const std::int64_t id : ids_) particle_.push_back(find(particles, id));
  located_ = particles.revision;
  return particle_;
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

/// Mean place of some particles of one period, m.
Vec3 centreOf(const Particles& p, const std::vector<int>& particles, const geometry::Periodicity& space) {
  Vec3 sum;
  for (const int i : particles) sum += space.minimumImage(p.x[at(i)] - p.x[at(particles.front())]);
  return p.x[at(particles.front())] + (1.0 / static_cast<double>(particles.size())) * sum;
}

}  // namespace

void DriveTerm::prescribe(Model& m, const Step& step, Half half) {
  Particles& p = m.particles;
  const std::vector<int>& driven = numbers(p);
  if (driven.empty()) return;
  const auto [v, omega] = motionIn(step, half);
  const double time = 0.5 * step.dt;
  const Vec3 centre = half == Half::second ? centreOf(p, driven, m.pairs.periodicity()) : Vec3{};
  Momenta sum;
  for (const int k : driven) {
    const std::size_t i = at(k);
    const double weight = p.weightOf(i);
    const Vec3 impulse = prescribeOne(p.v[i], v, weight * p.mass[i], time * p.f[i], half, m.booked.walls);
    Vec3 turn;
    if (p.rotates())
      turn = prescribeOne(p.omega[i], omega, weight * momentOfInertia(p, k), time * p.torque[i], half, m.booked.walls);
    supportImpulse += impulse;
    supportMoment += cross(p.x[i], impulse) + turn;
    sum += {impulse, cross(m.pairs.periodicity().minimumImage(p.x[i] - centre), impulse) + turn};
  }
  if (half == Half::second) support = {(1.0 / time) * sum.linear, (1.0 / time) * sum.angular};
}

/// The path's motion is that mean to second order.
void DriveTerm::meanMotion(const Model& m, const Step& step, std::span<Vec3> v, std::span<Vec3> omega) const {
  const Momenta along = motionAt(step.time);
  for (const std::int64_t id : ids_) {
    const std::size_t i = at(find(m.particles, id));
    v[i] = along.linear;
    if (!omega.empty()) omega[i] = along.angular;
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
