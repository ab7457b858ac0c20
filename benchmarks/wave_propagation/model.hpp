// Builds the bar from the settings: particles and solid with an overlap, or particles alone.
//
// y runs along the bar from the end that is struck. Particles fill 0 ≤ y ≤ dem length, the solid goes on from
// dem length − overlap. Particles are numbered layer by layer along y.
#pragma once

#include <cstdint>
#include <memory>

#include "dovetail/arlequin/critical_step.hpp"
#include "dovetail/arlequin/overlap_tie.hpp"
#include "dovetail/coupling/run.hpp"
#include "settings.hpp"

namespace dovetail::wave {

/// Length of the whole bar, m.
double barLength(const Settings& settings);
/// Particles in a layer, and layers of a bar of that length.
int particlesPerLayer(const Settings& settings);
int layers(const Settings& settings, double length);

/// The run, and the two of its parts that are looked at; null for particles alone.
struct Bar {
  std::unique_ptr<coupling::CoupledRun> run;
  fem::SolidMesh mesh;
  coupling::SolidSide* solid = nullptr;
  arlequin::OverlapTie* tie = nullptr;
};

/// Particles and solid coupled in the overlap.
/// @throws InputError for impossible settings
Bar makeCoupledBar(const Settings& settings);
/// Particles over the whole length and one layer more, which is the wall at the end: held, it fixes the bar's last
/// point.
Bar makeParticleBar(const Settings& settings);

/// Of the bar as it is, its pairs listed. @throws NumericalError as arlequin::criticalStep
arlequin::CriticalStep criticalStep(const Settings& settings, const Bar& bar);

/// What the constraint gets: as asked for, the published ε of the dashpot, or automatic, Pa/m².
double penaltyOf(const Settings& settings);
/// Either bar, with that penalty. With a solid that is stepped every K-th time the automatic penalty is softened as far
/// as its oscillations ask for it: impulses every K dt must not meet them in resonance (K dt < π/ω), and nodes that
/// move every K dt only must not overshoot (implicit: K dt < 2/ω).
/// @param penalty  what is used on return
/// @throws InputError for impossible settings
Bar makeBar(const Settings& settings, double& penalty);

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
