#include "forces.hpp"

#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/pairs/pair_collide.hpp"

namespace dovetail::arlequin::detail {

void kickSolid(Solid& solid, std::span<const Vec3> acceleration, double dt) {
  for (std::size_t n = 0; n < solid.nodes.v.size(); ++n) solid.nodes.v[n] += dt * acceleration[n];
}

void accelerate(const Solid& solid, std::span<Vec3> f) {
  if (solid.mass) return solid.mass->solve(f);
  const fem::Nodes& nodes = solid.nodes;
  for (std::size_t n = 0; n < f.size(); ++n) {
    f[n] *= 1.0 / nodes.mass[n];
    if (nodes.fixed[n] == 0) continue;
    for (int c = 0; c < 3; ++c)
      if (nodes.fixed[n] >> c & 1) f[n][c] = 0.0;
  }
}

Vec3 supportImpulse(const Solid& solid, std::span<const Vec3> acceleration, std::span<const Vec3> force, double dt) {
  if (solid.mass) return dt * solid.mass->supportForce(acceleration, force);
  Vec3 sum;
  for (std::size_t n = 0; n < force.size(); ++n)
    for (int c = 0; c < 3; ++c)
      if (solid.nodes.fixed[n] >> c & 1) sum[c] -= dt * force[n][c];
  return sum;
}

namespace {

void followDrive(Model& model, const Drive& drive, double dt, bool firstHalf, std::span<const Vec3> before,
                 StepSums& sums) {
  dem::Particles& particles = model.particles;
  const double step = 2.0 * dt;
  const Vec3 prescribed = firstHalf
                              ? (1.0 / step) * (drive.displacement(model.time + step) - drive.displacement(model.time))
                              : drive.velocity(model.time);
  for (std::size_t k = 0; k < drive.particles.size(); ++k) {
    const auto i = static_cast<std::size_t>(drive.particles[k]);
    const Vec3 impulse = particles.mass[i] * (prescribed - particles.v[i]);
    // Over a step both halves act while the particle moves at the mean velocity, which is that of the first half's end
    // and of the second half's beginning.
    sums.externalWork += dot(impulse, firstHalf ? prescribed : before[k]);
    sums.supportImpulse += impulse;
    particles.v[i] = prescribed;
  }
}

}  // namespace

void kickParticles(Model& model, double dt, bool firstHalf, StepSums& sums) {
  std::vector<std::vector<Vec3>> before;
  for (const Drive& drive : model.drives) {
    before.emplace_back();
    for (const int i : drive.particles) before.back().push_back(model.particles.v[static_cast<std::size_t>(i)]);
  }
  dem::kick(model.particles, dt);
  for (std::size_t d = 0; d < before.size(); ++d) followDrive(model, model.drives[d], dt, firstHalf, before[d], sums);
}

void particleForces(Model& model, double dt, StepSums& sums, Profile& profile) {
  Profile::Stage stage(profile, "particle contacts");
  const double lostBefore = model.contact.lostPower();
  dem::clearForces(model.particles);
  if (squaredNorm(model.gravity) > 0.0) dem::applyGravity(model.particles, model.gravity);
  const bool bonded = std::visit([](const auto& law) { return law.normal.bonded; }, model.law);
  if (!bonded) dem::updatePairs(model.particles, model.pairs);
  if (model.coupling && model.weighedRevision != model.pairs.revision) {
    weighContacts(model.particles, model.solid->mesh.elements, model.solid->nodes, model.coupling->overlap,
                  model.pairs);
    model.weighedRevision = model.pairs.revision;
  }
  model.contact =
      std::visit([&](const auto& law) { return dem::collide(model.particles, model.pairs, law, dt); }, model.law);
  sums.dissipated += 0.5 * dt * (lostBefore + model.contact.lostPower());
}

void internalForces(Model& model, bool withEnergy, Profile& profile) {
  Profile::Stage stage(profile, "solid forces");
  Solid& solid = *model.solid;
  fem::Nodes& nodes = solid.nodes;
  fem::clearForces(nodes);
  if (squaredNorm(model.gravity) > 0.0)
    for (std::size_t n = 0; n < nodes.f.size(); ++n) nodes.f[n] = nodes.mass[n] * model.gravity;
  const double energy = fem::addInternalForces(solid.elements, nodes, withEnergy);
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
  if (c.absorber) c.absorber->apply(model.particles.v, model.particles.f);
  std::vector<Vec3> velocity, acceleration;
  if (c.constraint->needsRates()) {
    velocity.resize(c.rows());
    acceleration.resize(c.rows());
    gapOf(c.gap, c.overlap, model.particles.v, solid.nodes.v, velocity);
    std::vector<Vec3> ofParticles(model.particles.size());
    for (const int i : c.overlap.particle)
      ofParticles[static_cast<std::size_t>(i)] =
          (1.0 / model.particles.mass[static_cast<std::size_t>(i)]) * model.particles.f[static_cast<std::size_t>(i)];
    std::vector<Vec3> ofNodes(solidForce.begin(), solidForce.end());
    if (ofNodes.empty())
      ofNodes.assign(solid.nodes.X.size(), {});
    else
      accelerate(solid, ofNodes);
    gapOf(c.gap, c.overlap, ofParticles, ofNodes, acceleration);
  }
  c.lambdaBefore.swap(c.lambda);
  c.constraint->evaluate({c.gapNow, c.increment, velocity, acceleration, dt}, c.lambda);
  pullParticles(c.gap, c.overlap, c.lambda, model.particles.f);
  for (const int n : c.gap.coupledNode) c.nodeForce[static_cast<std::size_t>(n)] = {};
  if (c.stress) std::fill(c.nodeForce.begin(), c.nodeForce.end(), Vec3{});
  pullNodes(c.gap, c.lambda, c.nodeForce);
  if (c.stress) c.stress->apply(model.particles, solid.nodes, model.particles.f, c.nodeForce);
}

double couplingWorkOfStep(const Coupling& c) {
  double sum = 0.0;
  for (std::size_t r = 0; r < c.rows(); ++r) sum -= 0.5 * dot(c.lambda[r] + c.lambdaBefore[r], c.increment[r]);
  return sum;
}

}  // namespace dovetail::arlequin::detail
