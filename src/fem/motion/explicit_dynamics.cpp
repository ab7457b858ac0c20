#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "dovetail/fem/motion/motion.hpp"
#include "energy_book.hpp"
#include "force_sum.hpp"
#include "run_state.hpp"
#include "step_control.hpp"

namespace dovetail::fem {

namespace {

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
  ExplicitOptions options;
  detail::StepControl control;
  double dt;  // of the step that ends or begins here
  Motion motion;
  detail::EnergyBook book;
  bool guessesVelocity;                // a term may depend on it
  bool moving;                         // supports do work
  bool divides;                        // M⁻¹ f is a division: no accelerations are kept
  std::vector<Vec3> a, before, guess;  // of those only that are needed have entries
  std::int64_t steps = 0;
  Profile profile{true};

  Impl(Model& m, double step, const ExplicitOptions& o)
      : model(m),
        options(o),
        control(m, step, o),
        dt(control.dt()),
        motion(m, o.massShare),
        book(m),
        guessesVelocity(std::ranges::any_of(m.terms, [](const auto& term) { return term->usesVelocity(); })),
        moving(supportsMove(m, motion.dofs())),
        divides(motion.mass().isDiagonal()) {
    motion.dofs().apply(model.t, model.nodes.u);
    motion.dofs().applyVelocity(model.t, dt, model.nodes.v);
    evaluate();
    sample();
    book.open();
  }

  /// Marks states: those of steps that follow the solid say more.
  std::string kind() const { return options.safety > 0.0 ? "following explicit" : "explicit"; }
  Instant now() const { return {model.t, dt, &motion.mass()}; }
  bool samples() const { return options.energyEvery > 0 && steps % options.energyEvery == 0; }

  /// Forces at the present state, and accelerations where masses couple them.
  void evaluate() {
    {
      const Profile::Stage stage(profile, "forces");
      motion.forces(dt, samples());
    }
    if (divides) return;
    const Profile::Stage stage(profile, "accelerations");
    a.assign(model.nodes.u.size(), {});
    if (moving) motion.dofs().applyAcceleration(model.t, dt, a);
    motion.mass().accelerate(model.nodes.f, a);
  }
  void sample() {
    if (!samples()) return;
    const Profile::Stage stage(profile, "energies");
    book.sample(model, motion.energies(), motion.kineticEnergy());
  }

  /// v += a dt/2, constrained components as at `time`.
  /// @return false if a velocity is not finite any more
  bool push(double time) {
    const bool finite = divides ? motion.kick(0.5 * dt) : motion.kick(a, 0.5 * dt);
    motion.dofs().applyVelocity(time, dt, model.nodes.v);
    return finite;
  }

  /// The same, and what the forces did is booked.
  bool halfKick(double time) {
    const Profile::Stage stage(profile, "kicks");
    const bool books = options.energyEvery > 0 && (moving || !motion.loads().empty());
    if (!books) return push(time);
    before = model.nodes.v;
    const double kinetic = moving ? motion.kineticEnergy() : 0.0;
    const bool finite = push(time);
    const auto work = [&](std::span<const Vec3> force) {
      return 0.25 * dt * (detail::innerProduct(force, before) + detail::innerProduct(force, model.nodes.v));
    };
    std::size_t next = 0;
    for (const auto& term : model.terms)
      if (!term->hasEnergy()) book.spend("work of " + term->name(), -work(motion.loads()[next++]));
    if (moving) book.spend("supports", kinetic - motion.kineticEnergy() + work(model.nodes.f));
    return finite;
  }

  void step() {
    halfKick(model.t + 0.5 * dt);
    {
      const Profile::Stage stage(profile, "drift");
      motion.drift(dt);
    }
    ++steps;
    if (guessesVelocity) {  // forces see the velocity that the last ones would lead to
      guess = model.nodes.v;
      push(model.t);
      evaluate();
      model.nodes.v.swap(guess);
    } else {
      evaluate();
    }
    check(halfKick(model.t));
    commit();
    sample();
    if (samples()) book.close();
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
  void commit() {
    const Profile::Stage stage(profile, "materials accept");
    book.accept(model, now(), options.energyEvery > 0);
  }
  detail::StepStart start() const {
    std::vector<Vec3> kept = a;
    kept.resize(model.nodes.u.size());  // where masses are lumped, forces say it all
    return {kept, model.nodes.f, {motion.loads().begin(), motion.loads().end()}};
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
const EnergyLedger& ExplicitIntegrator::ledger() const { return impl_->book.ledger(); }
double ExplicitIntegrator::kineticEnergy() const { return impl_->motion.kineticEnergy(); }

DynamicsReport ExplicitIntegrator::report() const {
  DynamicsReport report;
  report.scheme = "central differences";
  report.solver = "none";
  report.massShare = impl_->options.massShare;
  report.t = impl_->model.t;
  report.dt = impl_->dt;
  report.stepRange = impl_->control.range();
  report.criticalStep = impl_->control.critical();
  report.steps = impl_->steps;
  report.ledger = impl_->book.ledger();
  report.profile = impl_->profile;
  return report;
}

void ExplicitIntegrator::save(ByteWriter& archive) const {
  detail::writeModel(archive, impl_->kind(), impl_->model);
  impl_->book.save(archive);
  archive(impl_->steps);
  impl_->control.save(archive);
  detail::writeStart(archive, impl_->start());
}

void ExplicitIntegrator::load(ByteReader& archive) {
  detail::ModelState state = detail::readModel(archive, impl_->kind(), impl_->model);
  detail::EnergyBook book = impl_->book.read(archive);
  const std::int64_t steps = detail::readCount(archive, "number of steps");
  detail::StepControl control = impl_->control.read(archive);
  detail::StepStart start = detail::readStart(archive, impl_->model);
  detail::requireEnd(archive, "ExplicitIntegrator");
  detail::adopt(std::move(state), impl_->model);
  impl_->book = std::move(book);
  impl_->steps = steps;
  impl_->control = std::move(control);
  impl_->dt = impl_->control.dt();
  impl_->a = std::move(start.a);
  impl_->model.nodes.f = std::move(start.f);
  impl_->motion.setLoads(std::move(start.loads));
}

}  // namespace dovetail::fem
