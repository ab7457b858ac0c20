// Runs that come to rest.
#include "dovetail/coupling/rest.hpp"

#include <algorithm>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/setup/relax.hpp"
#include "run_impl.hpp"

namespace dovetail::coupling {

double CoupledRun::kineticEnergy() const {
  double sum = dem::kineticEnergy(grains);
  for (const auto& solid : impl_->solids) sum += solid->kineticEnergy();
  return sum;
}

void CoupledRun::damp(bool on) {
  impl_->requireStarted("damp");
  const auto constrained = [&](const SolidSide& side) {
    return std::ranges::any_of(grains.terms.all<Connector>(), [&](const auto* connector) {
      return connector->constrains() && &connector->side() == &side;
    });
  };
  // Constraints answer the average acceleration: other schemes keep them in motion.
  for (const auto& solid : impl_->solids) solid->damp(on && !constrained(solid->side));
}

void CoupledRun::stop() {
  dem::close(grains);
  impl_->broughtToRest += kineticEnergy();
  const Totals before = impl_->sums();
  dem::stop(grains);
  for (const auto& solid : impl_->solids) std::ranges::fill(solid->side.nodes().v, Vec3{});
  impl_->broughtToRest -= kineticEnergy();
  impl_->reportVelocities();
  const Totals after = impl_->sums();
  impl_->outside.given.give("kinetic damping",
                            {after.momentum - before.momentum, after.angularMomentum - before.angularMomentum});
}

/// Of contacts, elements, material points, gradients and connectors, J: neither of weights nor of loads, whose zero is
/// anywhere.
static double elasticEnergy(CoupledRun& run) {
  double sum = dem::energies(run.grains).contacts;
  for (const auto* connector : run.grains.terms.all<Connector>()) sum += connector->stored();
  for (std::size_t k = 0; k < run.solids(); ++k) {
    const fem::Model& model = *run.solid(k).model;
    for (const auto& term : model.terms)
      if (term->isBody() || term->actsWithin()) sum += term->energy(model.nodes, {.t = model.t});
  }
  return sum;
}

/// 0 where nothing moves, with elastic energy or without; 1 where there is none to compare with.
static double overElastic(double kinetic, CoupledRun& run) {
  if (kinetic == 0.0) return 0.0;
  const double elastic = elasticEnergy(run);
  return elastic > 0.0 ? kinetic / elastic : 1.0;
}

/// Forces of an oscillation about rest are to its energies as amplitudes are to their squares.
static double residualOf(double kinetic, CoupledRun& run) {
  const double unbalanced = dem::unbalancedLoads(run.grains);
  return std::max(overElastic(kinetic, run), unbalanced * unbalanced);
}

bool relaxOn(CoupledRun& run, const RestCriterion& rest, RestProgress& progress, std::int64_t macroSteps) {
  validate(rest, "relax", 1);
  RestReport& report = progress.report;
  if (report.steps == 0) run.stop();
  run.damp(true);
  const std::int64_t end = std::min(rest.steps, report.steps + macroSteps);
  for (; report.steps < end && progress.quiet < 2; ++report.steps) {
    run.advance();
    const double kinetic = run.kineticEnergy();
    if (kinetic >= progress.before && kinetic > 0.0) {
      progress.before = kinetic;
      continue;
    }
    report.residual = residualOf(progress.before, run);
    progress.quiet = report.residual <= rest.tolerance ? progress.quiet + 1 : 0;
    ++progress.stops;
    run.stop();
    progress.before = 0.0;
  }
  report.atRest = progress.quiet == 2;
  const bool givenUp = !report.atRest && report.steps >= rest.steps;
  if (givenUp) report.residual = std::max(report.residual, residualOf(progress.before, run));
  if (report.atRest || givenUp) run.damp(false);
  return report.atRest || givenUp;
}

RestReport relax(CoupledRun& run, const RestCriterion& rest) {
  RestProgress progress;
  relaxOn(run, rest, progress, rest.steps);
  return progress.report;
}

}  // namespace dovetail::coupling
