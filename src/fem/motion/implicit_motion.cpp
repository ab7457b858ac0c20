#include "dovetail/fem/motion/implicit_motion.hpp"

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "implicit_advance.hpp"

namespace dovetail::fem {

namespace {

const ImplicitOptions& checked(const ImplicitOptions& options) {
  detail::validate(options);
  return options;
}

}  // namespace

ImplicitMotion::Impl::System::System(Model& m, const ImplicitOptions& o, Profile& profile)
    : dofs(m.constraints, m.nodes), mass(m, dofs, o.massFraction, o.linear), solver(m, dofs, mass, o, profile) {}

ImplicitMotion::Impl::Impl(Model& m, const ImplicitOptions& o)
    : model(m), options(checked(o)), system(std::make_unique<System>(m, options, profile)) {}

void ImplicitMotion::Impl::makeSystem() {
  addMass(model);
  system = std::make_unique<System>(model, options, profile);
}

void ImplicitMotion::Impl::renew() {
  factorisationsBefore += solver().solver().factorisations();
  makeSystem();
}

void ImplicitMotion::Impl::begin(double dt) {
  dofs().apply(model.t, model.nodes.u);
  dofs().applyVelocity(model.t, dt, model.nodes.v);
  solver().begin(dt);
  begun = true;
}

void ImplicitMotion::Impl::advance(double h, const std::function<void(double)>& accept, int depth) {
  using detail::ImplicitStep;
  detail::NewtonResult result = solver().attempt(h, ImplicitStep::Guess::coast);
  if (!result.failure.empty()) result = solver().attempt(h, ImplicitStep::Guess::rest);
  if (result.failure.empty()) {
    accept(h);
    solver().accept();
    ++steps;
    iterations += result.iterations;
    if (result.tolerance > 0.0) largestResidual = std::max(largestResidual, result.residual / result.tolerance);
    return;
  }
  if (depth == options.maxCuts)
    throw NumericalError(
        result.failure,
        options.scheme.name + ", t = " + formatNumber(model.t) + " s, step of " + formatNumber(h) + " s",
        "take a smaller step, or a finer mesh where elements are inverted");
  ++cuts;
  advance(0.5 * h, accept, depth + 1);
  advance(0.5 * h, accept, depth + 1);
}

ImplicitMotion::ImplicitMotion(Model& model, const ImplicitOptions& options)
    : impl_(std::make_unique<Impl>(model, options)) {}
ImplicitMotion::~ImplicitMotion() = default;
ImplicitMotion::ImplicitMotion(ImplicitMotion&&) noexcept = default;

Model& ImplicitMotion::model() const { return impl_->model; }
const ModelMass& ImplicitMotion::mass() const { return impl_->mass(); }
const DofMap& ImplicitMotion::dofs() const { return impl_->dofs(); }

void ImplicitMotion::step(double dt) {
  requirePositive(dt, "dt");
  if (!impl_->begun) impl_->begin(dt);
  Model& model = impl_->model;
  impl_->advance(dt, [&](double h) {
    model.t += h;
    for (const auto& term : model.terms) term->commit(model.nodes, impl_->accepted(h));
  });
}

void ImplicitMotion::restart() { impl_->begun = false; }

void ImplicitMotion::Impl::kick(std::span<const Vec3> f, double dt) {
  std::vector<Vec3> a(f.begin(), f.end());
  mass().solve(a);
  for (std::size_t n = 0; n < a.size(); ++n) model.nodes.v[n] += dt * a[n];
}

void ImplicitMotion::kick(std::span<const Vec3> f, double dt) { impl_->kick(f, dt); }
double ImplicitMotion::kineticEnergy() const { return impl_->mass().kineticEnergy(impl_->model.nodes.v); }
std::int64_t ImplicitMotion::steps() const { return impl_->steps; }

}  // namespace dovetail::fem
