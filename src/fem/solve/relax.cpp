#include "dovetail/fem/solve/relax.hpp"

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dynamic_relaxation.hpp"

namespace dovetail::fem {

namespace {

using detail::NewtonResult;

void validate(const RelaxOptions& options) {
  dovetail::validate(options.rest, "RelaxOptions", 1);
  requireNonNegative(options.absoluteTolerance, "absoluteTolerance");
  requireNonNegative(options.iterationStep, "iterationStep");
}

class Relaxation : public detail::Balance {
public:
  Relaxation(Model& model, const RelaxOptions& options)
      : Balance(model, options.rest.tolerance, options.absoluteTolerance) {}

  void describe(StaticReport& report) const override {
    Balance::describe(report);
    report.solver = "dynamic relaxation";
  }
};

}  // namespace

StaticReport relax(Model& model, double tEnd, const RelaxOptions& options, const StaticObserver& observer) {
  validate(options);
  const detail::LoadSteps steps{options.firstStep, options.largestStep, options.smallestStep,
                                static_cast<int>(options.rest.steps)};
  detail::validate(steps);
  detail::requireLater(tEnd, model, "relax");
  Relaxation relaxation(model, options);
  detail::DynamicRelaxation oscillation(relaxation, options.iterationStep);
  const auto attempt = [&](const Instant& now) {
    bool comesOn = true;
    return detail::attemptStep(model, now, options.maxAugmentations, [&] {
      const NewtonResult result = oscillation.relax(now, comesOn, static_cast<int>(options.rest.steps));
      comesOn = false;
      return result;
    });
  };
  return detail::takeSteps(relaxation, tEnd, steps, observer, {attempt, {}},
                           {"relax", "give smaller steps, a smaller iterationStep or more iterations"});
}

}  // namespace dovetail::fem
