#include "equilibrium.hpp"

#include <algorithm>
#include <cmath>

namespace dovetail::disordered_overlap {

namespace {

SolidPlace placeOf(const EquilibriumOptions& s) {
  return {.width = s.size.width,
          .bottom = -s.below * s.element,
          .border = (s.solid - s.overlap) * s.element,
          .top = s.solid * s.element,
          .element = s.element,
          .across = 2};
}

Elastic elasticOf(const dem::Model& packing, const EquilibriumOptions& s) {
  const double density = bulkDensity(packing.particles, s.size.width, grain::diameter, s.solid * s.element);
  return {density, 0.25 * grain::stiffness / grain::diameter, 0.2};
}

double elastic(coupling::CoupledRun& run) {
  const EnergyLedger& l = run.ledger();
  return l.joules("particles: contacts") + l.joules("solid: elastic") + l.joules("overlap: stored");
}

}  // namespace

Corrected runCorrected(const dem::Model& packing, const EquilibriumOptions& s) {
  const SolidPlace place = placeOf(s);
  const auto column = joinSolid(packing, 0, place, elasticOf(packing, s), {});
  coupling::CoupledRun& run = column->run;
  startWith(run, s.weight);
  const RestReport rest = coupling::relax(run, {.tolerance = s.rest, .steps = 40000});
  Corrected result;
  result.atRest = rest.atRest;
  result.rounds = column->rounds;
  result.macroSteps = rest.steps;
  const double stored = elastic(run);
  result.broughtToRest = run.ledger().joules("kinetic damping") / stored;
  result.layers = layersOf(*column, place);
  const double residual = run.ledger().residual();
  const std::vector<Vec3> x = run.grains.particles.x;
  const std::int64_t looks = 100;
  for (std::int64_t look = 0; look < looks; ++look) {
    run.advance(s.steps / looks);
    result.kinetic = std::max(result.kinetic, run.kineticEnergy() / stored);
  }
  result.residual = (run.ledger().residual() - residual) / stored;
  for (std::size_t i = 0; i < x.size() && run.grains.particles.size() == x.size(); ++i)
    result.moved = std::max(result.moved, norm(run.grains.particles.x[i] - x[i]) / grain::diameter);
  const std::vector<LayerStress> after = layersOf(*column, place);
  const dem::Particles& p = packing.particles;
  for (std::size_t k = 0; k < after.size(); ++k) {
    result.stressDrift = std::max(result.stressDrift, std::abs(after[k].carried() / result.layers[k].carried() - 1.0));
    result.packingAbove.push_back(weightAbove(p, s.size.width, after[k].lower, after[k].upper));
  }
  result.meanDensity = bulkDensity(p, s.size.width, grain::diameter, 0.8 * s.size.height);
  result.surface = weightAbove(p, s.size.width, -1.0, 0.0) / (standardGravity * result.meanDensity);
  return result;
}

Start peakWithout(const dem::Model& packing, const EquilibriumOptions& s, bool initialEquilibrium) {
  constexpr int looks = 400, steps = 10;
  const auto column =
      joinSolid(packing, 0, placeOf(s), elasticOf(packing, s), {.initialEquilibrium = initialEquilibrium});
  startWith(column->run, s.weight);
  Start start;
  for (int look = 0; look < looks; ++look) {
    column->run.advance(steps);
    const double kinetic = column->run.kineticEnergy();
    start.joules = std::max(start.joules, kinetic);
    start.overElastic = std::max(start.overElastic, kinetic / elastic(column->run));
  }
  return start;
}

}  // namespace dovetail::disordered_overlap
