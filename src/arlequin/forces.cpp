#include "forces.hpp"

#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/model/loads.hpp"

namespace dovetail::arlequin::detail {

void kickSolid(Solid& solid, std::span<const Vec3> acceleration, double dt) { solid.motion().kick(acceleration, dt); }

Vec3 supportImpulse(const Solid& solid, std::span<const Vec3> acceleration, std::span<const Vec3> force, double dt) {
  return dt * solid.motion().supportForce(acceleration, force);
}

void weighNewContacts(Model& model) {
  if (!model.coupling || model.weighedRevision == model.discrete.pairs.revision()) return;
  weighContacts(model.discrete.particles, model.solid->mesh, model.solid->nodes(), model.coupling->overlap,
                model.discrete.pairs);
  model.weighedRevision = model.discrete.pairs.revision();
}

Driven driven(const Model& model) {
  Driven sum{model.discrete.booked.walls, {}};
  for (const auto* drive : model.discrete.terms.all<dem::DriveTerm>()) sum.impulse += drive->supportImpulse;
  return sum;
}

void bookDrives(const Model& model, const Driven& before, StepSums& sums) {
  const Driven now = driven(model);
  sums.externalWork += now.work - before.work;
  sums.supportImpulse += now.impulse - before.impulse;
}

void particleForces(Model& model, double dt, StepSums& sums, Profile& profile) {
  Profile::Stage stage(profile, "particle contacts");
  const double lostBefore = model.discrete.work.lostPower();
  dem::renew(model.discrete);
  weighNewContacts(model);
  dem::addForces(model.discrete);
  sums.dissipated += 0.5 * dt * (lostBefore + model.discrete.work.lostPower());
}

void internalForces(Model& model, bool withEnergy, Profile& profile) {
  Profile::Stage stage(profile, "solid forces");
  Solid& solid = *model.solid;
  fem::Nodes& nodes = solid.nodes();
  const double energy = solid.motion().forces(0.0, withEnergy);
  if (squaredNorm(model.discrete.gravity) > 0.0)
    for (std::size_t n = 0; n < nodes.f.size(); ++n) nodes.f[n] += nodes.mass[n] * model.discrete.gravity;
  if (withEnergy) solid.strainEnergy = energy;
  solid.internalForce = nodes.f;
}

void advanceGap(Model& model, double dt, std::span<const Vec3> particleMotion, std::span<const Vec3> nodeMotion) {
  Coupling& c = *model.coupling;
  gapOf(c.gap, c.overlap, particleMotion, nodeMotion, c.increment);
  for (std::size_t r = 0; r < c.rows(); ++r) {
    c.increment[r] *= dt;
    c.gapNow[r] += c.increment[r];
  }
}

void couplingForces(Model& model, double dt, std::span<const Vec3> solidForce, Profile& profile) {
  Profile::Stage stage(profile, "coupling");
  Coupling& c = *model.coupling;
  Solid& solid = *model.solid;
  if (c.absorber) c.absorber->apply(model.discrete.particles.v, model.discrete.particles.f);
  std::vector<Vec3> velocity, acceleration;
  if (c.constraint->needsRates()) {
    velocity.resize(c.rows());
    acceleration.resize(c.rows());
    gapOf(c.gap, c.overlap, model.discrete.particles.v, solid.nodes().v, velocity);
    std::vector<Vec3> ofParticles(model.discrete.particles.size());
    for (const int i : c.overlap.particle)
      ofParticles[static_cast<std::size_t>(i)] = (1.0 / model.discrete.particles.mass[static_cast<std::size_t>(i)]) *
                                                 model.discrete.particles.f[static_cast<std::size_t>(i)];
    std::vector<Vec3> ofNodes(solidForce.begin(), solidForce.end());
    if (ofNodes.empty())
      ofNodes.assign(solid.nodes().X.size(), {});
    else
      solid.motion().accelerate(ofNodes);
    gapOf(c.gap, c.overlap, ofParticles, ofNodes, acceleration);
  }
  c.lambdaBefore.swap(c.lambda);
  c.constraint->evaluate({c.gapNow, c.increment, velocity, acceleration, dt}, c.lambda);
  pullParticles(c.gap, c.overlap, c.lambda, model.discrete.particles.f);
  for (const int n : c.gap.coupledNode) c.nodeForce[static_cast<std::size_t>(n)] = {};
  pullNodes(c.gap, c.lambda, c.nodeForce);
}

double couplingWorkOfStep(const Coupling& c) {
  double sum = 0.0;
  for (std::size_t r = 0; r < c.rows(); ++r) sum -= 0.5 * dot(c.lambda[r] + c.lambdaBefore[r], c.increment[r]);
  return sum;
}

}  // namespace dovetail::arlequin::detail
