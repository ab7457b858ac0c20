// Continuation of equilibria with model time as the load parameter: by the cylindrical arc length (Riks 1979,
// Crisfield 1981), by one displacement (de Borst 1987), or by what is dissipated (Gutiérrez 2004).
#include <algorithm>
#include <chrono>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "equilibrium.hpp"

namespace dovetail::fem {

namespace {

using detail::Equilibrium;
using detail::innerProduct;
using detail::NewtonResult;
using detail::normOf;

/// The next point of a path: unknowns are u and t, and the length of the way since the last equilibrium is given.
class PathStep : public detail::NewtonProblem {
public:
  /// @param path  null: the parameter is the time
  PathStep(Equilibrium& equilibrium, const ArcLengthOptions& options, const ParameterPath* path, double tEnd)
      : equilibrium_(equilibrium),
        options_(options),
        model_(equilibrium.model()),
        path_(path),
        at_(path ? path->at : model_.t),
        tStart_(path ? 0.0 : model_.t),
        tEnd_(tEnd),
        rate_(model_.nodes.u.size()),
        moved_(rate_.size()) {}

  /// ∂u/∂t along the equilibria at the present displacement, by a new factorisation.
  bool findRate(double t);
  std::span<const Vec3> rate() const { return rate_; }
  /// Of a way, as the control sees it.
  double length(std::span<const Vec3> way) const {
    return byDisplacement() ? way[static_cast<std::size_t>(options_.node)][options_.component] : normOf(way);
  }

  /// What a step of the given way and time dissipates if all of it is damage, J.
  double dissipation(std::span<const Vec3> way, double time) const {
    return 0.5 * (at_ * innerProduct(way, loadRate_) - time * innerProduct(from_, loadRate_));
  }

  /// From the present equilibrium by the tangent.
  /// @param signedLength  below 0: towards smaller t at the start
  /// @param spending      the step is as long as the dissipation in the options wants it
  /// @return the time there, not finite if the tangent has no such point
  double start(double signedLength, bool spending) {
    from_ = model_.nodes.u;
    spending_ = spending;
    // One displacement keeps its sense, the arc takes that of t.
    const double change = spending ? options_.dissipation / dissipation(rate_, 1.0) : signedLength / length(rate_);
    for (std::size_t n = 0; n < moved_.size(); ++n) moved_[n] = change * rate_[n];
    expected_ = std::abs(length(moved_));
    goal_ = spending ? options_.dissipation : byDisplacement() ? signedLength : std::abs(signedLength);
    t_ = at_ + change;
    return t_;
  }
  /// The parameter in the present equilibrium.
  double at() const { return at_; }
  void arrive(double t) { at_ = t; }
  /// The time at a value of the parameter.
  double timeAt(double t) const { return path_ ? model_.t : t; }
  /// Forces are asked for at this value of the parameter from now on.
  void aim(double t) {
    if (path_) path_->set(t);
    equilibrium_.aim({timeAt(t), 0.0});
  }
  /// Whether the way to the present state is much longer than the tangent said.
  bool strays() const {
    std::vector<Vec3> way = model_.nodes.u;
    for (std::size_t n = 0; n < way.size(); ++n) way[n] -= from_[n];
    return std::abs(length(way)) > 2.0 * expected_;
  }
  double t() const { return t_; }
  /// Puts the model on the way at time t by interpolation.
  void cutAt(double t) {
    const double fraction = (t - at_) / (t_ - at_);
    for (Vec3& value : moved_) value *= fraction;
    t_ = t;
    place();
  }

  double evaluate() override {
    place();
    return equilibrium_.evaluate();
  }
  double tolerance() const override { return equilibrium_.tolerance(); }
  bool factored() const override { return false; }
  bool factor(bool) override { return findRate(t_); }
  bool direct(double loosest) override;
  double slope() const override { return 0.0; }
  void moveTo(double fraction) override {
    for (std::size_t n = 0; n < moved_.size(); ++n) moved_[n] = movedBefore_[n] + fraction * increment_[n];
    t_ = tBefore_ + fraction * timeIncrement_;
  }

private:
  bool byDisplacement() const { return options_.node >= 0; }
  void place() {
    for (std::size_t n = 0; n < from_.size(); ++n) model_.nodes.u[n] = from_[n] + moved_[n];
    equilibrium_.dofs().apply(timeAt(t_), model_.nodes.u);
    aim(t_);
  }
  /// δt such that `way` + δt rate has the length or the dissipation asked for; not finite if there is none.
  double change(std::span<const Vec3> way) const;

  Equilibrium& equilibrium_;
  const ArcLengthOptions& options_;
  Model& model_;
  const ParameterPath* path_;
  double at_, tStart_, tEnd_;
  double t_ = 0.0, goal_ = 0.0, expected_ = 0.0, tBefore_ = 0.0, timeIncrement_ = 0.0;
  bool spending_ = false;
  std::vector<Vec3> from_, rate_, moved_, movedBefore_, increment_;
  std::vector<Vec3> loadRate_;  // ∂f/∂t at rest
};

bool PathStep::findRate(double t) {
  const double h = 1e-6 * std::max(std::abs(t), options_.firstStep);
  // Loads may have a kink where the path begins or ends.
  const double later = t <= tEnd_ ? std::min(t + h, tEnd_) : t + h,
               earlier = t >= tStart_ ? std::max(t - h, tStart_) : t - h;
  const auto forcesAt = [&](double time) {
    aim(time);
    equilibrium_.evaluate();
    return std::vector<Vec3>(equilibrium_.forces().begin(), equilibrium_.forces().end());
  };
  loadRate_ = forcesAt(later);
  const std::vector<Vec3> less = forcesAt(earlier);
  for (std::size_t n = 0; n < less.size(); ++n) loadRate_[n] = (loadRate_[n] - less[n]) / (later - earlier);
  std::vector<double> push(equilibrium_.dofs().size()), back(push.size());
  equilibrium_.dofs().reduce(loadRate_, push);
  std::vector<Vec3> ahead = model_.nodes.u, behind = model_.nodes.u, pulled(ahead.size());
  equilibrium_.dofs().apply(timeAt(later), ahead);
  equilibrium_.dofs().apply(timeAt(earlier), behind);
  for (std::size_t n = 0; n < ahead.size(); ++n) rate_[n] = (ahead[n] - behind[n]) / (later - earlier);
  forcesAt(t);
  if (!equilibrium_.factor()) return false;
  equilibrium_.stiffness().multiply(rate_, pulled);
  equilibrium_.dofs().reduce(pulled, back);
  for (std::size_t i = 0; i < push.size(); ++i) push[i] -= back[i];
  equilibrium_.solve(push, push);
  equilibrium_.dofs().addIncrement(push, rate_);
  return true;
}

double PathStep::change(std::span<const Vec3> way) const {
  if (spending_) return (goal_ - dissipation(way, t_ - at_)) / dissipation(rate_, 1.0);
  if (byDisplacement()) return (goal_ - length(way)) / length(rate_);
  const double a = innerProduct(rate_, rate_), b = innerProduct(rate_, way), c = innerProduct(way, way) - goal_ * goal_;
  const double root = std::sqrt(b * b - a * c), first = (-b + root) / a, second = (-b - root) / a;
  const double turn = innerProduct(moved_, rate_);  // of the two the one that turns the arc least
  return turn * first > turn * second ? first : second;
}

/// K⁻¹ r + δt rate.
bool PathStep::direct(double) {
  std::vector<double> step(equilibrium_.dofs().size());
  equilibrium_.solve(equilibrium_.residual(), step);
  movedBefore_ = moved_;
  tBefore_ = t_;
  increment_.assign(moved_.size(), Vec3{});
  equilibrium_.dofs().addIncrement(step, increment_);
  std::vector<Vec3> way = moved_;
  for (std::size_t n = 0; n < way.size(); ++n) way[n] += increment_[n];
  timeIncrement_ = change(way);
  for (std::size_t n = 0; n < way.size(); ++n) increment_[n] += timeIncrement_ * rate_[n];
  return std::isfinite(timeIncrement_);
}

void validate(const ArcLengthOptions& options, const Model& model) {
  detail::validate(options.newton);
  requirePositive(options.firstStep, "firstStep");
  requireNonNegative(options.largestStep, "largestStep");
  requirePositive(options.smallestFraction, "smallestFraction");
  requireNonNegative(options.dissipation, "dissipation");
  if (options.node >= static_cast<int>(model.nodes.u.size()) || options.component < 0 || options.component > 2)
    throw InputError(
        "there is no component " + std::to_string(options.component) + " of node " + std::to_string(options.node),
        "ArcLengthOptions", "give a node of the model and 0, 1 or 2");
  if (options.newton.linear.method == linalg::LinearMethod::conjugateGradients ||
      options.newton.linear.method == linalg::LinearMethod::multigrid)
    throw InputError("conjugate gradients and multigrid cannot pass limit points", "ArcLengthOptions",
                     "use linalg::LinearMethod::direct");
}

/// A trial of the next point of a path: as far as the length says, or at tEnd if that is nearer.
class PathTrial {
public:
  PathTrial(Equilibrium& equilibrium, PathStep& path, const ArcLengthOptions& options, double tEnd)
      : equilibrium_(equilibrium), path_(path), options_(options), tEnd_(tEnd) {}

  /// On success the model is in equilibrium at t(); on failure as before.
  NewtonResult advance(double signedLength, bool spending) {
    const double t = path_.start(signedLength, spending);
    if (!std::isfinite(t)) return {0, 0.0, 0.0, "nothing moves with t"};
    if (t >= tEnd_) {
      NewtonResult result = attempt(signedLength, spending, true);
      if (result.failure.empty()) return result;
    }
    return attempt(signedLength, spending, false);
  }
  double t() const { return t_; }

private:
  NewtonResult attempt(double signedLength, bool spending, bool atEnd) {
    bool started = false;
    now_.t = equilibrium_.model().t;
    return detail::attemptStep(equilibrium_.model(), now_, options_.maxAugmentations, [&] {
      if (!started) path_.start(signedLength, spending);
      if (!started && atEnd) path_.cutAt(tEnd_);
      started = true;
      NewtonResult result;
      if (!atEnd) {
        result = detail::newton(path_, {options_.newton.maxIterations, detail::LineSearch::never});
        arrive(path_.t());
        if (!result.failure.empty() || t_ <= tEnd_) return result;
        path_.cutAt(tEnd_);
        atEnd = true;
      }
      return settle(result.iterations);
    });
  }
  /// Equilibrium at tEnd, on the way that the path takes there.
  NewtonResult settle(int iterationsBefore) {
    arrive(tEnd_);
    path_.aim(tEnd_);
    equilibrium_.beginStep();
    NewtonResult result = detail::newton(equilibrium_, detail::policyOf(options_.newton));
    result.iterations += iterationsBefore;
    if (result.failure.empty() && path_.strays())
      result.failure = "there is no equilibrium at the end of the path nearby";
    return result;
  }

  void arrive(double t) {
    t_ = t;
    now_.t = path_.timeAt(t);
  }

  Equilibrium& equilibrium_;
  PathStep& path_;
  const ArcLengthOptions& options_;
  double tEnd_, t_ = 0.0;
  Instant now_;
};

/// @param given  null: the parameter is the time
StaticReport follow(Model& model, ParameterPath* given, double end, const ArcLengthOptions& options,
                    const StaticObserver& observer) {
  const auto start = std::chrono::steady_clock::now();
  NewtonOptions newton = options.newton;
  newton.linear.method = linalg::LinearMethod::direct;  // iterations tell no negative pivots
  Equilibrium equilibrium(model, newton);
  if (options.dissipation > 0.0 && equilibrium.dofs().hasMotion())
    throw InputError("dissipation is that of loads alone, but there is prescribed motion", "ArcLengthOptions",
                     "set dissipation to 0, or load the body by forces");
  PathStep path(equilibrium, options, given, end);
  PathTrial trial(equilibrium, path, options, end);
  if (!path.findRate(path.at())) throw NoEquilibrium("the tangent is singular", "followPath", "hold the model");
  StaticReport report;
  report.storedBefore = storedEnergy(model, {model.t, 0.0});
  ParameterPath own;
  ParameterPath& way = given ? *given : own;
  const bool begins = way.firstLength == 0.0;
  if (begins) way.firstLength = options.firstStep * path.length(path.rate());
  if (way.firstLength == 0.0)
    throw NoEquilibrium("nothing moves with t", "followPath",
                        "give loads that are functions of t, and a component that moves if there is a node");
  const double first = std::abs(way.firstLength),
               largest = options.largestStep > 0.0 ? options.largestStep : 8.0 * first;
  way.length = std::min(begins ? first : way.length, largest);
  double sense = way.firstLength < 0.0 ? -1.0 : 1.0;
  bool spending = false;
  while (static_cast<int>(report.steps.size()) < options.maxSteps && path.at() < end) {
    const std::vector<Vec3> u0 = model.nodes.u, f0(equilibrium.forces().begin(), equilibrium.forces().end()),
                            loads0(equilibrium.loads().begin(), equilibrium.loads().end());
    if (!way.lastMove.empty() && options.node < 0) sense = innerProduct(path.rate(), way.lastMove) >= 0.0 ? 1.0 : -1.0;
    const NewtonResult result = trial.advance(sense * way.length, spending);
    if (!result.failure.empty() && spending) {
      spending = false;
      if (path.findRate(path.at())) continue;
    }
    if (!result.failure.empty()) {
      way.length *= 0.4;
      ++report.cuts;
      if (way.length < options.smallestFraction * first || !path.findRate(path.at())) {
        model.nodes.f = f0;
        throw NoEquilibrium(result.failure, "followPath, t = " + formatNumber(path.at()) + " s",
                            "give smaller steps or a finer mesh");
      }
      continue;
    }
    detail::bookWork(equilibrium, f0, loads0, u0, report);
    detail::acceptTerms(model, {path.timeAt(trial.t()), 0.0}, report);
    way.lastMove.resize(u0.size());
    for (std::size_t n = 0; n < u0.size(); ++n) way.lastMove[n] = model.nodes.u[n] - u0[n];
    if (spending) way.length = std::min(largest, std::abs(path.length(way.lastMove)));
    spending = options.dissipation > 0.0 &&
               path.dissipation(way.lastMove, trial.t() - path.at()) >= 0.999 * options.dissipation;
    path.arrive(trial.t());
    way.at = path.at();
    if (!given) model.t = path.at();
    report.iterations += result.iterations;
    const bool regular = path.findRate(path.at());
    report.steps.push_back(
        {path.at(), result.iterations, result.residual, equilibrium.negativePivots(), result.tolerance});
    const double growth = std::sqrt(static_cast<double>(options.iterationTarget) / std::max(1, result.iterations));
    way.length = std::min(largest, way.length * std::clamp(growth, 0.5, 2.0));
    if (!regular || (observer && !observer(model, report.steps.back()))) break;
  }
  model.nodes.f.assign(equilibrium.forces().begin(), equilibrium.forces().end());
  detail::finishReport(equilibrium, start, report);
  return report;
}

}  // namespace

StaticReport followPath(Model& model, double tEnd, const ArcLengthOptions& options, const StaticObserver& observer) {
  validate(options, model);
  detail::requireLater(tEnd, model, "followPath");
  return follow(model, nullptr, tEnd, options, observer);
}

StaticReport followPath(Model& model, ParameterPath& path, double end, const ArcLengthOptions& options,
                        const StaticObserver& observer) {
  validate(options, model);
  if (!path.set || !(path.at < end))
    throw InputError("the path has no parameter, or has come to its end", "followPath", "give one below the end");
  return follow(model, &path, end, options, observer);
}

}  // namespace dovetail::fem
