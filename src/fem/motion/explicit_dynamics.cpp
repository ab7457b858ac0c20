#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/fem/motion/booked_motion.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "run_state.hpp"
#include "step_control.hpp"

namespace dovetail::fem {

struct ExplicitIntegrator::Impl {
  Model& model;
  ExplicitOptions options;
  detail::StepControl control;
  double dt;  // of the step that ends or begins here
  BookedMotion solid;
  std::int64_t steps = 0;
  Profile profile{true};

  Impl(Model& m, double step, const ExplicitOptions& o)
      : model(m), options(o), control(m, step, o), dt(control.dt()), solid(m, o.massFraction, dt) {
    if (!samples()) return;
    solid.sample();
    solid.ledger.open();
  }

  /// Marks states: those of steps that follow the solid say more.
  std::string kind() const { return options.safety > 0.0 ? "following explicit" : "explicit"; }
  bool books() const { return options.energyEvery > 0; }
  bool samples() const { return books() && steps % options.energyEvery == 0; }

  bool halfKick(double time) {
    const Profile::Stage stage(profile, "kicks");
    return solid.halfKick(dt, time, books());
  }
  void step() {
    halfKick(model.t + 0.5 * dt);
    {
      const Profile::Stage stage(profile, "drift");
      solid.motion.drift(dt);
    }
    ++steps;
    {
      const Profile::Stage stage(profile, "forces");
      solid.evaluate(dt, samples(), true);
    }
    check(halfKick(model.t));
    {
      const Profile::Stage stage(profile, "materials accept");
      solid.accept(dt, books());
    }
    {
      const Profile::Stage stage(profile, "renewals");
      solid.renewNodes(dt);
    }
    if (samples()) {
      const Profile::Stage stage(profile, "energies");
      solid.sample();
      solid.ledger.close();
    }
    if (options.safety == 0.0) return;
    const Profile::Stage stage(profile, "stable step");
    control.accept(model);
    dt = control.dt();
  }
  void stepUntil(double t) {
    const double parts = std::ceil((t - model.t) / dt * (1.0 - 1e-12));
    if (parts <= 2.0) dt = (t - model.t) / std::max(parts, 1.0);
    step();
    if (parts <= 1.0) model.t = t;
    dt = control.dt();
  }
  void check(bool finite) {
    if (finite && (options.checkEvery == 0 || steps % options.checkEvery != 0)) return;
    const Profile::Stage stage(profile, "checks");
    const std::string when = "t = " + formatNumber(model.t) + " s, step " + std::to_string(steps);
    for (const auto& term : model.terms) term->requireValid(model.nodes, when, Scrutiny::inversion);
    if (!finite) requireFinite(model.nodes.v, "node", "velocity", when);
  }
};

ExplicitIntegrator::ExplicitIntegrator(Model& model, double dt, const ExplicitOptions& options)
    : impl_(std::make_unique<Impl>(model, dt, options)) {}
ExplicitIntegrator::~ExplicitIntegrator() = default;
ExplicitIntegrator::ExplicitIntegrator(ExplicitIntegrator&&) noexcept = default;

void ExplicitIntegrator::step() { impl_->step(); }
void ExplicitIntegrator::run(std::int64_t steps) {
  for (std::int64_t k = 0; k < steps; ++k) step();
  if (impl_->options.checkEvery > 0) impl_->check(false);
}
void ExplicitIntegrator::runUntil(double t) {
  if (!(t >= impl_->model.t))
    throw InputError("the end is " + formatNumber(t) + " s, the time " + formatNumber(impl_->model.t) + " s",
                     "runUntil", "give a later time");
  while (impl_->model.t < t) impl_->stepUntil(t);
  if (impl_->options.checkEvery > 0) impl_->check(false);
}
const EnergyLedger& ExplicitIntegrator::ledger() const { return impl_->solid.ledger; }
double ExplicitIntegrator::kineticEnergy() const { return impl_->solid.motion.kineticEnergy(); }

DynamicsReport ExplicitIntegrator::report() const {
  DynamicsReport report;
  report.scheme = "central differences";
  report.solver = "none";
  report.massFraction = impl_->options.massFraction;
  report.t = impl_->model.t;
  report.dt = impl_->dt;
  report.stepRange = impl_->control.range();
  report.criticalStep = impl_->control.critical();
  report.steps = impl_->steps;
  report.ledger = impl_->solid.ledger;
  report.profile = impl_->profile;
  return report;
}

void ExplicitIntegrator::save(ByteWriter& archive) const {
  impl_->solid.save(archive, impl_->kind());
  archive(impl_->steps);
  impl_->control.save(archive);
}

void ExplicitIntegrator::load(ByteReader& archive) {
  const auto state = impl_->solid.read(archive, impl_->kind());
  const std::int64_t steps = detail::readCount(archive, "number of steps");
  detail::StepControl control = impl_->control.read(archive);
  detail::requireEnd(archive, "ExplicitIntegrator");
  impl_->solid.adopt(*state);
  impl_->steps = steps;
  impl_->control = std::move(control);
  impl_->dt = impl_->control.dt();
}

}  // namespace dovetail::fem
