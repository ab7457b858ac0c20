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

StaticReport takeSteps(Balance& balance, double tEnd, LoadSteps steps, const StaticObserver& observer,
                       const std::function<NewtonResult(const Instant&)>& attempt, const std::string& name,
                       const std::string& remedy) {
  const auto start = std::chrono::steady_clock::now();
  Model& model = balance.model();
  StaticReport report;
  report.storedBefore = storedEnergy(model, {model.t, 0.0});
  balance.findForces();
  std::vector<Vec3> f0(balance.forces().begin(), balance.forces().end()),
      loads0(balance.loads().begin(), balance.loads().end());
  double step = std::min(steps.first, steps.largest);
  while (model.t < tEnd) {
    // A remainder that is hardly a step of its own is taken along.
    const double left = tEnd - model.t, t = step >= 0.999 * left ? tEnd : model.t + step;
    const std::vector<Vec3> u0 = model.nodes.u;
    const Instant now{t, t - model.t};
    const NewtonResult result = attempt(now);
    if (!result.failure.empty()) {
      balance.forget();
      step = 0.4 * std::min(step, left);
      ++report.cuts;
      if (step >= steps.smallest) continue;
      model.nodes.f = f0;
      throw NumericalError(result.failure, name + ", " + when(t),
                           "the last equilibrium is at " + when(model.t) + "; " + remedy);
    }
    bookWork(balance, f0, loads0, u0, report);
    acceptTerms(model, now, report);
    f0.assign(balance.forces().begin(), balance.forces().end());
    loads0.assign(balance.loads().begin(), balance.loads().end());
    model.t = t;
    report.iterations += result.iterations;
    report.steps.push_back({t, result.iterations, result.residual, balance.negativePivots()});
    if (observer && !observer(model, report.steps.back())) break;
    const double growth = std::sqrt(static_cast<double>(steps.iterationTarget) / std::max(1, result.iterations));
    step = std::min(steps.largest, step * std::clamp(growth, 0.5, 2.0));
  }
  model.nodes.f = f0;
  finishReport(balance, start, report);
  return report;
}

}  // namespace dovetail::fem::detail
