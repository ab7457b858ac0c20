#include "dovetail/fem/solve/statics.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "equilibrium.hpp"

namespace dovetail::fem {

namespace {

using detail::Equilibrium;
using detail::NewtonResult;

void validate(const StaticOptions& options) {
  detail::validate(options.newton);
  requirePositive(options.firstStep, "firstStep");
  requirePositive(options.largestStep, "largestStep");
  requirePositive(options.smallestStep, "smallestStep");
}

std::string when(double t) { return "t = " + formatNumber(t) + " s"; }

/// Whether all terms trust the state; if not, the reason.
std::string complaint(const Model& model, double t) {
  try {
    for (const auto& term : model.terms) term->requireValid(model.nodes, when(t), Scrutiny::all);
  } catch (const NumericalError& error) {
    return error.what();
  }
  return {};
}

NewtonResult solveStep(Equilibrium& equilibrium, double t, const StaticOptions& options) {
  Model& model = equilibrium.model();
  NewtonResult result = detail::iterate(equilibrium, t, options.newton);
  for (int round = 0; result.failure.empty(); ++round) {
    bool again = false;
    for (const auto& term : model.terms) again = term->augment(model.nodes, {t, 0.0}) || again;
    if (!again) break;
    if (round == options.maxAugmentations)
      return {-1, result.residual, "contact multipliers do not settle in " + std::to_string(round) + " rounds"};
    const NewtonResult more = detail::iterate(equilibrium, t, options.newton);
    result = {more.iterations < 0 ? -1 : result.iterations + more.iterations, more.residual, more.failure};
  }
  if (!result.failure.empty()) {
    const std::string why = complaint(model, t);
    if (!why.empty()) result.failure += "; " + why;
    return result;
  }
  result.failure = complaint(model, t);
  return result;
}

}  // namespace

StaticReport solveStatics(Model& model, double tEnd, const StaticOptions& options, const StaticObserver& observer) {
  validate(options);
  if (!(tEnd > model.t))
    throw InputError("tEnd is " + formatNumber(tEnd) + " s, the model is at " + formatNumber(model.t) + " s",
                     "solveStatics", "give a later time");
  const auto start = std::chrono::steady_clock::now();
  Equilibrium equilibrium(model, options.newton);
  StaticReport report;
  report.storedBefore = storedEnergy(model, {model.t, 0.0});
  equilibrium.evaluate(model.t);
  std::vector<Vec3> f0(equilibrium.forces().begin(), equilibrium.forces().end()),
      loads0(equilibrium.loads().begin(), equilibrium.loads().end());
  double step = std::min(options.firstStep, options.largestStep);
  while (model.t < tEnd) {
    // A remainder that is hardly a step of its own is taken along.
    const double left = tEnd - model.t, t = step >= 0.999 * left ? tEnd : model.t + step;
    const std::vector<Vec3> u0 = model.nodes.u;
    const NewtonResult result = solveStep(equilibrium, t, options);
    if (!result.failure.empty()) {
      model.nodes.u = u0;
      for (const auto& term : model.terms) term->revert();
      equilibrium.solver().drop();
      step = 0.4 * std::min(step, left);
      ++report.cuts;
      if (step >= options.smallestStep) continue;
      detail::finishReport(equilibrium, start, report);
      throw NumericalError(
          result.failure, "solveStatics, " + when(t),
          "the last equilibrium is at " + when(model.t) + "; a limit point of the load can be passed by followPath");
    }
    detail::bookWork(equilibrium, model, f0, loads0, u0, report);
    detail::acceptTerms(model, t, report);
    f0.assign(equilibrium.forces().begin(), equilibrium.forces().end());
    loads0.assign(equilibrium.loads().begin(), equilibrium.loads().end());
    model.t = t;
    report.iterations += result.iterations;
    report.steps.push_back({t, result.iterations, result.residual, equilibrium.solver().negativePivots()});
    if (observer && !observer(model, report.steps.back())) break;
    const double growth = std::sqrt(static_cast<double>(options.iterationTarget) / std::max(1, result.iterations));
    step = std::min(options.largestStep, step * std::clamp(growth, 0.5, 2.0));
  }
  detail::finishReport(equilibrium, start, report);
  return report;
}

}  // namespace dovetail::fem
