// Steps with an implicit solid: coupled at the ends of its step, or staggered as the paper's authors did.
#include "forces.hpp"

namespace dovetail::arlequin {

using namespace detail;

namespace {

std::vector<Vec3> gravityLoad(const Model& model) {
  std::vector<Vec3> load;
  if (squaredNorm(model.discrete.gravity) == 0.0) return load;
  for (const double mass : model.solid->nodes().mass) load.push_back(mass * model.discrete.gravity);
  return load;
}

std::vector<Vec3> difference(std::span<const Vec3> now, std::span<const Vec3> before) {
  std::vector<Vec3> d(now.size());
  for (std::size_t i = 0; i < d.size(); ++i) d[i] = now[i] - before[i];
  return d;
}

/// v += (dt/m) · coupling force on both models.
void kickByCoupling(Model& model, double dt, StepSums& sums) {
  Solid& solid = *model.solid;
  for (std::size_t i = 0; i < model.slowForce.size(); ++i)
    model.discrete.particles.v[i] += (dt / model.discrete.particles.mass[i]) * model.slowForce[i];
  solid.acceleration = model.coupling->nodeForce;
  solid.motion().accelerate(solid.acceleration);
  kickSolid(solid, solid.acceleration, dt);
  sums.supportImpulse += supportImpulse(solid, solid.acceleration, model.coupling->nodeForce, dt);
}

/// Coupling forces into model.slowForce and coupling.nodeForce, leaving particles.f alone. Multipliers see half of dt:
/// half a kick by them then takes the whole of the gap's rate, which so vanishes at full steps.
void separateCouplingForces(Model& model, double dt, Profile& profile) {
  model.slowForce.assign(model.discrete.particles.size(), {});
  model.discrete.particles.f.swap(model.slowForce);
  couplingForces(model, 0.5 * dt, {}, profile);
  model.discrete.particles.f.swap(model.slowForce);
}

void stepParticles(Model& model, double dt, int K, StepSums& sums, Profile& profile) {
  const Driven before = driven(model);
  for (int k = 0; k < K; ++k) {
    dem::move(model.discrete, dt);
    particleForces(model, dt, sums, profile);
    dem::close(model.discrete);
  }
  bookDrives(model, before, sums);
}

/// One step under a constant load; what the supports gave is read off the change of momentum.
void stepSolid(Model& model, fem::ImplicitMotion& solid, double dt, std::span<const Vec3> load, bool withEnergy,
               StepSums& sums, Profile& profile) {
  Profile::Stage stage(profile, "solid step");
  fem::Nodes& nodes = model.solid->nodes();
  const Vec3 before = fem::momentum(nodes);
  if (!load.empty()) solid.kick(load, 0.5 * dt);
  solid.step(dt);
  if (!load.empty()) solid.kick(load, 0.5 * dt);
  Vec3 impulse = fem::momentum(nodes) - before;
  for (const Vec3& f : load) impulse -= dt * f;
  sums.supportImpulse += impulse;
  if (withEnergy) model.solid->strainEnergy = fem::storedEnergy(model.solid->model(), {model.solid->model().t, 0.0});
}

}  // namespace

void stepImplicit(Model& model, fem::ImplicitMotion& solid, double dt, int K, StepSums& sums, bool withEnergy,
                  Profile& profile) {
  const std::vector<Vec3> load = gravityLoad(model);
  if (model.coupling && model.slowForce.size() != model.discrete.particles.size()) {
    particleForces(model, dt, sums, profile);  // start() left the coupling's share in the particles' forces
    separateCouplingForces(model, K * dt, profile);
  }
  if (model.coupling) kickByCoupling(model, 0.5 * K * dt, sums);
  const std::vector<Vec3> x = model.discrete.particles.x, u = model.solid->nodes().u;
  stepParticles(model, dt, K, sums, profile);
  stepSolid(model, solid, K * dt, load, withEnergy, sums, profile);
  if (!model.coupling) return;
  advanceGap(model, 1.0, difference(model.discrete.particles.x, x), difference(model.solid->nodes().u, u));
  separateCouplingForces(model, K * dt, profile);
  sums.couplingWork += couplingWorkOfStep(*model.coupling);
  kickByCoupling(model, 0.5 * K * dt, sums);
}

void stepStaggered(Model& model, fem::ImplicitMotion& solid, double dt, StepSums& sums, bool withEnergy,
                   Profile& profile) {
  Coupling& c = *model.coupling;
  if (model.slowForce.size() != model.discrete.particles.size()) particleForces(model, dt, sums, profile);
  separateCouplingForces(model, dt, profile);  // of the last step's increments
  const std::vector<Vec3> x = model.discrete.particles.x, u = model.solid->nodes().u;
  std::vector<Vec3> load = gravityLoad(model);
  load.resize(u.size());
  for (std::size_t n = 0; n < load.size(); ++n) load[n] += c.nodeForce[n];
  stepSolid(model, solid, dt, load, withEnergy, sums, profile);
  const auto kickByFrozen = [&] {
    for (std::size_t i = 0; i < model.slowForce.size(); ++i)
      model.discrete.particles.v[i] += (0.5 * dt / model.discrete.particles.mass[i]) * model.slowForce[i];
  };
  kickByFrozen();
  stepParticles(model, dt, 1, sums, profile);
  kickByFrozen();
  advanceGap(model, 1.0, difference(model.discrete.particles.x, x), difference(model.solid->nodes().u, u));
  for (std::size_t r = 0; r < c.rows(); ++r) sums.couplingWork -= dot(c.lambda[r], c.increment[r]);
}

}  // namespace dovetail::arlequin
