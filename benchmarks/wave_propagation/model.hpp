// The bar as a scene: particles and solid with an overlap, or particles alone; and its time step.
//
// y runs along the bar from the end that is struck. Particles fill 0 ≤ y ≤ dem length, the solid goes on from
// dem length − overlap.
#pragma once

#include <cstdint>
#include <vector>

#include "dovetail/arlequin/arlequin_coupling.hpp"
#include "dovetail/arlequin/critical_step.hpp"
#include "dovetail/scene/build.hpp"
#include "settings.hpp"

namespace dovetail::wave {

/// Particles in a layer, and layers of a bar of that length.
int particlesPerLayer(const Settings& settings);
int layers(const Settings& settings, double length);

/// scenes/wave.json as the settings change it, built, and the parts of it that are looked at.
struct Bar {
  scene::Scene scene;
  scene::Built built;
  coupling::SolidSide* solid = nullptr;       ///< null for particles alone
  arlequin::ArlequinCoupling* tie = nullptr;  ///< the same
  std::vector<int> byPlace;                   ///< particles layer by layer along y, in each layer by z, then x

  coupling::CoupledRun& run() const { return *built.run; }
};
/// With a solid that is stepped every K-th time the automatic penalty is softened as far as its oscillations ask for
/// it: impulses every K dt must not meet them in resonance (K dt < π/ω), and nodes that move every K dt only must not
/// overshoot (implicit: K dt < 2/ω). Particles alone end in a layer more, which is the wall.
/// @param penalty  what is used on return
/// @throws InputError for impossible settings
Bar makeBar(const Settings& settings, double& penalty);

/// Of the bar as it is. @throws NumericalError as arlequin::criticalStep
arlequin::CriticalStep criticalStep(const Settings& settings, const Bar& bar);

struct StepPlan {
  double dt;                ///< s
  int stepsPerMacroStep;    ///< particle steps per step of the solid
  std::int64_t macroSteps;  ///< whole macro steps that end at the end time
};
/// @throws InputError for a step above the critical one (implicit solid: above that of the contacts, or a macro step
/// above
///         that of a coupling with stiffness) unless the settings insist on it, and for endless runs
StepPlan planSteps(const Settings& settings, const arlequin::CriticalStep& critical);

}  // namespace dovetail::wave
