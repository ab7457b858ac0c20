#include "step_plan.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::wave {

namespace {

void refuseExplicit(const Settings& s, double dt, const arlequin::CriticalStep& critical) {
  if (dt <= critical.together) return;
  throw InputError(
      "a step of " + formatNumber(dt) + " s is above the critical one, " + formatNumber(critical.together) +
          " s (particles " + formatNumber(critical.particles) + ", solid " + formatNumber(critical.solid) + ")",
      "--dt-factor", "give at most " + formatNumber(0.9 * critical.together / contactTime(s)) + ", or --dt auto");
}

/// With an implicit solid, contacts limit the particles' step. Nodes that move every K dt only would overshoot what a
/// stiff coupling wants.
void refuseImplicit(const Settings& s, double dt, const arlequin::CriticalStep& critical) {
  if (dt > critical.particles)
    throw InputError("a step of " + formatNumber(dt) + " s is above that of the contacts, " +
                         formatNumber(critical.particles) + " s",
                     "--dt-factor", "give at most " + formatNumber(0.9 * critical.particles / contactTime(s)));
  const bool stores = s.constraint == Constraint::penalty;
  if (stores && s.femEvery * dt > critical.together)
    throw InputError("the solid moves every " + formatNumber(s.femEvery * dt) +
                         " s, more than the critical step of the coupling, " + formatNumber(critical.together) + " s",
                     "--penalty", "give a softer one, a smaller --dt-factor or --fem-every, or leave it out");
}

}  // namespace

double requestedStep(const Settings& s, double critical) {
  if (s.dtAuto) return 0.5 * critical;
  return s.shareOfCritical ? *s.shareOfCritical * critical : s.dtFactor * contactTime(s);
}

StepPlan planSteps(const Settings& s, const arlequin::CriticalStep& critical) {
  const double dt = requestedStep(s, critical.together), end = endTime(s);
  const bool implicit = s.fem == FemStepper::newmark && !s.fullDem;
  if (!s.beyondCritical) implicit ? refuseImplicit(s, dt, critical) : refuseExplicit(s, dt, critical);
  if (end / dt > 1e10)
    throw InputError("the run would take " + formatNumber(end / dt) + " steps", "--until and --dt-factor",
                     "give a shorter time or a longer step");
  StepPlan plan;
  plan.stepsPerWindow = s.fullDem ? 1 : s.femEvery;
  plan.windows =
      std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(end / (plan.stepsPerWindow * dt) - 1e-9)));
  plan.dt = end / static_cast<double>(plan.windows * plan.stepsPerWindow);
  return plan;
}

}  // namespace dovetail::wave
