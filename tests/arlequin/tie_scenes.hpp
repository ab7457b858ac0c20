// A run of particles, a solid and an overlap, and scenes for it.
#pragma once

#include <cmath>
#include <functional>
#include <memory>

#include "dovetail/arlequin/arlequin_coupling.hpp"
#include "dovetail/arlequin/constraint.hpp"
#include "dovetail/coupling/run.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/motion/motion.hpp"
#include "scenes.hpp"

namespace dovetail::arlequin::test {

/// A wave in the grains, with a stretch that grows along them.
inline void excite(dem::Particles& particles) {
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const double y = particles.x[i].y;
    if (y < 0.5) particles.v[i] = {0.002 * y, 0.1 * std::sin(2.0 * 3.14159265 * y), 0.001};
  }
}

/// A coupled run with one solid and one tie, and what the supports of the solid do.
struct TieRun {
  std::unique_ptr<coupling::CoupledRun> run = std::make_unique<coupling::CoupledRun>();
  dem::Model& grains = run->grains;
  fem::Model* solid = nullptr;
  coupling::SolidSide* side = nullptr;
  ArlequinCoupling* tie = nullptr;
  coupling::SolidOptions options{.name = "solid"};
  int K = 1;

  void take(fem::Model model) {
    owned_ = std::make_unique<fem::Model>(std::move(model));
    solid = owned_.get();
  }
  void couple(const fem::SolidMesh& mesh, const std::vector<double>& weight, const CouplingOptions& coupling) {
    grains.refusesUnstableSteps = false;  // the tests choose
    side = &run->addSolid(std::move(owned_), options);
    tie = &grains.terms.add(makeArlequinCoupling(grains, mesh, weight, *side, coupling));
  }

  void start(double dt = 1e-4) { run->start(dt, {.stepsPerMacroStep = K}); }
  /// A macro step.
  void step(double dt) {
    if (dt != run->dt()) start(dt);
    run->advance();
  }
  double solidKinetic() const { return side->mass->kineticEnergy(solid->nodes.v); }
  double energy() const { return run->ledger().stored() + run->ledger().booked(); }
  /// What entered and left taken into account.
  Vec3 momentum() const {
    const coupling::Totals totals = run->totals();
    return totals.momentum - totals.given.total().given.linear;
  }
  double mass() const { return run->totals().mass + grains.left.mass - grains.entered.mass; }

private:
  std::unique_ptr<fem::Model> owned_;
};

/// A bar in cells of any shape. @param place  changes the places of the particles, whose contacts are the lattice's
inline TieRun tieBar(const SceneOptions& o, fem::ElementShape shape = fem::ElementShape::hex8,
                     coupling::Stepping stepping = coupling::Stepping::explicitSteps,
                     const std::function<void(Vec3&)>& place = {}) {
  const double half = 0.5 * o.across * edge, d = edge / o.particlesPerEdge;
  TieRun run;
  run.grains.particles = lattice({-half, 0.0, -half}, {half, particleEnd(o), half}, o.particlesPerEdge);
  run.grains.pairs.setSkin(0.1 * d);
  dem::ElasticLaw law;
  law.normal.stiffness = modulus * d;
  law.normal.bonded = true;
  run.grains.laws = dem::makeContactLaws(law);
  run.grains.sortEvery = 0;
  dem::findPairs(run.grains.particles, run.grains.pairs);
  for (Vec3& x : run.grains.particles.x)
    if (place) place(x);
  const fem::SolidMesh mesh = fem::boxOf(shape, {o.across, o.solidElements, o.across}, {-half, solidStart(o), -half},
                                         {half, solidStart(o) + o.solidElements * edge, half});
  std::vector<double> weight = barWeights(mesh, o);
  levelMidNodes(mesh, weight);
  run.take(fem::makeModel(mesh));
  if (o.holdEnd) fem::fix(run.solid->nodes, fem::nodeSet(mesh, "y+"));
  const fem::StVenantKirchhoff law3{modulus, 0.0, bulk};
  run.solid->add(fem::makeSolid(mesh, fem::pointMaterial(fem::Material(law3)), {.fraction = solidWeights(weight)}));
  run.options.stepping = stepping;
  run.options.massFraction = o.massFraction;
  CouplingOptions coupling = o.coupling;
  coupling.leastWeight = std::clamp(o.weights.floor, 1e-9, coupling.leastWeight);
  run.couple(mesh, weight, coupling);
  return run;
}

/// The parts of a bar for who looks at them one by one.
struct Bar {
  TieRun run;
  fem::SolidMesh mesh;
  dem::Particles particles;  // of the run, their masses weighted
  std::vector<double> fullMass;
  std::unique_ptr<fem::Motion> motion;
  Overlap overlap;
  GapOperator gap;
  std::unique_ptr<Constraint> constraint;

  std::size_t rows() const { return gap.rows(); }
  const fem::Nodes& nodes() const { return run.solid->nodes; }
  fem::Nodes& nodes() { return run.solid->nodes; }
  const fem::ModelMass& mass() const { return motion->mass(); }
};

inline Bar makeBar(const SceneOptions& o) {
  Bar bar{tieBar(o), barMesh(o), {}, {}, nullptr, {}, {}, nullptr};
  bar.run.tie->neighbourListUpdated(bar.run.grains);
  bar.particles = bar.run.grains.particles;
  bar.fullMass = bar.particles.mass;
  for (std::size_t i = 0; i < bar.fullMass.size(); ++i) bar.particles.mass[i] *= bar.particles.weightOf(i);
  bar.motion = std::make_unique<fem::Motion>(*bar.run.solid, o.massFraction);
  bar.overlap = bar.run.tie->overlap();
  bar.gap = makeGapOperator(bar.overlap, bar.mesh, bar.fullMass, o.coupling.form, o.coupling.projection);
  const double p = o.coupling.penalty > 0.0 ? o.coupling.penalty : automaticPenalty(modulus, edge);
  if (o.coupling.constraint == ConstraintKind::multiplier)
    bar.constraint = makeMultiplier(bar.gap, bar.overlap, bar.particles.mass, bar.mass());
  else if (o.coupling.constraint == ConstraintKind::dashpot)
    bar.constraint = makeDashpot(bar.gap, p, o.coupling.consistentDashpot);
  else if (o.coupling.projection.width > 0.0)
    bar.constraint =
        makeMetricPenalty(bar.gap, std::vector<double>(bar.overlap.size(), std::pow(edge / o.particlesPerEdge, 3)), p);
  else {
    std::vector<double> stiffness = bar.gap.volume;
    for (double& value : stiffness) value *= p;
    bar.constraint = makePenalty(std::move(stiffness));
  }
  return bar;
}

}  // namespace dovetail::arlequin::test
