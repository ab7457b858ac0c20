// Load steps: solids from equilibrium to equilibrium, while particles stand still.
#include "dovetail/fem/solve/statics.hpp"

#include <algorithm>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/fem/motion/support_kick.hpp"
#include "run_impl.hpp"

namespace dovetail::coupling {

namespace {

constexpr double smallestPart = 1e-3;  // of a load step

/// Puts a term on a model for as long as it lives: integrators know the other terms only.
class Lent {
public:
  Lent(fem::Model& model, fem::HeldLoad& term) : model_(model) {
    model.terms.push_back(std::shared_ptr<fem::Term>(std::shared_ptr<void>(), &term));
  }
  Lent(const Lent&) = delete;
  ~Lent() { model_.terms.pop_back(); }

private:
  fem::Model& model_;
};

void add(const fem::StaticReport& report, SolidStepper::StaticWork& works) {
  works.loads += report.loadWork;
  works.dissipated += report.dissipated;
  if (!report.steps.empty()) works.negativePivots = report.steps.back().negativePivots;
}

/// Where no time passes and no support moves: what is held falls from `before` to `after` in one step, or in halves.
void releaseAtOnce(fem::Model& model, fem::HeldLoad& held, const fem::StaticOptions& options, double before,
                   double after, double smallest, SolidStepper::StaticWork& works) {
  held.release(before, after, 0.0, 0.0);
  try {
    add(fem::solveStatics(model, model.t, options), works);
  } catch (const NumericalError&) {
    const double middle = 0.5 * (before + after);
    if (before - middle < smallest) throw;
    releaseAtOnce(model, held, options, before, middle, smallest, works);
    releaseAtOnce(model, held, options, middle, after, smallest, works);
  }
}

}  // namespace

void SolidStepper::stop() {
  statics.supports -= kineticEnergy();
  side.outside.give("supports", -1.0 * fem::momentaOf(side.nodes(), *side.mass));
  std::ranges::fill(side.nodes().v, Vec3{});
}

bool SolidStepper::loadStep(double after, double time) {
  fem::Model& model = *model_;
  const double before = held.factor(model.t), length = time - model.t, worked = held.work();
  fem::StaticOptions options{.smallestStep = smallestPart};
  options.newton.linear = options_.implicitOptions.linear;
  StaticWork works;
  {
    const Lent lent(model, held);
    if (length > 0.0) {
      options.firstStep = length;
      options.smallestStep = smallestPart * length;
      held.release(before, after, model.t, time);
      const fem::StaticReport report = fem::solveStatics(model, time, options);
      add(report, works);
      works.supports = report.supportWork;
    } else {
      releaseAtOnce(model, held, options, before, after, smallestPart * (before - after), works);
    }
  }
  statics.held += held.work() - worked;
  statics.loads += works.loads;
  statics.supports += works.supports;
  statics.dissipated += works.dissipated;
  restart();
  stands = true;
  statics.supports += kineticEnergy();  // those that move do so at once
  side.outside.give("supports", fem::momentaOf(side.nodes(), *side.mass));
  return works.negativePivots <= 0;
}

void CoupledRun::Impl::stopSolids() {
  const Totals before = sums();
  for (const auto& solid : solids) {
    broughtToRest += solid->kineticEnergy();
    std::ranges::fill(solid->side.nodes().v, Vec3{});
  }
  const Totals after = sums();
  outside.given.give("kinetic damping",
                     {after.momentum - before.momentum, after.angularMomentum - before.angularMomentum});
}

void CoupledRun::Impl::requireApart(const char* when) const {
  for (const auto& solid : solids)
    if (!solid->side.load.touched.empty())
      throw InputError("particles touch \"" + solid->side.name + "\" " + when + " load steps, which know no particles",
                       "t = " + formatNumber(grains.time) + " s",
                       "let load steps come before the particles, or bring all to rest together by relaxing");
}

std::vector<std::string> CoupledRun::loadStep(std::int64_t step, std::int64_t steps, double time) {
  impl_->requireStarted("loadStep");
  dem::close(grains);
  for (const auto* connector : grains.terms.all<Connector>())
    if (connector->constrains())
      throw InputError("load steps know no particles, and an overlap ties them to the solid", connector->name(),
                       "bring both to rest together by relaxing");
  if (time > 0.0 && grains.particles.size() > 0)
    throw InputError("time passes in load steps, and there are particles, which stand still", "loadStep",
                     "let no time pass, or leave the particles out");
  Impl& run = *impl_;
  if (step == 0) {
    run.requireApart("before");
    run.stopSolids();
  }
  const double until = grains.time + time, after = 1.0 - static_cast<double>(step + 1) / static_cast<double>(steps);
  std::vector<std::string> unstable;
  for (const auto& solid : run.solids) {
    if (step == 0)
      solid->held.hold(*solid->side.model);
    else
      solid->stop();
    try {
      const bool stable = solid->loadStep(step + 1 == steps ? 0.0 : after, time > 0.0 ? until : solid->side.model->t);
      if (!stable) unstable.push_back(solid->side.name);
    } catch (const NumericalError& error) {
      throw NumericalError(
          error.what(),
          "\"" + solid->side.name + "\", load step " + std::to_string(step + 1) + " of " + std::to_string(steps),
          "the solid may buckle, yield throughout, or not be held: take more load steps, hold it, or "
          "relax it");
    }
    if (step + 1 == steps) solid->held.end();
  }
  grains.time = until;
  run.sampled = true;
  dem::findForces(grains);
  run.constrainMacroStep();
  run.rememberLoads();
  run.sampled = false;
  run.requireApart("after");
  return unstable;
}

}  // namespace dovetail::coupling
