#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "dovetail/fem/motion/model_ledger.hpp"
#include "dovetail/fem/motion/support_kick.hpp"
#include "implicit_advance.hpp"
#include "renewal.hpp"
#include "run_state.hpp"

namespace dovetail::fem {

Scheme newmark(double beta, double gamma) {
  if (!(2.0 * beta >= gamma && gamma >= 0.5))
    throw InputError("beta is " + formatNumber(beta) + ", gamma " + formatNumber(gamma), "newmark",
                     "give 2 beta >= gamma >= 1/2, else the step is not unconditionally stable");
  return {"Newmark, beta " + formatNumber(beta) + ", gamma " + formatNumber(gamma), false, 0.0, 0.0, beta, gamma};
}

Scheme hht(double alpha) {
  if (!(alpha >= -1.0 / 3.0 && alpha <= 0.0))
    throw InputError("alpha is " + formatNumber(alpha), "hht", "give -1/3 to 0");
  return {"HHT, alpha " + formatNumber(alpha), false, 0.0, -alpha, 0.25 * (1.0 - alpha) * (1.0 - alpha), 0.5 - alpha};
}

Scheme generalisedAlpha(double rhoInfinity) {
  if (!(rhoInfinity >= 0.0 && rhoInfinity <= 1.0))
    throw InputError("the spectral radius is " + formatNumber(rhoInfinity), "generalisedAlpha", "give 0 to 1");
  const double m = (2.0 * rhoInfinity - 1.0) / (rhoInfinity + 1.0), f = rhoInfinity / (rhoInfinity + 1.0);
  return {"generalised alpha, rho " + formatNumber(rhoInfinity),
          false,
          m,
          f,
          0.25 * (1.0 - m + f) * (1.0 - m + f),
          0.5 - m + f};
}

Scheme energyMomentum() { return {"energy-momentum", true}; }

struct ImplicitIntegrator::Impl : ImplicitMotion::Impl {
  double dt;
  ModelLedger ledger;
  ImpulseLedger impulses;

  Impl(Model& m, double step, const ImplicitOptions& o)
      : ImplicitMotion::Impl(m, o), dt(requirePositive(step, "dt")), ledger(m) {
    begin(dt);
    sample();
    ledger.open();
  }

  bool renewNodes() {
    if (!detail::renewNodes(model, ledger, impulses)) return false;
    renew();
    begin(dt);
    return true;
  }

  /// Puts a state of the model in force, and what is read after it. Factors are those of nodes: where these come with
  /// the state, the model takes it first, and gives it back if what follows is not good.
  detail::ImplicitStep::State takeState(detail::ModelState state,
                                        const std::function<detail::ImplicitStep::State()>& readRest) {
    if (!ownsNodes(model)) {
      detail::ImplicitStep::State rest = readRest();
      detail::adopt(std::move(state), model);
      return rest;
    }
    ByteWriter bytes;
    detail::writeModel(bytes, kind(), model);
    ByteReader before(bytes.bytes());
    const Nodes nodes = model.nodes;
    auto own = std::move(system);
    try {
      detail::adopt(std::move(state), model);
      makeSystem();
      return readRest();
    } catch (...) {
      detail::adopt(detail::readModel(before, kind(), model), model);
      model.nodes = nodes;
      system = std::move(own);
      throw;
    }
  }

  /// Marks states: conserving steps start from other fields.
  std::string kind() const { return options.scheme.conserving ? "energy-momentum" : "implicit"; }
  void sample() {
    if (options.energyEvery == 0 || steps % options.energyEvery != 0) return;
    const Profile::Stage stage(profile, "energies");
    std::vector<double> energies;
    for (const auto& term : model.terms)
      energies.push_back(term->hasEnergy() ? term->energy(model.nodes, {model.t, dt, &mass()}) : 0.0);
    ledger.sample(model, energies, mass().kineticEnergy(model.nodes.v));
  }

  /// Works of loads and supports and the dissipation of the scheme over the step that has just converged.
  void bookWorks(double h) {
    const Profile::Stage stage(profile, "works");
    const std::vector<Vec3>&u0 = solver().startDisplacement(), &v0 = solver().startVelocity();
    const std::size_t n = u0.size();
    std::vector<Vec3> motion(n), change(n), rate(n), ringing(n);
    for (std::size_t k = 0; k < n; ++k) {
      motion[k] = model.nodes.u[k] - u0[k];
      change[k] = (model.nodes.v[k] - v0[k]) / h;
      ringing[k] = 0.5 * h * (model.nodes.v[k] + v0[k]) - motion[k];
    }
    for (std::size_t k = 0; k < model.terms.size(); ++k)
      if (const Term& term = *model.terms[k]; !term.hasEnergy())
        ledger.add("work of " + term.name(), -solver().loadWork(k, motion));
    mass().multiply(change, rate);
    const std::vector<Vec3> force = solver().meanForce(), follows = following(motion), freeRinging = following(ringing);
    double support = 0.0, lost = 0.0;
    giveImpulses(h, rate, ringing);
    for (std::size_t k = 0; k < n; ++k) {
      const Vec3 reaction = rate[k] - force[k];
      // Prescribed velocities are not quite the mean of the motion: their kinetic energy comes from the support.
      support += dot(reaction, motion[k] - follows[k]) + dot(rate[k], ringing[k] - freeRinging[k]);
      lost -= dot(reaction, follows[k]) + dot(rate[k], freeRinging[k]);
    }
    ledger.add("supports", -support);
    ledger.add("dissipation of the scheme", lost);
  }
  bool isFree(std::size_t node, int component) const {
    return dofs().freeRow()[3 * node + static_cast<std::size_t>(component)] >= 0;
  }
  /// Impulses over the step of length h that has just converged.
  /// @param rate  M (v₁ − v₀)/h, N @param ringing  mean velocity times h less the motion, m
  void giveImpulses(double h, std::span<const Vec3> rate, std::span<const Vec3> ringing) {
    const std::vector<Vec3> force = solver().givenForce();
    Nodes mean;
    mean.X = model.nodes.X;
    for (std::size_t k = 0; k < rate.size(); ++k)
      mean.u.push_back(0.5 * (solver().startDisplacement()[k] + model.nodes.u[k]));
    for (std::size_t k = 0; k < model.terms.size(); ++k)
      if (!model.terms[k]->actsWithin())
        impulses.give(model.terms[k]->name(), h * momentaOf(mean, solver().givenLoad(k)));
    // Ties pull at their masters; through a mass that is not lumped, prescribed motion pulls at its neighbours.
    const bool everyRow = dofs().hasTies() || (dofs().hasMotion() && !mass().isDiagonal());
    Momenta supports;
    for (std::size_t k = 0; k < rate.size(); ++k) {
      Vec3 reaction;
      for (int c = 0; c < 3; ++c)
        if (everyRow || !isFree(k, c)) reaction[c] = h * (rate[k][c] - force[k][c]);
      supports.add(mean.X[k] + mean.u[k], reaction);
    }
    if (dofs().hasMotion()) supports.angular -= momentOfRinging(ringing);
    impulses.give("supports", supports);
  }
  /// Σ ringing × M v̄ over prescribed components: supports carry the nodes otherwise than by their mean velocities.
  Vec3 momentOfRinging(std::span<const Vec3> ringing) const {
    std::vector<Vec3> mean(ringing.size()), momentum(ringing.size());
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k] = 0.5 * (solver().startVelocity()[k] + model.nodes.v[k]);
    mass().multiply(mean, momentum);
    Vec3 sum;
    for (std::size_t k = 0; k < mean.size(); ++k) {
      Vec3 held = ringing[k];
      for (int c = 0; c < 3; ++c)
        if (isFree(k, c)) held[c] = 0.0;
      sum += cross(held, momentum[k]);
    }
    return sum;
  }
  /// The part of a motion that the free components make, ties included.
  std::vector<Vec3> following(const std::vector<Vec3>& motion) const {
    std::vector<double> dq;
    for (const int dof : dofs().freeDofs()) dq.push_back(motion[static_cast<std::size_t>(dof / 3)][dof % 3]);
    std::vector<Vec3> follows(motion.size());
    dofs().addIncrement(dq, follows);
    return follows;
  }

  void accept(double h) {
    if (options.energyEvery > 0) bookWorks(h);
    model.t += h;
    const Profile::Stage stage(profile, "materials accept");
    ledger.accept(model, accepted(h), options.energyEvery > 0);
  }
};

ImplicitIntegrator::ImplicitIntegrator(Model& model, double dt, const ImplicitOptions& options)
    : impl_(std::make_unique<Impl>(model, dt, options)) {}
ImplicitIntegrator::~ImplicitIntegrator() = default;
ImplicitIntegrator::ImplicitIntegrator(ImplicitIntegrator&&) noexcept = default;

bool ImplicitIntegrator::renewNodes() { return impl_->renewNodes(); }

void ImplicitIntegrator::step() {
  renewNodes();
  impl_->advance(impl_->dt, [this](double h) { impl_->accept(h); });
  impl_->sample();
  if (impl_->options.energyEvery > 0 && impl_->steps % impl_->options.energyEvery == 0) impl_->ledger.close();
}
void ImplicitIntegrator::run(std::int64_t steps) {
  for (std::int64_t k = 0; k < steps; ++k) step();
  impl_->model.nodes.f = impl_->solver().forces();
}
void ImplicitIntegrator::use(const Scheme& scheme) {
  const auto ofNewmark = [](const Scheme& one) { return !one.conserving && one.alphaM == 0.0 && one.alphaF == 0.0; };
  if (!ofNewmark(scheme) || !ofNewmark(impl_->options.scheme))
    throw InputError(impl_->options.scheme.name + " cannot become " + scheme.name, "ImplicitIntegrator::use",
                     "let both be Newmark's");
  if (scheme.beta == impl_->options.scheme.beta && scheme.gamma == impl_->options.scheme.gamma) return;
  impl_->options.scheme = scheme;
  impl_->solver().use(scheme);
}
void ImplicitIntegrator::restart() {
  impl_->begin(impl_->dt);
  impl_->sample();
}
linalg::LinearForecast ImplicitIntegrator::forecast() { return impl_->solver().forecast(); }
const ModelMass& ImplicitIntegrator::mass() const { return impl_->mass(); }
const ImpulseLedger& ImplicitIntegrator::impulses() const { return impl_->impulses; }
const EnergyLedger& ImplicitIntegrator::ledger() const { return impl_->ledger; }
double ImplicitIntegrator::kineticEnergy() const { return impl_->mass().kineticEnergy(impl_->model.nodes.v); }

Vec3 ImplicitIntegrator::momentum() const {
  std::vector<Vec3> p(impl_->model.nodes.v.size());
  impl_->mass().multiply(impl_->model.nodes.v, p);
  Vec3 sum;
  for (const Vec3& value : p) sum += value;
  return sum;
}

Vec3 ImplicitIntegrator::angularMomentum() const {
  const Nodes& nodes = impl_->model.nodes;
  std::vector<Vec3> p(nodes.v.size());
  impl_->mass().multiply(nodes.v, p);
  Vec3 sum;
  for (std::size_t n = 0; n < p.size(); ++n) sum += cross(nodes.X[n] + nodes.u[n], p[n]);
  return sum;
}

DynamicsReport ImplicitIntegrator::report() const {
  DynamicsReport report;
  report.scheme = impl_->options.scheme.name;
  report.solver = impl_->solver().solver().method();
  report.massFraction = impl_->options.massFraction;
  report.t = impl_->model.t;
  report.dt = impl_->dt;
  report.steps = impl_->steps;
  report.cuts = impl_->cuts;
  report.iterations = impl_->iterations;
  report.factorisations = impl_->factorisationsBefore + impl_->solver().solver().factorisations();
  report.largestResidual = impl_->largestResidual;
  report.atMeanState = impl_->solver().termsAtMeanState();
  report.ledger = impl_->ledger;
  report.profile = impl_->profile;
  return report;
}

void ImplicitIntegrator::save(ByteWriter& archive) const {
  detail::writeModel(archive, impl_->kind(), impl_->model);
  impl_->ledger.save(archive);
  impl_->impulses.save(archive);
  archive(impl_->steps, impl_->cuts, impl_->iterations, impl_->largestResidual);
  impl_->solver().save(archive);
}

void ImplicitIntegrator::load(ByteReader& archive) {
  detail::ModelState state = detail::readModel(archive, impl_->kind(), impl_->model);
  ModelLedger ledger = impl_->ledger.read(archive);
  ImpulseLedger impulses;
  impulses.load(archive);
  const std::int64_t steps = detail::readCount(archive, "number of steps");
  const std::int64_t cuts = detail::readCount(archive, "number of cuts");
  const std::int64_t iterations = detail::readCount(archive, "number of iterations");
  const double largestResidual = detail::readNumber(archive, "largest residual");
  detail::ImplicitStep::State next = impl_->takeState(std::move(state), [&] {
    detail::ImplicitStep::State read = impl_->solver().read(archive);
    detail::requireEnd(archive, "ImplicitIntegrator");
    return read;
  });
  impl_->ledger = std::move(ledger);
  impl_->impulses = std::move(impulses);
  impl_->steps = steps;
  impl_->cuts = cuts;
  impl_->iterations = iterations;
  impl_->largestResidual = largestResidual;
  impl_->solver().restart(std::move(next));
}

}  // namespace dovetail::fem
