#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/model/model_mass.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "dovetail/fem/motion/stable_step.hpp"
#include "energy_book.hpp"
#include "run_state.hpp"

namespace dovetail::fem {

namespace {

/// Lumped mass over the least that the blended one can be.
double leastMass(double share) { return 1.0 - 26.0 / 27.0 * share; }

double checkedStep(Model& model, double dt, const ExplicitOptions& options, double& critical) {
  requirePositive(dt, "dt");
  const bool solid = std::ranges::any_of(
      model.terms, [](const auto& term) { return dynamic_cast<const Solid*>(term.get()) != nullptr; });
  if (!options.checkStep || !solid) return dt;
  const ModelStableStep stable = stableStep(model);
  critical = stable.dt * std::sqrt(leastMass(options.massShare));
  if (dt > critical)
    throw InputError("dt is " + formatNumber(dt) + " s, the largest stable step is " + formatNumber(critical) + " s",
                     "element " + std::to_string(stable.element) + " of \"" + stable.solid + "\" sets it",
                     "take a smaller step, a coarser mesh there, or an implicit scheme");
  return dt;
}

bool supportsMove(const Model& model, const DofMap& dofs) {
  if (dofs.hasMotion()) return true;
  for (std::size_t n = 0; n < model.nodes.fixed.size(); ++n)
    for (int c = 0; c < 3; ++c)
      if (model.nodes.fixed[n] >> c & 1 && model.nodes.v[n][c] != 0.0) return true;
  return false;
}

}  // namespace

struct ExplicitIntegrator::Impl {
  Model& model;
  double critical = 0.0;
  double dt;
  ExplicitOptions options;
  DofMap dofs;
  ModelMass mass;
  detail::ForceSum forces;
  detail::EnergyBook book;
  std::vector<Vec3> a, middle, halfway;
  bool moving;
  std::int64_t steps = 0;
  Profile profile{true};

  Impl(Model& m, double step, const ExplicitOptions& o)
      : model(m),
        dt(checkedStep(m, step, o, critical)),
        options(o),
        dofs(m.constraints, m.nodes),
        mass(m, dofs, o.massShare),
        forces(m),
        book(m),
        a(m.nodes.u.size()),
        halfway(m.nodes.v),
        moving(supportsMove(m, dofs)) {
    dofs.apply(model.t, model.nodes.u);
    dofs.applyVelocity(model.t, dt, model.nodes.v);
    evaluate();
    sample();
    book.open();
  }

  Instant now() const { return {model.t, dt, &mass}; }
  /// Forces and accelerations at the present state; accelerations of motions only where masses couple them.
  void evaluate() {
    {
      const Profile::Stage stage(profile, "forces");
      forces.evaluate(model, model.nodes, now());
    }
    const Profile::Stage stage(profile, "accelerations");
    std::fill(a.begin(), a.end(), Vec3{});
    if (moving) dofs.applyAcceleration(model.t, dt, a);
    mass.accelerate(forces.total, a);
  }
  void sample() {
    if (options.energyEvery == 0 || steps % options.energyEvery != 0) return;
    const Profile::Stage stage(profile, "energies");
    book.sample(model, now(), mass.kineticEnergy(model.nodes.v));
  }

  /// v += a dt/2, constrained components as at `time`; books what the forces did.
  void halfKick(double time) {
    const Profile::Stage stage(profile, "kicks");
    std::vector<Vec3>& v = model.nodes.v;
    const bool booking = options.energyEvery > 0, needsMean = booking && (moving || !forces.loads.empty());
    if (needsMean) middle = v;
    const double before = booking && moving ? mass.kineticEnergy(v) : 0.0;
    for (std::size_t n = 0; n < v.size(); ++n) v[n] += 0.5 * dt * a[n];
    dofs.applyVelocity(time, dt, v);
    if (!needsMean) return;
    for (std::size_t n = 0; n < v.size(); ++n) middle[n] = 0.25 * dt * (middle[n] + v[n]);
    std::size_t next = 0;
    for (const auto& term : model.terms)
      if (!term->hasEnergy())
        book.spend("work of " + term->name(), -detail::innerProduct(forces.loads[next++], middle));
    if (moving) book.spend("supports", before - mass.kineticEnergy(v) + detail::innerProduct(forces.total, middle));
  }

  void step() {
    halfKick(model.t + 0.5 * dt);
    drift(model.nodes, dt);
    model.t += dt;
    dofs.apply(model.t, model.nodes.u);
    // Forces see a guess of the velocity at the end of the step.
    halfway.swap(model.nodes.v);
    for (std::size_t n = 0; n < a.size(); ++n) model.nodes.v[n] = halfway[n] + 0.5 * dt * a[n];
    dofs.applyVelocity(model.t, dt, model.nodes.v);
    evaluate();
    halfway.swap(model.nodes.v);
    halfKick(model.t);
    ++steps;
    check();
    commit();
    sample();
    if (options.energyEvery > 0 && steps % options.energyEvery == 0) book.close();
  }
  void commit() {
    const Profile::Stage stage(profile, "materials accept");
    book.accept(model, now(), options.energyEvery > 0);
  }
  void check() {
    const Profile::Stage stage(profile, "checks");
    const std::string when = "t = " + formatNumber(model.t) + " s, step " + std::to_string(steps);
    const auto ask = [&] {
      for (const auto& term : model.terms) term->requireValid(model.nodes, when);
    };
    try {
      requireFinite(model.nodes.v, "node", "velocity", when);
    } catch (const NumericalError&) {
      ask();  // an inverted element says more than a NaN
      throw;
    }
    if (options.checkEvery > 0 && steps % options.checkEvery == 0) ask();
  }
};

ExplicitIntegrator::ExplicitIntegrator(Model& model, double dt, const ExplicitOptions& options)
    : impl_(std::make_unique<Impl>(model, dt, options)) {}
ExplicitIntegrator::~ExplicitIntegrator() = default;
ExplicitIntegrator::ExplicitIntegrator(ExplicitIntegrator&&) noexcept = default;

void ExplicitIntegrator::step() { impl_->step(); }
void ExplicitIntegrator::run(std::int64_t steps) {
  for (std::int64_t k = 0; k < steps; ++k) step();
  impl_->model.nodes.f = impl_->forces.total;
}
const EnergyLedger& ExplicitIntegrator::ledger() const { return impl_->book.ledger(); }
double ExplicitIntegrator::kineticEnergy() const { return impl_->mass.kineticEnergy(impl_->model.nodes.v); }

DynamicsReport ExplicitIntegrator::report() const {
  DynamicsReport report;
  report.scheme = "central differences";
  report.solver = "none";
  report.massShare = impl_->options.massShare;
  report.t = impl_->model.t;
  report.dt = impl_->dt;
  report.criticalStep = impl_->critical;
  report.steps = impl_->steps;
  report.ledger = impl_->book.ledger();
  report.profile = impl_->profile;
  return report;
}

void ExplicitIntegrator::save(ByteWriter& archive) const {
  detail::writeModel(archive, "explicit", impl_->model);
  impl_->book.save(archive);
  archive(impl_->steps);
  detail::writeStart(archive, impl_->a, impl_->forces);
}

void ExplicitIntegrator::load(ByteReader& archive) {
  detail::ModelState state = detail::readModel(archive, "explicit", impl_->model);
  detail::EnergyBook book = impl_->book.read(archive);
  const std::int64_t steps = detail::readCount(archive, "number of steps");
  detail::StepStart start = detail::readStart(archive, impl_->model);
  detail::requireEnd(archive, "ExplicitIntegrator");
  detail::adopt(std::move(state), impl_->model);
  impl_->book = std::move(book);
  impl_->steps = steps;
  impl_->a = std::move(start.a);
  impl_->forces = std::move(start.forces);
}

}  // namespace dovetail::fem
