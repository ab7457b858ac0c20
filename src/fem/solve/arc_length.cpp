// The cylindrical arc-length method (Riks 1979, Crisfield 1981) with model time as the load parameter.
#include <algorithm>
#include <chrono>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "equilibrium.hpp"

namespace dovetail::fem {

namespace {

using detail::Equilibrium;

double dotOf(std::span<const Vec3> a, std::span<const Vec3> b) {
  double sum = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n) sum += dot(a[n], b[n]);
  return sum;
}

/// A tracer of one path: unknowns are u and t, the arc since the last equilibrium has a given length.
class PathStep {
public:
  PathStep(Equilibrium& equilibrium, const ArcLengthOptions& options)
      : equilibrium_(equilibrium), options_(options), model_(equilibrium.model()), rate_(model_.nodes.u.size()) {}

  /// ∂u/∂t along the equilibria at the present state, by a new factorisation.
  bool findRate(double t) {
    const double h = 1e-6 * std::max(std::abs(t), options_.firstStep);
    std::vector<double> push(equilibrium_.dofs().size()), back(push.size());
    equilibrium_.evaluate(t + h);
    push.assign(equilibrium_.residual().begin(), equilibrium_.residual().end());
    equilibrium_.evaluate(t - h);
    for (std::size_t i = 0; i < push.size(); ++i) push[i] = (push[i] - equilibrium_.residual()[i]) / (2.0 * h);
    std::vector<Vec3> later = model_.nodes.u, earlier = model_.nodes.u, pulled(later.size());
    equilibrium_.dofs().apply(t + h, later);
    equilibrium_.dofs().apply(t - h, earlier);
    for (std::size_t n = 0; n < later.size(); ++n) rate_[n] = (later[n] - earlier[n]) / (2.0 * h);
    equilibrium_.evaluate(t);
    if (!equilibrium_.factor(t)) return false;
    equilibrium_.stiffness().multiply(rate_, pulled);
    equilibrium_.dofs().reduce(pulled, back);
    for (std::size_t i = 0; i < push.size(); ++i) push[i] -= back[i];
    equilibrium_.solve(push, push);
    equilibrium_.dofs().addIncrement(push, rate_);
    return true;
  }

  std::span<const Vec3> rate() const { return rate_; }

  /// Goes the arc from (u, t); on success the model is in equilibrium there and `t` is its time.
  /// @param direction  1 or −1: towards larger or smaller t at the start
  detail::NewtonResult advance(double arc, double direction, double& t) {
    const std::vector<Vec3> start = model_.nodes.u;
    const double speed = std::sqrt(dotOf(rate_, rate_));
    if (!(speed > 0.0)) return {-1, 0.0, "nothing moves with t: the path has no direction"};
    std::vector<Vec3> moved(start.size());
    double now = t + direction * arc / speed;
    for (std::size_t n = 0; n < moved.size(); ++n) moved[n] = direction * arc / speed * rate_[n];
    for (int iteration = 1;; ++iteration) {
      place(start, moved, now);
      const double norm = equilibrium_.evaluate(now);
      if (!std::isfinite(norm)) return {-1, norm, "the forces are not finite"};
      if (norm <= equilibrium_.tolerance()) {
        t = now;
        return {iteration, norm, {}};
      }
      if (iteration > options_.newton.maxIterations) return {-1, norm, "the arc-length iteration does not converge"};
      if (!findRate(now)) return {-1, norm, "the tangent is singular"};
      if (!correct(arc, moved, now)) return {-1, norm, "the arc does not meet the path"};
    }
  }

private:
  void place(std::span<const Vec3> start, std::span<const Vec3> moved, double t) {
    for (std::size_t n = 0; n < start.size(); ++n) model_.nodes.u[n] = start[n] + moved[n];
    equilibrium_.dofs().apply(t, model_.nodes.u);
  }

  /// moved += K⁻¹ r + δt rate with |moved| = arc; of the two δt the one that turns the arc least.
  bool correct(double arc, std::vector<Vec3>& moved, double& t) {
    std::vector<double> step(equilibrium_.dofs().size());
    equilibrium_.solve(equilibrium_.residual(), step);
    std::vector<Vec3> next = moved;
    equilibrium_.dofs().addIncrement(step, next);
    const double a = dotOf(rate_, rate_), b = dotOf(rate_, next), c = dotOf(next, next) - arc * arc;
    const double discriminant = b * b - a * c;
    if (!(discriminant >= 0.0)) return false;
    const double root = std::sqrt(discriminant), first = (-b + root) / a, second = (-b - root) / a;
    const double turn = dotOf(moved, rate_);
    const double change = turn * first > turn * second ? first : second;
    for (std::size_t n = 0; n < moved.size(); ++n) moved[n] = next[n] + change * rate_[n];
    t += change;
    return true;
  }

  Equilibrium& equilibrium_;
  const ArcLengthOptions& options_;
  Model& model_;
  std::vector<Vec3> rate_;
};

void validate(const ArcLengthOptions& options) {
  detail::validate(options.newton);
  requirePositive(options.firstStep, "firstStep");
  requireNonNegative(options.largestStep, "largestStep");
  requirePositive(options.smallestShare, "smallestShare");
  if (options.newton.linear.method != LinearMethod::direct)
    throw InputError("conjugate gradients cannot pass limit points", "ArcLengthOptions", "use LinearMethod::direct");
}

}  // namespace

StaticReport followPath(Model& model, double tEnd, const ArcLengthOptions& options, const StaticObserver& observer) {
  validate(options);
  const auto start = std::chrono::steady_clock::now();
  Equilibrium equilibrium(model, options.newton);
  StaticReport report;
  report.storedBefore = storedEnergy(model, {model.t, 0.0});
  PathStep path(equilibrium, options);
  if (!path.findRate(model.t)) throw NumericalError("the tangent is singular", "followPath", "hold the model");
  const double firstArc = options.firstStep * std::sqrt(dotOf(path.rate(), path.rate()));
  const double largestArc = options.largestStep > 0.0 ? options.largestStep : 8.0 * firstArc;
  double arc = std::min(firstArc, largestArc), direction = 1.0;
  std::vector<Vec3> lastMove;
  while (static_cast<int>(report.steps.size()) < options.maxSteps && model.t < tEnd) {
    const std::vector<Vec3> u0 = model.nodes.u, f0(equilibrium.forces().begin(), equilibrium.forces().end()),
                            loads0(equilibrium.loads().begin(), equilibrium.loads().end());
    if (!lastMove.empty()) direction = dotOf(path.rate(), lastMove) >= 0.0 ? 1.0 : -1.0;
    double t = model.t;
    detail::NewtonResult result = path.advance(arc, direction, t);
    if (result.failure.empty()) {
      try {
        for (const auto& term : model.terms)
          term->requireValid(model.nodes, "t = " + formatNumber(t) + " s", Scrutiny::all);
      } catch (const NumericalError& error) {
        result.failure = error.what();
      }
    }
    if (!result.failure.empty()) {
      model.nodes.u = u0;
      arc *= 0.4;
      ++report.cuts;
      if (arc < options.smallestShare * firstArc || !path.findRate(model.t))
        throw NumericalError(result.failure, "followPath, t = " + formatNumber(model.t) + " s",
                             "give smaller steps or a finer mesh");
      continue;
    }
    detail::bookWork(equilibrium, model, f0, loads0, u0, report);
    detail::acceptTerms(model, t, report);
    lastMove.resize(u0.size());
    for (std::size_t n = 0; n < u0.size(); ++n) lastMove[n] = model.nodes.u[n] - u0[n];
    model.t = t;
    report.iterations += result.iterations;
    const bool regular = path.findRate(t);
    report.steps.push_back({t, result.iterations, result.residual, equilibrium.solver().negativePivots()});
    if (!regular || (observer && !observer(model, report.steps.back()))) break;
    const double growth = std::sqrt(static_cast<double>(options.iterationTarget) / result.iterations);
    arc = std::min(largestArc, arc * std::clamp(growth, 0.5, 2.0));
  }
  detail::finishReport(equilibrium, start, report);
  return report;
}

}  // namespace dovetail::fem
