#include "dovetail/fem/solve/statics.hpp"

#include "equilibrium.hpp"

namespace dovetail::fem {

StaticReport solveStatics(Model& model, double tEnd, const StaticOptions& options, const StaticObserver& observer) {
  detail::validate(options.newton);
  const detail::LoadSteps steps{options.firstStep, options.largestStep, options.smallestStep, options.iterationTarget};
  detail::validate(steps);
  detail::requireLater(tEnd, model, "solveStatics");
  detail::Equilibrium equilibrium(model, options.newton);
  const auto attempt = [&](const Instant& now) {
    equilibrium.aim(now);
    return detail::attemptStep(model, now, options.maxAugmentations, [&]() -> detail::NewtonResult {
      if (!equilibrium.predict()) return {0, 0.0, 0.0, "the tangent is singular or not finite"};
      return detail::newton(equilibrium, detail::policyOf(options.newton));
    });
  };
  return detail::takeSteps(equilibrium, tEnd, steps, observer, attempt, "solveStatics",
                           "a limit point of the load can be passed by followPath");
}

}  // namespace dovetail::fem
