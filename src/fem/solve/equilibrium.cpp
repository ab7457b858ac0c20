#include "equilibrium.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "newton_tools.hpp"

namespace dovetail::fem::detail {

namespace {

using Clock = std::chrono::steady_clock;
double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// F = 1 + ∂u/∂X is known to ε, however small ∂u/∂X is: as if every node were off by ε times its distance from the
/// others. What that does to the forces, N.
double strainResolution(const BlockMatrix& K, std::span<const Vec3> X) {
  double squares = 0.0;
  for (std::size_t n = 0; n < K.nodes(); ++n) {
    double sum = 0.0;
    for (int k = K.offsets()[n]; k < K.offsets()[n + 1]; ++k) {
      const double* const block = &K.values()[9 * static_cast<std::size_t>(k)];
      const double largest = *std::max_element(block, block + 9), least = *std::min_element(block, block + 9);
      const Vec3& other = X[static_cast<std::size_t>(K.columns()[static_cast<std::size_t>(k)])];
      sum += std::max(largest, -least) * norm(X[n] - other);
    }
    squares += sum * sum;
  }
  return std::numeric_limits<double>::epsilon() * std::sqrt(squares);
}

}  // namespace

void validate(const NewtonOptions& options) {
  requirePositive(options.relativeTolerance, "relativeTolerance");
  requireNonNegative(options.absoluteTolerance, "absoluteTolerance");
  requireNonNegative(options.reuseContraction, "reuseContraction");
  if (options.maxIterations < 1)
    throw InputError("no iterations are allowed", "NewtonOptions", "give maxIterations of 1 or more");
}

Equilibrium::Equilibrium(Model& model, const NewtonOptions& options)
    : model_(model),
      options_(options),
      dofs_(model.constraints, model.nodes),
      solver_(dofs_, options.linear),
      K_(couplingPattern(model)),
      forces_(model.nodes.X.size()),
      loads_(forces_.size()),
      scratch_(forces_.size()),
      residual_(dofs_.size()) {}

bool Equilibrium::symmetric() const {
  return std::all_of(model_.terms.begin(), model_.terms.end(), [](const auto& term) { return term->isSymmetric(); });
}

double Equilibrium::evaluate(double t) {
  const auto start = Clock::now();
  std::fill(forces_.begin(), forces_.end(), Vec3{});
  std::fill(loads_.begin(), loads_.end(), Vec3{});
  double largest = 0.0;
  for (const auto& term : model_.terms) {
    std::fill(scratch_.begin(), scratch_.end(), Vec3{});
    term->addForces(model_.nodes, {t, 0.0}, scratch_);
    largest = std::max(largest, normOf(scratch_));
    for (std::size_t n = 0; n < scratch_.size(); ++n) {
      forces_[n] += scratch_[n];
      if (!term->hasEnergy()) loads_[n] += scratch_[n];
    }
  }
  dofs_.reduce(forces_, residual_);
  // Displacements are known to a relative ε, hence forces to no better than ε K u.
  const double ofDisplacement =
      2.0 * std::numeric_limits<double>::epsilon() * solver_.largestDiagonal() * normOf(model_.nodes.u);
  const double resolution = std::max(ofDisplacement, ofStrain_);
  tolerance_ = options_.relativeTolerance * largest + options_.absoluteTolerance + resolution;
  assemblySeconds_ += since(start);
  return normOf(residual_);
}

bool Equilibrium::factor(double t) {
  const auto start = Clock::now();
  K_.setZero();
  for (const auto& term : model_.terms) term->addTangent(model_.nodes, {t, 0.0}, K_);
  ofStrain_ = strainResolution(K_, model_.nodes.X);
  assemblySeconds_ += since(start);
  const auto middle = Clock::now();
  const bool done = solver_.factor(K_, symmetric());
  solverSeconds_ += since(middle);
  return done;
}

void Equilibrium::solve(std::span<const double> r, std::span<double> x) {
  const auto start = Clock::now();
  solver_.solve(r, x);
  solverSeconds_ += since(start);
}

namespace {

/// Moves prescribed components to time t and the free ones with them, by the tangent of the old state.
bool predict(Equilibrium& equilibrium, double t) {
  Model& model = equilibrium.model();
  const DofMap& dofs = equilibrium.dofs();
  std::vector<Vec3> moved = model.nodes.u;
  dofs.apply(t, moved);
  double change = 0.0;
  for (std::size_t n = 0; n < moved.size(); ++n) change += squaredNorm(moved[n] - model.nodes.u[n]);
  if (change == 0.0) return true;
  if (!equilibrium.factor(t)) return false;
  std::vector<Vec3> push(moved.size()), motion(moved.size());
  for (std::size_t n = 0; n < moved.size(); ++n) motion[n] = moved[n] - model.nodes.u[n];
  equilibrium.stiffness().multiply(motion, push);
  std::vector<double> pushed(dofs.size()), step(dofs.size());
  dofs.reduce(push, pushed);
  for (std::size_t i = 0; i < step.size(); ++i) step[i] = equilibrium.residual()[i] - pushed[i];
  equilibrium.solve(step, step);
  model.nodes.u = moved;
  dofs.addIncrement(step, model.nodes.u);
  dofs.apply(t, model.nodes.u);
  return true;
}

/// Finds a share of the step with r·step well below its first value (Matthies & Strang 1979); on return the model is
/// there and evaluated.
double search(Equilibrium& equilibrium, double t, std::span<const Vec3> start, std::span<const double> step,
              double slopeAtStart) {
  Model& model = equilibrium.model();
  const auto moveTo = [&](double share) {
    std::vector<double> part(step.begin(), step.end());
    for (double& value : part) value *= share;
    std::copy(start.begin(), start.end(), model.nodes.u.begin());
    equilibrium.dofs().addIncrement(part, model.nodes.u);
    return equilibrium.evaluate(t);
  };
  double share = 1.0, norm = moveTo(1.0);
  for (int trial = 0; trial < 8; ++trial) {
    const double slope = product(equilibrium.residual(), step);
    if (std::isfinite(norm) && (std::abs(slope) <= 0.8 * std::abs(slopeAtStart) || norm <= equilibrium.tolerance()))
      return norm;
    if (std::isfinite(norm) && slope * slopeAtStart > 0.0) return norm;  // still downhill: a full step is as good
    share = shorterShare(share, slopeAtStart, slope);
    norm = moveTo(share);
  }
  return norm;
}

}  // namespace

NewtonResult iterate(Equilibrium& equilibrium, double t, const NewtonOptions& options) {
  Model& model = equilibrium.model();
  double norm = equilibrium.evaluate(t), before = norm;
  if (!predict(equilibrium, t)) return {-1, norm, "the tangent is singular"};
  norm = equilibrium.evaluate(t);
  std::vector<double> step(equilibrium.dofs().size());
  for (int iteration = 0;; ++iteration) {
    if (!std::isfinite(norm)) return {-1, norm, "the forces are not finite"};
    if (iteration > 0 && norm <= equilibrium.tolerance()) return {iteration, norm, {}};
    if (iteration == 0 && norm == 0.0 && equilibrium.solver().factored()) return {0, 0.0, {}};
    if (iteration == options.maxIterations)
      return {-1, norm,
              "Newton's method does not converge: " + formatNumber(norm) + " N out of balance after " +
                  std::to_string(iteration) + " iterations"};
    const bool keep = options.reuseContraction > 0.0 && equilibrium.solver().factored() &&
                      (iteration == 0 || norm <= options.reuseContraction * before);
    if (!keep && !equilibrium.factor(t)) return {-1, norm, "the tangent is singular or not finite"};
    before = norm;
    equilibrium.solve(equilibrium.residual(), step);
    const double slope = product(equilibrium.residual(), step);
    const std::vector<Vec3> start = model.nodes.u;
    if (options.lineSearch && iteration > 0) {
      norm = search(equilibrium, t, start, step, slope);
    } else {
      equilibrium.dofs().addIncrement(step, model.nodes.u);
      norm = equilibrium.evaluate(t);
      if (options.lineSearch && !std::isfinite(norm)) norm = search(equilibrium, t, start, step, slope);
    }
  }
}

void bookWork(const Equilibrium& equilibrium, const Model& model, std::span<const Vec3> f0,
              std::span<const Vec3> loads0, std::span<const Vec3> u0, StaticReport& report) {
  for (std::size_t n = 0; n < u0.size(); ++n) {
    const Vec3 motion = model.nodes.u[n] - u0[n];
    report.loadWork += 0.5 * dot(loads0[n] + equilibrium.loads()[n], motion);
    // In equilibrium the sum of all forces differs from zero where supports hold or move the node.
    report.supportWork -= 0.5 * dot(f0[n] + equilibrium.forces()[n], motion);
  }
}

void acceptTerms(Model& model, double t, StaticReport& report) {
  for (const auto& term : model.terms) {
    report.dissipated += term->commit(model.nodes, {t, 0.0});
    report.supportWork += term->workOfMotion();
  }
}

void finishReport(Equilibrium& equilibrium, std::chrono::steady_clock::time_point start, StaticReport& report) {
  Model& model = equilibrium.model();
  report.storedAfter = storedEnergy(model, {model.t, 0.0});
  report.factorisations = equilibrium.solver().factorisations();
  report.solver = equilibrium.solver().method();
  report.assemblySeconds = equilibrium.assemblySeconds();
  report.solverSeconds = equilibrium.solverSeconds();
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  model.nodes.f.assign(equilibrium.forces().begin(), equilibrium.forces().end());
}

}  // namespace dovetail::fem::detail
