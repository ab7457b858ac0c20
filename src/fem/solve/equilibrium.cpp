#include "equilibrium.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::fem::detail {

namespace {

using Clock = std::chrono::steady_clock;
double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

}  // namespace

void validate(const NewtonOptions& options) {
  requirePositive(options.relativeTolerance, "relativeTolerance");
  requireNonNegative(options.absoluteTolerance, "absoluteTolerance");
  requireNonNegative(options.reuseContraction, "reuseContraction");
  if (options.maxIterations < 1)
    throw InputError("no iterations are allowed", "NewtonOptions", "give maxIterations of 1 or more");
  if (options.mixing < 0 || (options.mixing > 0 && options.reuseContraction == 0.0))
    throw InputError(
        "mixing is " + std::to_string(options.mixing) + ", reuseContraction " + formatNumber(options.reuseContraction),
        "NewtonOptions", "increments mix with those of the same factors: keep these by reuseContraction");
}

void requireLater(double tEnd, const Model& model, const char* where) {
  if (!(tEnd > model.t))
    throw InputError("tEnd is " + formatNumber(tEnd) + " s, the model is at " + formatNumber(model.t) + " s", where,
                     "give a later time");
}

NewtonPolicy policyOf(const NewtonOptions& options) {
  const bool keep = options.reuseContraction > 0.0;
  return {options.maxIterations, options.lineSearch ? LineSearch::always : LineSearch::never,
          keep ? std::numeric_limits<int>::max() : 0, options.reuseContraction,
          static_cast<std::size_t>(std::max(options.mixing, 1))};
}

Balance::Balance(Model& model, double relative, double absolute)
    : model_(model),
      relative_(relative),
      absolute_(absolute),
      now_{model.t, 0.0},
      dofs_(model.constraints, model.nodes),
      forces_(model.nodes.X.size()),
      loads_(forces_.size()),
      scratch_(forces_.size()),
      residual_(dofs_.size()) {
  if (model.nodes.X.empty()) return;
  Vec3 lower = model.nodes.X.front(), upper = lower;
  for (const Vec3& X : model.nodes.X)
    for (int c = 0; c < 3; ++c) lower[c] = std::min(lower[c], X[c]), upper[c] = std::max(upper[c], X[c]);
  far_ = 1e3 * norm(upper - lower) * std::sqrt(static_cast<double>(model.nodes.X.size()));
}

double Balance::findForces() {
  const auto start = Clock::now();
  std::fill(forces_.begin(), forces_.end(), Vec3{});
  std::fill(loads_.begin(), loads_.end(), Vec3{});
  double largest = 0.0;
  for (const auto& term : model_.terms) {
    std::fill(scratch_.begin(), scratch_.end(), Vec3{});
    term->addForces(model_.nodes, now_, scratch_);
    largest = std::max(largest, normOf(scratch_));
    for (std::size_t n = 0; n < scratch_.size(); ++n) {
      forces_[n] += scratch_[n];
      if (!term->hasEnergy()) loads_[n] += scratch_[n];
    }
  }
  dofs_.reduce(forces_, residual_);
  const double displacement = normOf(model_.nodes.u);
  double roundOff = resolution_.worstAt(displacement);
  // A body that nothing holds gets away until its forces are lost in round-off: that is no equilibrium.
  if (displacement > far_) roundOff = std::min(roundOff, 1e-3 * largest);
  zero_ = relative_ * largest + absolute_ + roundOff;
  assemblySeconds_ += since(start);
  return normOf(residual_);
}

Equilibrium::Equilibrium(Model& model, const NewtonOptions& options)
    : Balance(model, options.relativeTolerance, options.absoluteTolerance),
      solver_(dofs(), options.linear, &model.nodes),
      K_(zeroTangent(model)),
      increment_(dofs().size()),
      part_(dofs().size()) {
  if (options.mixing > 0) mixing_.emplace(options.mixing);
}

bool Equilibrium::factor(bool) {
  const auto start = Clock::now();
  K_.setZero();
  addTangents(model(), now(), K_);
  resolution_.measure(K_, model().nodes.X);
  assemblySeconds_ += since(start);
  const auto middle = Clock::now();
  const bool symmetric = std::ranges::all_of(model().terms, [](const auto& term) { return term->isSymmetric(); });
  const bool done = solver_.factor(K_, symmetric);
  if (mixes_) mixing_->clear();
  solverSeconds_ += since(middle);
  return done;
}

void Equilibrium::solve(std::span<const double> r, std::span<double> x, double loosest) {
  const auto start = Clock::now();
  solver_.solve(r, x, loosest);
  solverSeconds_ += since(start);
}

bool Equilibrium::direct(double loosest) {
  start_ = model().nodes.u;
  solve(residual(), increment_, loosest);
  if (mixes_) mixing_->better(increment_);
  ++solves_;
  return true;
}

void Equilibrium::moveTo(double fraction) {
  for (std::size_t i = 0; i < part_.size(); ++i) part_[i] = fraction * increment_[i];
  if (mixes_) mixing_->moved(part_);
  model().nodes.u = start_;
  dofs().addIncrement(part_, model().nodes.u);
}

bool Equilibrium::predict() {
  std::vector<Vec3> moved = model().nodes.u;
  dofs().apply(now().t, moved);
  std::vector<Vec3> push(moved.size()), motion(moved.size());
  for (std::size_t n = 0; n < moved.size(); ++n) motion[n] = moved[n] - model().nodes.u[n];
  if (normOf(motion) == 0.0) return true;
  evaluate();
  const bool lasts = mixing_ && solver_.factored() && solvesBefore_ <= mixing_->depth();
  if (!lasts && !factor()) return false;
  K_.multiply(motion, push);
  dofs().reduce(push, part_);
  for (std::size_t i = 0; i < part_.size(); ++i) part_[i] = residual()[i] - part_[i];
  solve(part_, part_);
  model().nodes.u = moved;
  dofs().addIncrement(part_, model().nodes.u);
  dofs().apply(now().t, model().nodes.u);
  return true;
}

void Equilibrium::describe(StaticReport& report) const {
  Balance::describe(report);
  report.factorisations = solver_.factorisations();
  report.solver = solver_.method();
  report.linearIterations = solver_.iterations();
  report.solverSeconds = solverSeconds_;
}

double bookWork(const Balance& balance, std::span<const Vec3> f0, std::span<const Vec3> loads0,
                std::span<const Vec3> u0, StaticReport& report) {
  const std::vector<Vec3>& u = balance.model().nodes.u;
  double all = 0.0, free = 0.0;
  for (std::size_t n = 0; n < u0.size(); ++n) {
    const Vec3 motion = u[n] - u0[n];
    report.loadWork += 0.5 * dot(loads0[n] + balance.loads()[n], motion);
    all += 0.5 * dot(f0[n] + balance.forces()[n], motion);
  }
  std::vector<double> residual0(balance.dofs().size());
  balance.dofs().reduce(f0, residual0);
  for (std::size_t i = 0; i < residual0.size(); ++i) {
    const auto dof = static_cast<std::size_t>(balance.dofs().freeDofs()[i]);
    const int c = static_cast<int>(dof % 3);
    free += 0.5 * (residual0[i] + balance.residual()[i]) * (u[dof / 3][c] - u0[dof / 3][c]);
  }
  report.supportWork -= all - free;
  return free;
}

void acceptTerms(Model& model, const Instant& now, StaticReport& report) {
  for (const auto& term : model.terms) {
    report.dissipated += term->commit(model.nodes, now);
    report.supportWork += term->workOfMotion();
  }
}

void finishReport(const Balance& balance, std::chrono::steady_clock::time_point start, StaticReport& report) {
  Model& model = balance.model();
  report.storedAfter = storedEnergy(model, {model.t, 0.0});
  balance.describe(report);
  report.seconds = since(start);
}

}  // namespace dovetail::fem::detail
