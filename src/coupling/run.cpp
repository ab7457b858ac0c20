#include "dovetail/coupling/run.hpp"

#include <algorithm>
#include <map>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "run_impl.hpp"

namespace dovetail::coupling {

namespace {

void requireOptions(const RunOptions& options, double dt) {
  requirePositive(dt, "time step");
  if (options.stepsPerMacroStep < 1)
    throw InputError("stepsPerMacroStep is " + std::to_string(options.stepsPerMacroStep), "RunOptions",
                     "give 1 or more");
}

/// Names go into the ledger.
void requireOwnName(const std::string& name, const std::vector<std::unique_ptr<SolidStepper>>& solids) {
  if (name.empty()) throw InputError("a solid has no name", "SolidOptions", "give every solid a name of its own");
  const bool taken = std::ranges::any_of(solids, [&](const auto& other) { return other->side.name == name; });
  if (taken || name == "particles")
    throw InputError("there is something of that name already", "solid \"" + name + "\"",
                     "give every solid a name of its own");
}

}  // namespace

CoupledRun::CoupledRun(dem::Model particles)
    : grains(std::move(particles)), impl_(std::make_unique<Impl>(grains, profile)) {
  impl_->joinParticles();
}
CoupledRun::~CoupledRun() = default;

SolidSide& CoupledRun::addSolid(std::unique_ptr<fem::Model> model, const SolidOptions& options) {
  if (impl_->started)
    throw InputError("the run has started", "solid \"" + options.name + "\"", "add solids before start()");
  requireOwnName(options.name, impl_->solids);
  impl_->solids.push_back(makeStepper(std::move(model), options));
  return impl_->solids.back()->side;
}
std::size_t CoupledRun::solids() const { return impl_->solids.size(); }
SolidSide& CoupledRun::solid(std::size_t k) { return impl_->solids.at(k)->side; }
const SolidSide& CoupledRun::solid(std::size_t k) const { return impl_->solids.at(k)->side; }
double CoupledRun::dt() const { return impl_->dt; }
double CoupledRun::macroStep() const { return impl_->macroStep(); }

void CoupledRun::Impl::findForces(double step, const RunOptions& with) {
  joinParticles();
  requireSides();
  requireKept(with.lag);
  dem::close(grains);
  dt = step;
  options = with;
  for (const auto& solid : solids) solid->start(dt, K());
  placeParticles(true);
  const bool refuses = std::exchange(grains.refusesUnstableSteps, false);  // the limit of the whole decides
  sampled = ownForcesDue = true;
  dem::findForces(grains);
  ownForcesDue = false;
  grains.refusesUnstableSteps = refuses;
}

StepLimit CoupledRun::limitAtStart(const RunOptions& options) {
  constexpr double noTime = 1e-12;  // s: prescribed paths are looked at over so much
  requireOptions(options, noTime);
  if (impl_->started) throw InputError("the run has started", "limitAtStart", "call criticalStep()");
  impl_->findForces(noTime, options);
  return impl_->criticalStep();
}

void CoupledRun::start(double dt, const RunOptions& options) {
  requireOptions(options, dt);
  Impl& run = *impl_;
  const double lastDt = run.dt;
  const RunOptions lastOptions = run.options;
  run.findForces(dt, options);
  if (grains.refusesUnstableSteps) {
    const StepLimit limit = run.criticalStep();
    if (dt > limit.dt) {
      grains.refusesUnstableSteps = false;
      if (run.started) start(lastDt, lastOptions);
      grains.refusesUnstableSteps = true;
      throw InputError(
          "dt = " + formatNumber(dt) + " s exceeds the critical step of " + formatNumber(limit.dt) + " s, set by " +
              limit.owner,
          "time step",
          "take a fifth of the limit or less; if a solid sets it, fewer steps per macro step or an implicit solid");
    }
  }
  grains.passed.reset();
  grains.checkedStep = dt;
  run.constrainMacroStep();
  run.rememberLoads();
  run.sampled = false;
  if (run.started) return;
  run.started = true;
  ledger();
  run.ledger.open();
  run.open();
}

void CoupledRun::advance(std::int64_t macroSteps, bool withEnergies) {
  advanceOpen(macroSteps, withEnergies);
  dem::close(grains);
}

void CoupledRun::advanceOpen(std::int64_t macroSteps, bool withEnergies) {
  impl_->requireStarted("advance");
  if (macroSteps < 0) throw InputError("macro steps is " + std::to_string(macroSteps), "advance", "give 0 or more");
  for (std::int64_t w = 0; w < macroSteps; ++w) {
    try {
      impl_->macroStep(withEnergies && w + 1 == macroSteps);
    } catch (const NumericalError& error) {
      impl_->lookAtLimit(true);
      dem::reportOfLimit(grains, error);
      throw;
    }
    if (dem::looksAtLimit(grains.steps / impl_->K())) impl_->lookAtLimit();
  }
}

void CoupledRun::change(const std::function<void()>& act) {
  const auto energy = [&] {
    std::map<std::string, double> channels;  // their order in the ledger is another one in a run that was resumed
    for (const auto& channel : ledger().channels()) channels[channel.name] += channel.joules;
    double sum = 0.0;
    for (const auto& [name, joules] : channels) sum += joules;
    return sum;
  };
  const double before = energy();
  const Totals from = impl_->sums();
  act();
  grains.forcesOf = dem::Model::outdated;
  const bool refuses = std::exchange(grains.refusesUnstableSteps, false);
  start(impl_->dt, impl_->options);
  grains.refusesUnstableSteps = refuses;
  impl_->changed += energy() - before;
  const Totals to = impl_->sums();
  const Momenta added{to.momentum - from.momentum, to.angularMomentum - from.angularMomentum};
  if (!(added.linear == Vec3{} && added.angular == Vec3{})) impl_->outside.given.give("changes", added);
  impl_->lookAtLimit();
}

/// The particles' model may have been put in place of the one that the run began with.
void CoupledRun::Impl::joinParticles() {
  if (!joined()) grains.terms.add(std::make_unique<SolidsTerm>(this));
}

bool CoupledRun::Impl::joined() const {
  return std::ranges::any_of(grains.terms, [&](const auto& term) {
    const auto* const own = dynamic_cast<const SolidsTerm*>(term.get());
    return own && own->of(this);
  });
}

void CoupledRun::Impl::requireSides() const {
  for (const auto* connector : grains.terms.all<Connector>())
    if (std::ranges::none_of(solids, [&](const auto& solid) { return &solid->side == &connector->side(); }))
      throw InputError("its solid is not in this run", connector->name(),
                       "make it with the side that addSolid of this run returned");
}

void CoupledRun::Impl::requireStarted(const char* what) const {
  if (!started) throw InputError("the run has not been started", what, "call start(dt) first");
  if (!joined()) throw InputError("the model of the particles was replaced", what, "call start(dt) again");
}

bool CoupledRun::Impl::anyImplicit() const {
  return std::ranges::any_of(solids, [](const auto& s) { return s->side.stepping == Stepping::implicitSteps; });
}

void CoupledRun::Impl::macroStep(bool wantsEnergies) {
  for (const auto& solid : solids) solid->stands = false;
  renewNodes();
  if (options.lag != Lag::none) return lagMacroStep();
  const bool jumpsBetween = K() % 2 == 0 && anyImplicit();
  sampled = wantsEnergies;
  if (!macroForce.empty()) kickByMacroForce();
  for (int k = 0; k < K(); ++k) {
    const bool last = k + 1 == K();
    if (jumpsBetween && k == K() / 2) jumpBetweenSteps();
    dem::move(grains, dt);
    {
      const Profile::Stage stage(profile, "solids kick and drift");
      for (const auto& solid : solids) {
        if (k == 0) solid->begin(wantsEnergies);
        solid->kickByLoad();
        solid->drift();
      }
    }
    if (!jumpsBetween && k == K() / 2) {
      const Profile::Stage stage(profile, "solids jump");
      for (const auto& solid : solids) solid->jump();
    }
    stepParticles(last);
    const Profile::Stage stage(profile, "solids kick and drift");
    for (const auto& solid : solids) solid->kickByLoad();
  }
  constrainMacroStep();
  for (const auto& solid : solids) solid->end();
  if (!macroForce.empty()) kickByMacroForce();
}

/// Pairs, walls, connectors, and the solids' own forces with the last step of a macro step.
void CoupledRun::Impl::stepParticles(bool last) {
  for (const auto& solid : solids)
    solid->side.isInStep = last || solid->side.stepping == Stepping::explicitSteps || options.lag != Lag::none;
  grains.step.moved += placeParticles(false);
  dem::updateNeighbourList(grains);
  ownForcesDue = last;
  dem::addForces(grains);
  ownForcesDue = false;
}

/// Even macro steps: the solid moves while no time passes for the particles.
void CoupledRun::Impl::jumpBetweenSteps() {
  dem::close(grains);
  for (const auto& solid : solids) solid->jump();
  placeParticles(true);
  dem::findForces(grains);
}

/// Those that stand for parts of solids.
double CoupledRun::Impl::placeParticles(bool timeless) {
  double moved = 0.0;
  for (const auto& term : grains.terms)
    if (auto* const connector = dynamic_cast<Connector*>(term.get()))
      for (const auto& solid : solids)
        if (&solid->side == &connector->side() && !connector->placed().empty())
          moved = std::max(moved, connector->placeParticles(grains, solid->seenVelocities(timeless)));
  return moved;
}

/// At an instant at which nodes and particles agree. Loads are found anew, at nodes that are others.
void CoupledRun::Impl::renewNodes() {
  bool any = false;
  for (const auto& solid : solids) any |= solid->renewNodes();
  if (!any) return;
  dem::close(grains);
  placeParticles(true);
  sampled = true;
  dem::findForces(grains);
  constrainMacroStep();
}

/// Nodes that become others have no place where something keeps their numbers.
void CoupledRun::Impl::requireKept(Lag lag) const {
  for (const auto* connector : grains.terms.all<Connector>())
    if (fem::ownsNodes(*connector->side().model) && !connector->followsNodes())
      throw InputError("\"" + connector->side().name + "\" is made of material points, whose grid is renewed",
                       connector->name(), "couple it by mpm::PointContact or mpm::FaceContact");
  for (const auto& solid : solids)
    if (lag != Lag::none && fem::ownsNodes(*solid->side.model))
      throw InputError("a staggered run knows no material points", "solid \"" + solid->side.name + "\"",
                       "leave out the lag");
}

/// The forces with which constraints answer what acts at the ends of macro steps only.
void CoupledRun::Impl::constrainMacroStep() {
  macroForce.clear();
  if (K() == 1 && !anyImplicit()) {
    for (const auto& solid : solids) solid->macroLoad.clear();
    return;
  }
  for (const auto& solid : solids) {
    SolidSide& side = solid->side;
    NodalLoad load(side.nodes().X.size());
    bool any = !solid->macroLoad.touched.empty();
    for (const auto& term : grains.terms) {
      const auto* const connector = dynamic_cast<const Connector*>(term.get());
      if (!connector || !connector->constrains() || &connector->side() != &side) continue;
      if (macroForce.empty()) {
        dem::close(grains);
        macroForce.assign(grains.particles.size(), {});
      }
      const bool implicit = side.stepping == Stepping::implicitSteps;
      connector->constrainMacroStep(grains, implicit ? std::span<const Vec3>() : side.nodes().f, 0.5 * macroStep(),
                                    macroForce, load);
      any = true;
    }
    if (any) solid->takeMacroLoad(load);
  }
}

/// The second of the kicks about the end of a macro step meets other velocities than the first has left.
void CoupledRun::Impl::reportVelocities() {
  for (const auto* connector : grains.terms.all<Connector>()) {
    SolidSide& side = connector->side();
    if (!connector->constrains() || side.stepping != Stepping::implicitSteps) continue;
    std::vector<Vec3> same(grains.particles.size());
    NodalLoad load(side.nodes().X.size());
    connector->constrainMacroStep(grains, {}, 0.5 * macroStep(), same, load);
  }
}

void CoupledRun::Impl::kickByMacroForce() {
  dem::Particles& p = grains.particles;
  dem::close(grains);
  for (std::size_t i = 0; i < macroForce.size() && i < p.size(); ++i)
    p.v[i] += (0.5 * macroStep() / (p.weightOf(i) * p.mass[i])) * macroForce[i];
}

void CoupledRun::Impl::rememberLoads() {
  loadBefore.clear();
  lagSeen.clear();
  if (options.lag == Lag::none) return;
  for (const auto& solid : solids) {
    loadBefore.push_back(solid->side.load);
    lagSeen.push_back(solid->side.nodes().u);
  }
  lagFrom = lagTo = lagSeen;
}

namespace {

/// The solid's equation of motion at the end of a step holds with the load of the last evaluation, that at its start
/// with the load of the evaluation before: over the step this is the mean of the two, one step late.
NodalLoad meanOf(const NodalLoad& a, const NodalLoad& b) {
  NodalLoad load(a.force.size());
  for (const NodalLoad* part : {&a, &b})
    for (const int node : part->touched) load.add(node, 0.5 * part->force[static_cast<std::size_t>(node)]);
  return load;
}

double workOf(const NodalLoad& load, std::span<const Vec3> to, std::span<const Vec3> from) {
  double work = 0.0;
  for (const int node : load.touched) {
    const auto n = static_cast<std::size_t>(node);
    work += dot(load.force[n], to[n] - from[n]);
  }
  return work;
}

}  // namespace

/// The staggered macro step (Cheng et al. 2023, Fig. 8): the solids step under a load one step old, then the particles
/// make K steps on solids that move from their old to their new place, or stay at the old one.
void CoupledRun::Impl::lagMacroStep() {
  for (std::size_t s = 0; s < solids.size(); ++s) {
    SolidStepper& solid = *solids[s];
    lagFrom[s] = solid.side.nodes().u;
    const NodalLoad load = meanOf(loadBefore[s], solid.side.load);
    loadBefore[s] = solid.side.load;
    outside.given.give("staggering error", 0.5 * macroStep() * totalOf(load, solid.side.nodes()));
    solid.stepUnder(load);
    outside.given.give("staggering error", 0.5 * macroStep() * totalOf(load, solid.side.nodes()));
    lagTo[s] = solid.side.nodes().u;
    madeByLag += workOf(load, lagTo[s], lagFrom[s]);
  }
  for (int k = 0; k < K(); ++k) {
    dem::move(grains, dt);
    const double fraction = options.lag == Lag::loadAndSkin ? 0.0 : static_cast<double>(k + 1) / K();
    for (std::size_t s = 0; s < solids.size(); ++s) {
      SolidSide& side = solids[s]->side;
      for (std::size_t n = 0; n < side.nodes().u.size(); ++n)
        side.nodes().u[n] = lagFrom[s][n] + fraction * (lagTo[s][n] - lagFrom[s][n]);
      madeByLag -= 0.5 * workOf(side.load, side.nodes().u, lagSeen[s]);
    }
    stepParticles(false);
    for (std::size_t s = 0; s < solids.size(); ++s) {
      SolidSide& side = solids[s]->side;
      madeByLag -= 0.5 * workOf(side.load, side.nodes().u, lagSeen[s]);
      lagSeen[s] = side.nodes().u;
    }
  }
  for (std::size_t s = 0; s < solids.size(); ++s) solids[s]->side.nodes().u = lagTo[s];
}

}  // namespace dovetail::coupling
