#include "dovetail/arlequin/stepper.hpp"

#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "forces.hpp"

namespace dovetail::arlequin {

using namespace detail;

namespace {

/// Acceleration of the solid by the forces that act at every step: all of them, or the coupling alone.
void accelerateSolid(Model& model, bool withInternal) {
  Solid& solid = *model.solid;
  if (withInternal)
    solid.acceleration = solid.internalForce;
  else
    solid.acceleration.assign(solid.nodes().X.size(), {});
  if (model.coupling)
    for (const int n : model.coupling->gap.coupledNode)
      solid.acceleration[static_cast<std::size_t>(n)] += model.coupling->nodeForce[static_cast<std::size_t>(n)];
  solid.nodes().f = solid.acceleration;
  solid.motion().accelerate(solid.acceleration);
}

/// Elastic acceleration of a window of several steps; with multipliers it is made to comply with the constraint, which
/// moves particles too.
void accelerateSlowly(Model& model, double window) {
  Solid& solid = *model.solid;
  solid.slowAcceleration = solid.internalForce;
  if (model.coupling && model.coupling->constraint->needsRates()) {
    Coupling& c = *model.coupling;
    std::vector<Vec3> acceleration(c.rows()), none(c.rows()), lambda(c.rows());
    std::vector<Vec3> still(model.discrete.particles.size()), ofNodes = solid.internalForce;
    solid.motion().accelerate(ofNodes);
    gapOf(c.gap, c.overlap, still, ofNodes, acceleration);
    c.constraint->evaluate({c.gapNow, none, none, acceleration, window}, lambda);
    model.slowForce.assign(model.discrete.particles.size(), {});
    pullParticles(c.gap, c.overlap, lambda, model.slowForce);
    pullNodes(c.gap, lambda, solid.slowAcceleration);
  }
  solid.motion().accelerate(solid.slowAcceleration);
}

void kickSlowly(Model& model, double dt, StepSums& sums) {
  kickSolid(*model.solid, model.solid->slowAcceleration, dt);
  sums.supportImpulse += supportImpulse(*model.solid, model.solid->slowAcceleration, model.solid->internalForce, dt);
  for (std::size_t i = 0; i < model.slowForce.size(); ++i)
    model.discrete.particles.v[i] += (dt / model.discrete.particles.mass[i]) * model.slowForce[i];
}

void kickSolidByAll(Model& model, double dt, StepSums& sums) {
  if (!model.solid) return;
  kickSolid(*model.solid, model.solid->acceleration, dt);
  sums.supportImpulse += supportImpulse(*model.solid, model.solid->acceleration, model.solid->nodes().f, dt);
}

void moveAll(Model& model, double dt, StepSums& sums, Profile& profile) {
  Profile::Stage stage(profile, "kick and drift");
  dem::move(model.discrete, dt);
  kickSolidByAll(model, 0.5 * dt, sums);
  if (model.solid) model.solid->motion().drift(dt);
}

void closeAll(Model& model, double dt, StepSums& sums, Profile& profile) {
  Profile::Stage stage(profile, "kick and drift");
  dem::close(model.discrete);
  kickSolidByAll(model, 0.5 * dt, sums);
}

/// See stepExplicit; V''v by the difference of the forces over the window.
double splittingEnergy(const Solid& solid, std::span<const Vec3> forceBefore, std::span<const Vec3> uBefore, double h) {
  double sum = 0.0;
  for (std::size_t n = 0; n < uBefore.size(); ++n) {
    const Vec3& force = solid.internalForce[n];
    sum -= dot(force - forceBefore[n], solid.nodes().u[n] - uBefore[n]) / 12.0;
    sum -= h * h * dot(force, solid.acceleration[n] / 12.0 + solid.slowAcceleration[n] / 24.0);
  }
  return sum;
}

void bookCoupling(Model& model, double dt, StepSums& sums) {
  sums.couplingWork += couplingWorkOfStep(*model.coupling);
  if (model.coupling->absorber) sums.absorbed += model.coupling->absorber->workOfStep(model.discrete.particles.v, dt);
}

}  // namespace

void start(Model& model, double dt, Profile& profile) {
  if (model.coupling && !model.solid)
    throw InputError("there is a coupling but no solid", "start", "give the solid, or leave the coupling out");
  if (model.coupling && model.coupling->fullMass.size() != model.discrete.particles.size())
    throw InputError("the coupling was made for " + std::to_string(model.coupling->fullMass.size()) +
                         " particles and there are " + std::to_string(model.discrete.particles.size()),
                     "start", "make the coupling after the last particle was added");
  dem::requirePlain(model.discrete, "volume coupling");
  model.weighedRevision = model.discrete.pairs.revision();
  dem::findForces(model.discrete);
  if (!model.solid) return;
  internalForces(model, true, profile);
  if (model.coupling) couplingForces(model, dt, model.solid->internalForce, profile);
  accelerateSolid(model, true);
}

void stepExplicit(Model& model, double dt, int K, StepSums& sums, bool withEnergy, Profile& profile) {
  const bool windows = model.solid && K > 1;
  std::vector<Vec3> forceBefore, uBefore;
  if (windows) {
    if (withEnergy) forceBefore = model.solid->internalForce;
    if (withEnergy) uBefore = model.solid->nodes().u;
    accelerateSlowly(model, K * dt);
    accelerateSolid(model, false);
    kickSlowly(model, 0.5 * K * dt, sums);
  }
  const Driven before = driven(model);
  for (int k = 0; k < K; ++k) {
    const bool last = k == K - 1;
    moveAll(model, dt, sums, profile);
    if (model.coupling) {
      Profile::Stage stage(profile, "coupling");
      advanceGap(model, dt, model.discrete.particles.v, model.solid->nodes().v);
    }
    particleForces(model, dt, sums, profile);
    if (model.solid && last) internalForces(model, withEnergy, profile);
    if (model.coupling) {
      couplingForces(model, dt, windows ? std::span<const Vec3>{} : model.solid->internalForce, profile);
      bookCoupling(model, dt, sums);
    }
    if (model.solid) {
      Profile::Stage stage(profile, "solid mass");
      accelerateSolid(model, !windows);
    }
    closeAll(model, dt, sums, profile);
  }
  bookDrives(model, before, sums);
  if (windows) {
    accelerateSlowly(model, K * dt);
    kickSlowly(model, 0.5 * K * dt, sums);
    if (withEnergy) model.solid->splittingEnergy = splittingEnergy(*model.solid, forceBefore, uBefore, K * dt);
  }
}

void relocate(Model& model, StepSums& sums) {
  if (!model.coupling) return;
  const double elastic = model.discrete.work.storedEnergy();
  const Handover handover = renew(*model.coupling, model.discrete.particles, model.discrete.pairs, *model.solid);
  model.weighedRevision = model.discrete.pairs.revision();
  constexpr double noTime = 1e-100;  // s: memories stay
  dem::Particles particles = model.discrete.particles;
  dem::PairList pairs = model.discrete.pairs;
  const auto contact = model.discrete.laws->pairs(particles, pairs, noTime, dem::Booking::on);
  model.discrete.work.elasticEnergy = contact.elasticEnergy;
  sums.handedOver += handover.energy + elastic - model.discrete.work.storedEnergy();
  sums.handedMomentum += handover.momentum;
}

Energies energies(const Model& model, const fem::ImplicitMotion* solid) {
  Energies e;
  e.kineticParticles = dem::kineticEnergy(model.discrete.particles);
  e.elasticContacts = model.discrete.work.storedEnergy();
  for (std::size_t i = 0; i < model.discrete.particles.size(); ++i)
    e.gravity -= model.discrete.particles.mass[i] * dot(model.discrete.gravity, model.discrete.particles.x[i]);
  if (model.solid) {
    const fem::Nodes& nodes = model.solid->nodes();
    e.kineticSolid = solid ? solid->kineticEnergy() : model.solid->motion().kineticEnergy();
    e.elasticSolid = model.solid->strainEnergy;
    e.splitting = model.solid->splittingEnergy;
    for (std::size_t n = 0; n < nodes.X.size(); ++n)
      e.gravity -= nodes.mass[n] * dot(model.discrete.gravity, nodes.X[n] + nodes.u[n]);
  }
  if (model.coupling) e.coupling = model.coupling->storedEnergy();
  return e;
}

Vec3 momentum(const Model& model) {
  Vec3 sum = dem::momentum(model.discrete.particles);
  if (model.solid) sum += fem::momentum(model.solid->nodes());
  return sum;
}

void requireFinite(const Model& model, const std::string& when) {
  dem::requireFinite(model.discrete.particles, when);
  if (model.solid) dovetail::requireFinite(model.solid->nodes().v, "node", "velocity", when);
}

}  // namespace dovetail::arlequin
