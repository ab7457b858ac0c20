// The time step of a run.
#pragma once

#include <cstdint>

#include "dovetail/arlequin/critical_step.hpp"
#include "settings.hpp"

namespace dovetail::wave {

/// The step that the settings ask for, s: before it is made to divide the end time.
double requestedStep(const Settings& settings, double critical);

struct StepPlan {
  double dt;             ///< s
  int stepsPerWindow;    ///< particle steps per step of the solid
  std::int64_t windows;  ///< whole windows that end at the end time
};
/// @throws InputError for a step above the critical one (implicit solid: above that of the contacts, or a window above
///         that of a coupling with stiffness) unless the settings insist on it, and for endless runs
StepPlan planSteps(const Settings& settings, const arlequin::CriticalStep& critical);

}  // namespace dovetail::wave
