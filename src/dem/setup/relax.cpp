#include "dovetail/dem/setup/relax.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "../bodies/carried_walls.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/bodies/body_term.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/dem/pairs/contact_sample.hpp"
#include "dovetail/dem/setup/fire.hpp"

namespace dovetail::dem {

namespace {

/// Square of the radius of the sphere with a body's mass and mean moment of inertia, m².
double squaredRadius(const Bodies& bodies, std::size_t b) {
  const Vec3& inertia = bodies.inertia[b];
  return 2.5 * (inertia.x + inertia.y + inertia.z) / (3.0 * bodies.mass[b]);
}

FireSums fireSums(const Bodies& bodies, const std::vector<char>& driven) {
  FireSums sums;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (driven[b] != 0) continue;
    const Vec3 omega = angularVelocity(bodies, static_cast<int>(b)), &f = bodies.f[b], &torque = bodies.torque[b];
    const double r2 = squaredRadius(bodies, b);
    sums += {dot(f, bodies.v[b]) + dot(torque, omega), squaredNorm(bodies.v[b]) + r2 * squaredNorm(omega),
             squaredNorm(f) + squaredNorm(torque) / r2};
  }
  return sums;
}

/// As particles are steered. No body will move farther in a step than half the radius of its smallest member or, with
/// walls, of the smallest particle.
void steer(Model& m, BodyTerm& term, const FireMix& mix, double dt) {
  Bodies& bodies = term.bodies;
  const Particles& p = m.particles;
  std::vector<double> least(bodies.size(), m.smallestRadius), extent = wallExtents(m, bodies);
  for (std::size_t k = 0; k < term.clumps.size(); ++k) {
    const auto b = static_cast<std::size_t>(term.clumps.body[k]);
    const double radius = p.radius[static_cast<std::size_t>(term.clumps.particle[k])];
    least[b] = extent[b] > 0.0 ? std::min(least[b], radius) : radius;
    extent[b] = std::max(extent[b], norm(term.clumps.offset[k]) + radius);
  }
  const std::vector<char> driven = drivenBodies(m, term);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (driven[b] != 0) continue;
    const Vec3 &inertia = bodies.inertia[b], kick = (0.5 * dt / bodies.mass[b]) * bodies.f[b],
               twist = 0.5 * dt * bodies.torque[b];
    bodies.v[b] = mix.keep * bodies.v[b] + mix.lean * bodies.f[b];
    Vec3& spin = bodies.angularMomentum[b];
    spin = mix.keep * spin + (0.4 * mix.lean * bodies.mass[b]) * bodies.torque[b];
    const double speed =
        norm(bodies.v[b] + kick) + extent[b] * norm(spin + twist) / std::min({inertia.x, inertia.y, inertia.z});
    const double fastest = 0.5 * least[b] / dt;
    if (!(speed > fastest)) continue;
    bodies.v[b] = (fastest / speed) * (bodies.v[b] + kick) - kick;
    spin = (fastest / speed) * (spin + twist) - twist;
  }
}

/// Those of a model, const or not.
auto servosOf(auto& m) {
  using Servo = std::conditional_t<std::is_const_v<std::remove_reference_t<decltype(m)>>, const WallServo, WallServo>;
  std::vector<Servo*> servos;
  for (auto* term : m.terms.template all<PrimitiveWallTerm>())
    if (term->wall.servo) servos.push_back(&*term->wall.servo);
  for (auto* term : m.terms.template all<MeshWallTerm>())
    if (auto* const servo = std::get_if<WallServo>(&term->mesh.motion)) servos.push_back(servo);
  return servos;
}

void steer(Model& m, const FireMix& mix, double dt) {
  steer(m.particles, mix, dt);
  const double fastest = 0.5 * m.smallestRadius / dt;
  for (WallServo* servo : servosOf(m))
    servo->speed = std::clamp(mix.keep * servo->speed + mix.lean * servo->unbalanced(), -fastest, fastest);
  for (BodyTerm* term : m.terms.all<BodyTerm>()) steer(m, *term, mix, dt);
}

FireSums fireSums(const Model& m) {
  FireSums sums = fireSums(m.particles);
  for (const WallServo* servo : servosOf(m)) {
    const double force = servo->unbalanced();
    sums += {force * servo->speed, servo->speed * servo->speed, force * force};
  }
  for (const BodyTerm* term : m.terms.all<BodyTerm>()) sums += fireSums(term->bodies, drivenBodies(m, *term));
  return sums;
}

void check(const Model& m, const RestCriterion& rest, const RelaxationOptions& s) {
  constexpr const char* beltRemedy = "set its surface velocity to zero until then";
  validate(rest, "relaxation");
  requireFraction(s.stepFraction, "the fraction of the critical step", "relaxation");
  if (s.lookEvery < 1) throw InputError("lookEvery is " + std::to_string(s.lookEvery), "relaxation", "give 1 or more");
  for (const WallServo* servo : servosOf(m))
    if (servo->turns)
      throw InputError("a wall keeps a torque", "relaxation", "relax with coupling::relax, or hold the wall");
  for (const PrimitiveWallTerm* term : m.terms.all<PrimitiveWallTerm>())
    if (const Vec3 along = term->wall.servo ? term->wall.servo->direction : Vec3{};
        term->wall.motion || norm(term->wall.angularVelocity) > 0.0 ||
        norm(term->wall.velocity - dot(term->wall.velocity, along) * along) > 0.0)
      throw InputError("a wall moves", "relaxation", "keep walls at rest");
    else if (norm(term->wall.surfaceVelocity) > 0.0)
      throw InputError("a wall has a surface velocity", "relaxation", beltRemedy);
  for (const MeshWallTerm* term : m.terms.all<MeshWallTerm>())
    if (std::holds_alternative<PrescribedMotion>(term->mesh.motion))
      throw InputError("a triangulated wall moves along a path", "relaxation",
                       "keep walls at rest, or free (addFreeWall)");
    else if (norm(term->mesh.surfaceVelocity) > 0.0)
      throw InputError("a triangulated wall has a surface velocity", "relaxation", beltRemedy);
  for (const DriveTerm* term : m.terms.all<DriveTerm>())
    if (const Momenta motion = term->motionAt(m.time); norm(motion.linear) + norm(motion.angular) > 0.0)
      throw InputError("a drive moves or turns its particles", "relaxation",
                       "let it begin later, or add it afterwards");
}

/// So long that a particle crosses a tenth of its radius, where nobody touches anybody yet.
double longestStep(const Model& m, double fraction) {
  const double mean = m.particles.size() == 0 ? 1.0 : 1e-3 * m.particles.radius[0];
  const double dt = criticalStep(m, mean).dt;
  return fraction * (std::isfinite(dt) ? dt : 1.0);
}

}  // namespace

void stop(Model& m) {
  for (WallServo* servo : servosOf(m)) servo->speed = 0.0;
  std::fill(m.particles.v.begin(), m.particles.v.end(), Vec3{});
  std::fill(m.particles.omega.begin(), m.particles.omega.end(), Vec3{});
  for (BodyTerm* term : m.terms.all<BodyTerm>()) {
    std::fill(term->bodies.v.begin(), term->bodies.v.end(), Vec3{});
    std::fill(term->bodies.angularMomentum.begin(), term->bodies.angularMomentum.end(), Vec3{});
  }
  forgetVelocities(m);
}

void forgetVelocities(Model& m) {
  if (!m.laws) return;
  m.pairs.forgetMotion();
  for (const auto& term : m.terms) term->forgetVelocities(m.laws->memory());
}

double kineticEnergy(const Model& m) {
  Energies e;
  e.kinetic = kineticEnergy(m.particles);
  for (const auto& term : m.terms) term->addEnergies(m, e);
  return e.kinetic;
}

namespace {

/// A contact or bond of a particle with another one, or a contact with a wall (< 0), and its force, N.
struct Held {
  int first, second;
  double force;
};

std::vector<Held> contactsOf(const Model& m) {
  std::vector<Held> found;
  if (!m.laws) return found;
  const ContactSample sample = m.laws->sample(m.particles, m.pairs);
  for (std::size_t c = 0; c < sample.size(); ++c)
    found.push_back({sample.first[c], sample.second[c], norm(sample.force[c])});
  for (const BondTerm* term : m.terms.all<BondTerm>())
    for (std::size_t b = 0; b < term->bonds.forces.size(); ++b)
      found.push_back({term->bonds.bonds[b].i, term->bonds.bonds[b].j, norm(term->bonds.forces[b].force)});
  for (const PrimitiveWallTerm* term : m.terms.all<PrimitiveWallTerm>())
    for (std::size_t c = 0; c < term->wall.contacts.size(); ++c)
      found.push_back({term->wall.contacts.particle[c], -1, norm(term->wall.contacts.force[c])});
  for (const MeshWallTerm* term : m.terms.all<MeshWallTerm>())
    for (std::size_t c = 0; c < term->mesh.contacts.size(); ++c)
      found.push_back({term->mesh.contacts.particle[c], -1, norm(term->mesh.contacts.force[c])});
  return found;
}

}  // namespace

RelaxationReport restOf(const Model& m) {
  const Particles& p = m.particles;
  std::vector<char> touches(p.size(), 0);
  double contactForce = 0.0, residual = 0.0;
  const std::vector<Held> contacts = contactsOf(m);
  for (const Held& c : contacts) {
    contactForce += c.force / static_cast<double>(contacts.size());
    for (const int i : {c.first, c.second})
      if (i >= 0) touches[static_cast<std::size_t>(i)] = 1;
  }
  RelaxationReport report;
  std::int64_t counted = 0;
  const auto count = [&](double force, bool touched) {
    residual += force;
    ++counted;
    report.rattlers += !touched && force == 0.0;
  };
  for (std::size_t i = 0; i < p.size(); ++i)
    if (p.ownerOf(i) == Owner::nobody) count(norm(p.f[i]), touches[i] != 0);
  for (const BodyTerm* term : m.terms.all<BodyTerm>()) {
    const Bodies& bodies = term->bodies;
    std::vector<char> touched(bodies.size(), 0);
    markTouched(m, touched);
    for (std::size_t k = 0; k < term->clumps.size(); ++k)
      if (touches[static_cast<std::size_t>(term->clumps.particle[k])] != 0)
        touched[static_cast<std::size_t>(term->clumps.body[k])] = 1;
    const std::vector<char> driven = drivenBodies(m, *term);
    for (std::size_t b = 0; b < bodies.size(); ++b)
      if (driven[b] == 0)
        count(norm(bodies.f[b]) + norm(bodies.torque[b]) / std::sqrt(squaredRadius(bodies, b)), touched[b] != 0);
  }
  const auto held = static_cast<double>(counted - report.rattlers);
  if (residual > 0.0)
    report.residual = contactForce > 0.0 ? residual / held / contactForce : std::numeric_limits<double>::infinity();
  report.residual = std::max(report.residual, unbalancedLoads(m));
  return report;
}

double unbalancedLoads(const Model& m) {
  double largest = 0.0;
  for (const WallServo* servo : servosOf(m))
    if (const double most = std::max(std::abs(servo->load), std::abs(servo->contact)); most > 0.0)
      largest = std::max(largest, std::abs(servo->unbalanced()) / most);
  return largest;
}

namespace {
/// The step follows the limit at every look; in between a model that is on its way to rest may be a little beyond.
/// Driven particles are held, as the time of the steps is none in which they are to get on.
struct RelaxingModel {
  explicit RelaxingModel(Model& m) : model(m), refuses(std::exchange(m.refusesUnstableSteps, false)) {
    for (DriveTerm* drive : m.terms.all<DriveTerm>()) drive->stands = true;
  }
  ~RelaxingModel() {
    model.refusesUnstableSteps = refuses;
    for (DriveTerm* drive : model.terms.all<DriveTerm>()) drive->stands = false;
  }
  RelaxingModel(const RelaxingModel&) = delete;
  RelaxingModel& operator=(const RelaxingModel&) = delete;
  Model& model;
  bool refuses;
};
}  // namespace

RelaxationReport relax(Model& m, const RestCriterion& rest, const RelaxationOptions& settings) {
  check(m, rest, settings);
  findForces(m);
  const RelaxingModel relaxing(m);
  Fire fire(longestStep(m, settings.stepFraction));
  RelaxationReport report;
  for (std::int64_t step = 0;; ++step) {
    if (step % settings.lookEvery == 0 || step == rest.steps) {
      report = restOf(m);
      report.steps = step;
      if (report.judge(report.residual, rest) || (settings.enough && settings.enough(m))) break;
      fire.setLongest(longestStep(m, settings.stepFraction));
    }
    const double before = kineticEnergy(m);
    const FireMix mix = fire.next(fireSums(m));
    steer(m, mix, fire.dt());
    forgetVelocities(m);
    m.booked.damping += before - kineticEnergy(m);
    run(m, fire.dt(), 1);
  }
  m.booked.damping += kineticEnergy(m);
  stop(m);
  for (const BodyTerm* term : m.terms.all<BodyTerm>()) placeCarriedWalls(m, term->bodies, m.time);
  return report;
}

}  // namespace dovetail::dem
