// Load steps: solids from equilibrium to equilibrium, while particles stand still.
#include "dovetail/fem/solve/statics.hpp"

#include <algorithm>
#include <cmath>

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

fem::NewtonOptions newtonOf(const SolidOptions& options) {
  fem::NewtonOptions newton = options.newton;
  newton.linear = options.implicitOptions.linear;
  return newton;
}

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
  fem::StaticOptions options{
      .newton = newtonOf(options_), .smallestStep = smallestPart, .motionIterations = options_.motionIterations};
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
  endLoadStep(works, worked);
  loadFactor = 1.0 - after;
  return works.negativePivots <= 0;
}

bool SolidStepper::followLoad(std::int64_t loadSteps) {
  const double worked = held.work();
  StaticWork works;
  if (held.isIdle()) {
    path.at = 1.0;
  } else {
    const Lent lent(*model_, held);
    path.set = [this](double factor) { held.release(1.0 - factor, 1.0 - factor, 0.0, 0.0); };
    fem::ArcLengthOptions options{.newton = newtonOf(options_),
                                  .firstStep = 1.0 / static_cast<double>(loadSteps),
                                  .largestStep = std::abs(path.firstLength),
                                  .smallestFraction = smallestPart,
                                  .maxSteps = 1};
    add(fem::followPath(*model_, path, 1.0, options), works);
  }
  endLoadStep(works, worked);
  loadFactor = path.at;
  return loadFactor < 1.0 || works.negativePivots <= 0;
}

void SolidStepper::endLoadStep(const StaticWork& works, double heldBefore) {
  statics.held += held.work() - heldBefore;
  statics.loads += works.loads;
  statics.supports += works.supports;
  statics.dissipated += works.dissipated;
  restart();
  stands = true;
  statics.supports += kineticEnergy();  // those that move do so at once
  side.outside.give("supports", fem::momentaOf(side.nodes(), *side.mass));
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

namespace {

/// Calls act() for one of `steps`; where there is no equilibrium, the error says what a user can do.
template <class Act>
bool atStep(const SolidStepper& solid, std::int64_t step, std::int64_t steps, Act&& act) {
  const std::string where = "\"" + solid.side.name + "\", load step " + std::to_string(step + 1) +
                            (steps > 0 ? " of " + std::to_string(steps) : std::string());
  const std::string remedy = std::string("the solid may buckle, yield throughout, or not be held: ") +
                             (steps > 0 ? "take more load steps, follow its path by arcs, hold it, or relax it"
                                        : "take more load steps, hold it, or relax it");
  try {
    return act();
  } catch (const fem::NoEquilibrium& error) {
    throw NumericalError("there is no equilibrium, " + error.reason, where, remedy);
  } catch (const NumericalError& error) {
    throw NumericalError(error.what(), where, remedy);
  }
}

}  // namespace

void CoupledRun::Impl::requireLoadSteps(double time) const {
  for (const auto* connector : grains.terms.all<Connector>())
    if (connector->constrains())
      throw InputError("load steps know no particles, and an overlap ties them to the solid", connector->name(),
                       "bring both to rest together by relaxing");
  if (time > 0.0 && grains.particles.size() > 0)
    throw InputError("time passes in load steps, and there are particles, which stand still", "loadStep",
                     "let no time pass, or leave the particles out");
}

void CoupledRun::Impl::beginLoadStep(bool first) {
  if (first) {
    requireApart("before");
    stopSolids();
  }
  for (const auto& solid : solids)
    if (first)
      solid->held.hold(*solid->side.model);
    else if (solid->loadFactor < 1.0)
      solid->stop();
}

void CoupledRun::Impl::endLoadStep(double time) {
  grains.time = time;
  sampled = true;
  dem::findForces(grains);
  constrainMacroStep();
  rememberLoads();
  sampled = false;
  requireApart("after");
}

std::vector<std::string> CoupledRun::loadStep(std::int64_t step, std::int64_t steps, double time) {
  impl_->requireStarted("loadStep");
  dem::close(grains);
  impl_->requireLoadSteps(time);
  impl_->beginLoadStep(step == 0);
  const double until = grains.time + time, after = 1.0 - static_cast<double>(step + 1) / static_cast<double>(steps);
  std::vector<std::string> unstable;
  for (const auto& solid : impl_->solids) {
    const double to = time > 0.0 ? until : solid->side.model->t;
    if (!atStep(*solid, step, steps, [&] { return solid->loadStep(step + 1 == steps ? 0.0 : after, to); }))
      unstable.push_back(solid->side.name);
    if (step + 1 == steps) solid->held.end();
  }
  impl_->endLoadStep(until);
  return unstable;
}

std::vector<std::string> CoupledRun::followLoads(std::int64_t step, std::int64_t loadSteps) {
  impl_->requireStarted("followLoads");
  dem::close(grains);
  impl_->requireLoadSteps(0.0);
  impl_->beginLoadStep(step == 0);
  std::vector<std::string> unstable;
  for (const auto& solid : impl_->solids) {
    if (step == 0) solid->path = {}, solid->loadFactor = 0.0;
    if (solid->loadFactor == 1.0) continue;
    if (!atStep(*solid, step, 0, [&] { return solid->followLoad(loadSteps); })) unstable.push_back(solid->side.name);
    if (solid->loadFactor < 1.0) continue;
    solid->held.end();
    solid->path = {};
  }
  impl_->endLoadStep(grains.time);
  return unstable;
}

double CoupledRun::loadFactor(std::size_t k) const { return impl_->solids.at(k)->loadFactor; }

}  // namespace dovetail::coupling
