// Steps of model time through equilibria, however each is found.
#include <algorithm>
#include <chrono>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "equilibrium.hpp"

namespace dovetail::fem::detail {

namespace {

std::string when(double t) { return "t = " + formatNumber(t) + " s"; }

}  // namespace

void validate(const LoadSteps& steps) {
  requirePositive(steps.first, "firstStep");
  requirePositive(steps.largest, "largestStep");
  requirePositive(steps.smallest, "smallestStep");
}

namespace {

/// The way from one equilibrium to the next.
class LoadPath {
public:
  LoadPath(Balance& balance, double tEnd, const LoadSteps& steps, const StepWays& ways, const StepWords& words)
      : balance_(balance),
        model_(balance.model()),
        tEnd_(tEnd),
        steps_(steps),
        ways_(ways),
        words_(words),
        step_(std::min(steps.first, steps.largest)) {
    report.storedBefore = storedEnergy(model_, {model_.t, 0.0});
    balance_.findForces();
    remember();
  }

  /// One accepted step.
  void advance() {
    NewtonResult result;
    Instant now;
    do {
      // A remainder that is hardly a step of its own is taken along.
      const double left = tEnd_ - model_.t, t = step_ >= 0.999 * left ? tEnd_ : model_.t + step_;
      now = {t, t - model_.t};
      result = ways_.attempt(now);
      if (!result.failure.empty() && !cut(left)) return move(now, result.failure);
    } while (!result.failure.empty());
    bookWork(balance_, f0_, loads0_, u0_, report);
    acceptTerms(model_, now, report);
    report.iterations += result.iterations;
    const double growth = std::sqrt(static_cast<double>(steps_.iterationTarget) / std::max(1, result.iterations));
    step_ = std::min(steps_.largest, step_ * std::clamp(growth, 0.5, 2.0));
    accept(now, result, false);
  }

  void showForces() { model_.nodes.f = f0_; }

  StaticReport report;

private:
  /// @return whether the step is not too short now
  bool cut(double left) {
    balance_.forget();
    ++report.cuts;
    const double shorter = 0.4 * std::min(step_, left);
    if (shorter < steps_.smallest && ways_.motion) return false;
    step_ = shorter;
    return step_ >= steps_.smallest;
  }
  void move(const Instant& now, std::string why) {
    if (ways_.motion) {
      const NewtonResult result = ways_.motion(now, report);
      if (result.failure.empty()) return accept(now, result, true);
      why += "; " + result.failure;
    }
    showForces();
    throw NoEquilibrium(why, words_.name + ", " + when(now.t),
                        "the last equilibrium is at " + when(model_.t) + "; " + words_.remedy);
  }
  void accept(const Instant& now, const NewtonResult& result, bool byMotion) {
    model_.t = now.t;
    remember();
    report.steps.push_back(
        {now.t, result.iterations, result.residual, balance_.negativePivots(), result.tolerance, byMotion});
  }
  void remember() {
    u0_ = model_.nodes.u;
    f0_.assign(balance_.forces().begin(), balance_.forces().end());
    loads0_.assign(balance_.loads().begin(), balance_.loads().end());
  }

  Balance& balance_;
  Model& model_;
  double tEnd_;
  LoadSteps steps_;
  const StepWays& ways_;
  const StepWords& words_;
  double step_;
  std::vector<Vec3> u0_, f0_, loads0_;
};

}  // namespace

StaticReport takeSteps(Balance& balance, double tEnd, LoadSteps steps, const StaticObserver& observer,
                       const StepWays& ways, const StepWords& words) {
  const auto start = std::chrono::steady_clock::now();
  const Model& model = balance.model();
  LoadPath path(balance, tEnd, steps, ways, words);
  bool goesOn = true;
  do {
    path.advance();
    goesOn = !observer || observer(model, path.report.steps.back());
  } while (goesOn && model.t < tEnd);
  path.showForces();
  finishReport(balance, start, path.report);
  return path.report;
}

}  // namespace dovetail::fem::detail
