#include "dovetail/arlequin/coupling.hpp"

#include <map>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::arlequin {

namespace {

/// By rows for the local map and for the nodal form; wide kernels at the particles need the metric of their rows.
std::unique_ptr<Constraint> penaltyFor(const Coupling& c, double penalty) {
  if (penaltyIsLocal(c.options)) {
    std::vector<double> stiffness = c.gap.volume;
    for (double& value : stiffness) value *= requirePositive(penalty, "penalty");
    return makePenalty(std::move(stiffness));
  }
  double mass = 0.0, volume = 0.0;
  for (const int i : c.overlap.particle) mass += c.fullMass[static_cast<std::size_t>(i)];
  for (const double v : c.gap.volume) volume += v;
  std::vector<double> share;
  for (const int i : c.overlap.particle) share.push_back(volume * c.fullMass[static_cast<std::size_t>(i)] / mass);
  return makeMetricPenalty(c.gap, share, penalty);
}

std::unique_ptr<Constraint> makeConstraint(const Coupling& c, const dem::Particles& particles, const Solid& solid) {
  const CouplingOptions& o = c.options;
  const double automatic =
      automaticPenalty(fem::youngsModulus(solid.material()), elementSize(solid.mesh, c.overlap.elements.front()));
  switch (o.constraint) {
    case ConstraintKind::penalty:
      return penaltyFor(c, o.penalty == 0.0 ? automatic : o.penalty);
    case ConstraintKind::dashpot:
      return makeDashpot(c.gap, o.penalty, o.consistentDashpot);
    case ConstraintKind::multiplier:
      return makeMultiplier(c.gap, c.overlap, particles.mass, solid.motion().mass());
  }
  throw InputError("there is no such constraint", "coupling", "take penalty, multiplier or dashpot");
}

/// How far outside of the mesh particles take part, m.
double reachOf(const CouplingOptions& o) { return o.projection.reachOut ? o.projection.width : 0.0; }

void setUp(Coupling& c, dem::Particles& particles, dem::PairList& pairs, const Solid& solid) {
  weighMass(c.overlap, c.fullMass, particles);
  weighContacts(particles, solid.mesh, solid.nodes(), c.overlap, pairs);
  c.gap = makeGapOperator(c.overlap, solid.mesh, c.fullMass, c.options.form, c.options.projection,
                          positionsOf(solid.nodes().X, solid.nodes().u));
  c.constraint = makeConstraint(c, particles, solid);
  if (c.options.absorberRate > 0.0)
    c.absorber = std::make_unique<Absorber>(c.overlap, c.gap, interpolationAtParticles(c.overlap, solid.mesh),
                                            particles.mass, c.options.absorberRate);
  c.increment.assign(c.rows(), {});
  c.nodeForce.assign(solid.nodes().X.size(), {});
}

}  // namespace

bool penaltyIsLocal(const CouplingOptions& options) {
  return options.projection.width == 0.0 || options.form == GapForm::nodal;
}

double Coupling::storedEnergy() const { return constraint->storedEnergy(gapNow); }

Coupling makeCoupling(dem::Particles& particles, dem::PairList& pairs, const Solid& solid,
                      std::span<const double> nodalWeight, const CouplingOptions& options) {
  requireNonNegative(options.penalty, "penalty");
  requireNonNegative(options.absorberRate, "absorber");
  Coupling c;
  c.options = options;
  c.fullMass = particles.mass;
  c.overlap = locateOverlap(particles, solid.mesh, solid.nodes(), nodalWeight, reachOf(options), pairs.periodicity());
  requireWidth(c.overlap, solid.mesh);
  setUp(c, particles, pairs, solid);
  c.gapNow.assign(c.rows(), {});
  c.lambda.assign(c.rows(), {});
  c.lambdaBefore = c.lambda;
  return c;
}

Handover renew(Coupling& c, dem::Particles& particles, dem::PairList& pairs, const Solid& solid) {
  if (c.options.projection.perElement)
    throw InputError("rows per element are not followed through a renewal", "renew", "take one row per node");
  const std::vector<int> oldNode = c.gap.node;
  const std::vector<Vec3> oldGap = c.gapNow, oldLambda = c.lambda;
  Handover handover;
  handover.energy = dem::kineticEnergy(particles) + c.storedEnergy();
  handover.momentum = dem::momentum(particles);
  c.overlap = locateOverlap(particles, solid.mesh, solid.nodes(), c.overlap.nodalWeight, reachOf(c.options),
                            pairs.periodicity());
  setUp(c, particles, pairs, solid);
  std::map<int, std::size_t> rowOf;
  for (std::size_t r = 0; r < oldNode.size(); ++r) rowOf[oldNode[r]] = r;
  c.gapNow.assign(c.rows(), {});
  c.lambda.assign(c.rows(), {});
  for (std::size_t r = 0; r < c.rows(); ++r)
    if (const auto found = rowOf.find(c.gap.node[r]); found != rowOf.end()) {
      c.gapNow[r] = oldGap[found->second];
      c.lambda[r] = oldLambda[found->second];
    }
  c.lambdaBefore = c.lambda;
  handover.energy -= dem::kineticEnergy(particles) + c.storedEnergy();
  handover.momentum -= dem::momentum(particles);
  return handover;
}

}  // namespace dovetail::arlequin
