#include "dovetail/fem/solve/statics.hpp"

#include <optional>

#include "dovetail/core/error.hpp"
#include "dynamic_relaxation.hpp"
#include "equilibrium.hpp"

namespace dovetail::fem {

StaticReport solveStatics(Model& model, double tEnd, const StaticOptions& options, const StaticObserver& observer) {
  detail::validate(options.newton);
  const detail::LoadSteps steps{options.firstStep, options.largestStep, options.smallestStep, options.iterationTarget};
  detail::validate(steps);
  if (!(tEnd == model.t)) detail::requireLater(tEnd, model, "solveStatics");
  if (options.motionIterations < 0)
    throw InputError("motionIterations is below 0", "StaticOptions", "give a number of iterations, or 0 for none");
  detail::Equilibrium equilibrium(model, options.newton);
  detail::StepWays ways;
  ways.attempt = [&](const Instant& now) {
    equilibrium.aim(now);
    return detail::attemptStep(model, now, options.maxAugmentations, [&]() -> detail::NewtonResult {
      equilibrium.beginStep();
      if (!equilibrium.predict()) return {0, 0.0, 0.0, "the tangent is singular or not finite"};
      return detail::newton(equilibrium, detail::policyOf(options.newton));
    });
  };
  std::optional<detail::DynamicRelaxation> relaxation;
  if (options.motionIterations > 0) {
    relaxation.emplace(equilibrium, 0.0);
    ways.motion = [&](const Instant& now, StaticReport& report) {
      return detail::moveToRest(equilibrium, *relaxation, now, options.motionIterations, options.maxAugmentations,
                                report);
    };
  }
  return detail::takeSteps(equilibrium, tEnd, steps, observer, ways,
                           {"solveStatics", "a limit point of the load can be passed by followPath"});
}

}  // namespace dovetail::fem
